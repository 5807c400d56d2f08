#include "graze/model/microbeam.hpp"

#include "graze/base/input_error.hpp"
#include "graze/model/check.hpp"
#include "graze/model/model_file.hpp"
#include "model/evaluate_model.hpp"
#include "places.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <functional>
#include <limits>
#include <regex>
#include <sstream>

namespace graze::microbeam_test {

using testing::evaluate;
using testing::expressions_of;
using testing::random_state;
using testing::rate_of;

constexpr double epsilon = std::numeric_limits<double>::epsilon();

/// Integral over [0, 1] by three-point Gauss quadrature on many panels, independent of the model's quadrature.
double integral(const std::function<double(double)>& integrand, int panels = 4000) {
    const double offset = std::sqrt(0.6) / 2;
    double sum = 0;
    for (int panel = 0; panel < panels; ++panel) {
        const auto at = [&](double s) { return integrand((panel + 0.5 + s) / panels); };
        sum += (5 * at(-offset) + 8 * at(0) + 5 * at(offset)) / 18;
    }
    return sum / panels;
}

TEST(ClampedBeamModes, FrequenciesAreThePublishedOnes) {
    const ClampedBeamModes beam(9);
    const double published[] = {22.37328544806, 61.67282286792, 120.9033917271, 199.8594481272, 298.5555352982,
                                416.9907858354, 555.1652475668, 713.0789179784, 890.7317971983};
    for (int i = 1; i <= 9; ++i)
        EXPECT_NEAR(beam.frequency(i), published[i - 1], 1e-12 * published[i - 1]) << i;
}

TEST(ClampedBeamModes, FrequenciesSolveTheFrequencyEquation) {
    const ClampedBeamModes beam(8);
    for (int i = 1; i <= 8; ++i) {
        const long double k = std::sqrt(static_cast<long double>(beam.frequency(i)));
        const long double residual = std::cos(k) - 1 / std::cosh(k);
        EXPECT_LT(std::abs(residual), 2 * epsilon * k) << i;
    }
}

TEST(ClampedBeamModes, SlopeProductsAreThePublishedOnes) {
    const ClampedBeamModes beam(9);
    EXPECT_NEAR(beam.slope_product(1, 1), 12.302618622966, 1e-11);
    EXPECT_NEAR(beam.slope_product(1, 3), -9.7307922131, 1e-10);
    EXPECT_NEAR(beam.slope_product(3, 3), 98.9048014025, 1e-10);
    EXPECT_NEAR(beam.slope_product(5, 5), 263.997980736, 1e-9);
    EXPECT_NEAR(beam.slope_product(9, 9), 831.041536780, 1e-9);
    EXPECT_EQ(beam.slope_product(1, 2), 0);
}

TEST(ClampedBeamModes, SlopeProductsEqualTheirIntegrals) {
    const ClampedBeamModes beam(9);
    for (int i = 1; i <= 9; ++i)
        for (int j = 1; j <= 9; ++j) {
            const double size = std::sqrt(beam.slope_product(i, i) * beam.slope_product(j, j));
            const double numerical = integral([&](double x) { return beam.slope(i, x) * beam.slope(j, x); });
            EXPECT_NEAR(numerical, beam.slope_product(i, j), 1e-13 * size) << i << ' ' << j;
            EXPECT_EQ(beam.slope_product(i, j), beam.slope_product(j, i));
        }
}

TEST(ClampedBeamModes, ShapesAreOrthonormal) {
    const ClampedBeamModes beam(120);
    for (const int i : {1, 2, 3, 9, 40, 119, 120})
        for (const int j : {1, 2, 9, 40, 119, 120}) {
            const double product = integral([&](double x) { return beam.shape(i, x) * beam.shape(j, x); });
            EXPECT_NEAR(product, i == j ? 1 : 0, 1e-12) << i << ' ' << j;
        }
}

TEST(ClampedBeamModes, ShapesSatisfyTheBoundaryConditionsForAnyModeNumber) {
    const ClampedBeamModes beam(1000);
    for (const int i : {1, 2, 3, 10, 11, 100, 1000}) {
        const double k = std::sqrt(beam.frequency(i));
        EXPECT_NEAR(beam.shape(i, 0), 0, 4 * epsilon) << i;
        EXPECT_NEAR(beam.slope(i, 0) / k, 0, 4 * epsilon) << i;
        EXPECT_NEAR(beam.shape(i, 1), 0, 4 * epsilon) << i;
        EXPECT_LT(std::abs(beam.shape(i, 0.37)), 1.7) << i;
        EXPECT_EQ(beam.shape(i, 0.75), (i % 2 == 1 ? 1 : -1) * beam.shape(i, 0.25)) << i;
    }
}

TEST(ClampedBeamModes, ShapesAgreeWithTheTextbookFormula) {
    const ClampedBeamModes beam(3);
    for (int i = 1; i <= 3; ++i) {
        const long double k = std::sqrt(static_cast<long double>(beam.frequency(i)));
        const long double weight = (std::cosh(k) - std::cos(k)) / (std::sinh(k) - std::sin(k));
        for (const double x : {0.01, 0.1, 0.3, 0.5, 0.6, 0.9}) {
            const long double z = k * x;
            const long double shape = std::cosh(z) - std::cos(z) - weight * (std::sinh(z) - std::sin(z));
            const long double slope = k * (std::sinh(z) + std::sin(z) - weight * (std::cosh(z) - std::cos(z)));
            // The textbook formula itself amplifies the rounding of its wave number by exp(k).
            EXPECT_NEAR(beam.shape(i, x), static_cast<double>(shape), 4 * epsilon * std::exp(z)) << i << ' ' << x;
            EXPECT_NEAR(beam.slope(i, x), static_cast<double>(slope), 4 * epsilon * k * std::exp(z)) << i << ' ' << x;
        }
    }
}

TEST(ClampedBeamPolynomial, HasTheIntegralsOfTheChapter) {
    // Eq. (3.20) with its integrals, Eq. (3.21); the polynomial here is phi/Lambda_11^(1/2).
    const double gap = 0.04, mass = 128 * gap * gap / 315, slopes = 512 * gap * gap / 105,
                 curvatures = 1024 * gap * gap / 5;
    const ClampedBeamPolynomial beam;
    const auto curvature = [](double x) { return 32 * (1 - 6 * x + 6 * x * x); }; // (16 x^2 (x - 1)^2)''
    for (const double x : {0.0, 0.1, 0.37, 0.5, 0.9, 1.0}) {
        EXPECT_NEAR(beam.shape(x) * std::sqrt(mass), 16 * gap * x * x * (x - 1) * (x - 1), 4 * epsilon);
        EXPECT_NEAR(beam.shape(x), beam.shape(1 - x), 8 * epsilon);
        EXPECT_NEAR(beam.slope(x), -beam.slope(1 - x), 32 * epsilon);
    }
    EXPECT_NEAR(integral([&](double x) { return beam.shape(x) * beam.shape(x); }), 1, 1e-12);
    EXPECT_NEAR(integral([&](double x) { return beam.slope(x) * beam.slope(x); }), beam.slope_product(), 1e-11);
    EXPECT_NEAR(beam.slope_product(), slopes / mass, 1e-13);
    EXPECT_NEAR(beam.frequency() * beam.frequency(), curvatures / mass, 1e-12);
    EXPECT_NEAR(integral([&](double x) { return gap * gap * curvature(x) * curvature(x); }), curvatures, 1e-12);
    EXPECT_THROW(beam.shape(1.1), InputError);
}

/// Right-hand sides of Eq. (3.17), evaluated directly.
class DirectBeam {
public:
    explicit DirectBeam(const MicrobeamOptions& options) : o(options), beam(options.modes) {}

    double deflection(std::span<const double> q, double x) const {
        double w = 0;
        for (int i = 1; i <= o.modes; ++i)
            w += q[static_cast<std::size_t>(i - 1)] * beam.shape(i, x);
        return w;
    }

    double electrostatic_force(std::span<const double> q, double x) const {
        const double gap = o.gap - deflection(q, x);
        const double fringe = 0.204 + 0.6 * std::pow(o.thickness / o.width, 0.24);
        return o.voltage * o.voltage / (gap * gap) * (1 + fringe * std::pow(gap / o.width, 0.76));
    }

    /// Eq. (3.23)
    double simpson(std::span<const double> q, int m) const {
        const auto term = [&](double x) { return electrostatic_force(q, x) * beam.shape(m, x); };
        const int n = o.points;
        double sum = 0;
        for (int k = 1; k <= n / 2 - 1; ++k)
            sum += term(2.0 * k / n);
        for (int k = 1; k <= n / 2; ++k)
            sum += 2 * term((2.0 * k - 1) / n);
        return 2.0 / (3 * n) * sum;
    }

    double elastic(std::span<const double> q, int m) const {
        double stretch = 0, slope = 0;
        for (int i = 1; i <= o.modes; ++i) {
            slope += q[static_cast<std::size_t>(i - 1)] * beam.slope_product(i, m);
            for (int j = 1; j <= o.modes; ++j)
                stretch +=
                    q[static_cast<std::size_t>(i - 1)] * q[static_cast<std::size_t>(j - 1)] * beam.slope_product(i, j);
        }
        const double frequency = beam.frequency(m);
        return -frequency * frequency * q[static_cast<std::size_t>(m - 1)] - o.gamma / 2 * stretch * slope;
    }

    MicrobeamOptions o;
    ClampedBeamModes beam;
};

class MicrobeamFamily : public ::testing::TestWithParam<int> {};

TEST_P(MicrobeamFamily, RightHandSidesAreThoseOfTheChapter) {
    const MicrobeamOptions options{.modes = GetParam(), .stop_position = 0.3};
    const Model model = microbeam(options);
    const DirectBeam direct(options);
    std::mt19937_64 random(3);
    const std::size_t count = static_cast<std::size_t>(options.modes);
    for (int trial = 0; trial < 20; ++trial) {
        const std::vector<double> state = random_state(model, 0.003, random);
        const std::span<const double> q(state.data(), count), v(state.data() + count, count);
        const double w = direct.deflection(q, options.stop_position);
        for (const Mode& mode : model.modes) {
            const std::vector<double> rates = evaluate(model, mode.rates, state);
            const bool on = mode.name.ends_with("_on"), contact = mode.name.starts_with("contact");
            for (int m = 1; m <= options.modes; ++m) {
                const std::size_t index = static_cast<std::size_t>(m - 1);
                const double damping = -2 * options.damping * direct.beam.frequency(m) * v[index];
                const double stop =
                    -options.stop_stiffness * (w - options.stop_distance) * direct.beam.shape(m, options.stop_position);
                const double expected =
                    direct.elastic(q, m) + damping + (on ? direct.simpson(q, m) : 0) + (contact ? stop : 0);
                EXPECT_EQ(rates[index], v[index]);
                EXPECT_NEAR(rates[count + index], expected, 1e-12 * (1 + std::abs(expected))) << mode.name << m;
            }
            EXPECT_EQ(rates.back(), options.frequency);
        }
    }
}

TEST_P(MicrobeamFamily, ForcesOfTheFreeBeamAreTheGradientOfItsEnergy) {
    Model model = microbeam({.modes = GetParam()});
    model.set_parameter("zeta", 0);
    const Expression energy = model.quantities[*model.find_quantity("energy")].value;
    const Expression rate = rate_of(model, energy, *model.find_mode("free_off"));
    std::mt19937_64 random(4);
    for (int trial = 0; trial < 20; ++trial) {
        const std::vector<double> state = random_state(model, 0.01, random);
        // The tolerance is relative to the cancelling terms.
        const double size = 0.01 * 0.01 * std::pow(9 * 900.0, 2);
        EXPECT_NEAR(evaluate(model, rate, state), 0, 10 * epsilon * size);
    }
}

TEST_P(MicrobeamFamily, IsValidAndReadsBackWithoutWarnings) {
    const Model model = microbeam({.modes = GetParam(), .quadrature = Quadrature::gauss, .points = 9});
    EXPECT_EQ(model_warnings(model), std::vector<std::string>{});
    const Model read = parse_model(write_model(model), "microbeam.toml");
    EXPECT_EQ(read.name, model.name);
    EXPECT_EQ(read.parameter_values(), model.parameter_values());
    std::mt19937_64 random(5);
    const std::vector<double> state = random_state(model, 0.01, random);
    EXPECT_EQ(evaluate(read, expressions_of(read), state), evaluate(model, expressions_of(model), state));
}

INSTANTIATE_TEST_SUITE_P(Sizes, MicrobeamFamily, ::testing::Values(1, 2, 3, 5, 9));

TEST(Microbeam, GaussAndSimpsonConvergeToTheSameForce) {
    const MicrobeamOptions options{.modes = 3, .quadrature = Quadrature::gauss, .points = 40};
    const Model simpson = microbeam({.modes = 3, .points = 400}), even = microbeam(options);
    const Model odd = microbeam({.modes = 3, .quadrature = Quadrature::gauss, .points = 33});
    const std::vector<double> state = {0.004, -0.001, 0.0005, 0.1, 0.2, 0.3, 1};
    const DirectBeam direct(options);
    const std::vector<double> a = evaluate(simpson, simpson.modes[0].rates, state);
    const std::vector<double> b = evaluate(odd, odd.modes[0].rates, state);
    const std::vector<double> c = evaluate(even, even.modes[0].rates, state);
    for (int m = 1; m <= 3; ++m) {
        const std::size_t rate = static_cast<std::size_t>(2 + m);
        const double force =
            integral([&](double x) { return direct.electrostatic_force(state, x) * direct.beam.shape(m, x); });
        const double damping = -2 * options.damping * direct.beam.frequency(m) * state[rate];
        const double expected = force + damping + direct.elastic({state.data(), 3}, m);
        EXPECT_NEAR(b[rate], expected, 1e-12 * (1 + std::abs(expected)));
        EXPECT_NEAR(c[rate], expected, 1e-12 * (1 + std::abs(expected)));
        EXPECT_NEAR(a[rate], expected, 1e-7 * std::abs(force));
    }
}

/// The equations for the amplitude of Eq. (3.20), whose trial function has the size of the gap, by Eqs. (3.19) and
/// (3.21).
TEST(Microbeam, PolynomialModelIsThatOfTheChapter) {
    const MicrobeamOptions options{.trial = TrialFunctions::polynomial};
    const Model model = microbeam(options);
    EXPECT_EQ(model.name, "microbeam-polynomial");
    EXPECT_EQ(model_warnings(model), std::vector<std::string>{});
    const double gap = options.gap, mass = 128 * gap * gap / 315, slopes = 512 * gap * gap / 105,
                 curvatures = 1024 * gap * gap / 5, unit = std::sqrt(mass);
    const auto phi = [&](double x) { return 16 * gap * x * x * (x - 1) * (x - 1); };
    for (const double q : {-0.15, 0.05, 0.4}) { // w = q phi; the middle of the beam is at q gap
        const auto force = [&](double x) {
            const double distance = gap - q * phi(x);
            const double fringe = 0.204 + 0.6 * std::pow(options.thickness / options.width, 0.24);
            return options.voltage * options.voltage / (distance * distance) *
                   (1 + fringe * std::pow(distance / options.width, 0.76)) * phi(x);
        };
        double simpson = 0; // Eq. (3.23)
        for (int k = 1; k < options.points; ++k)
            simpson += (k % 2 == 1 ? 4.0 : 2.0) * force(k / 20.0) / (3.0 * options.points);
        ASSERT_EQ(options.points, 20);
        const double elastic = q * curvatures + options.gamma / 2 * q * q * q * slopes * slopes,
                     stop = options.stop_stiffness * (q * phi(0.5) - options.stop_distance) * phi(0.5);
        for (const bool on : {false, true})
            for (const bool contact : {false, true}) {
                const double expected = (-elastic + (on ? simpson : 0) - (contact ? stop : 0)) / mass;
                const std::size_t mode = (on ? 0U : 1U) + (contact ? 2U : 0U);
                const std::vector<double> rates =
                    evaluate(model, model.modes[mode].rates, std::vector<double>{q * unit, 0, 1});
                EXPECT_NEAR(rates[1] / unit, expected, 1e-12 * (1 + std::abs(expected))) << model.modes[mode].name;
            }
    }
}

TEST(Microbeam, SteadyVoltageHasTheForcesOfThePulses) {
    const Model pulsed = microbeam({.modes = 3}), steady = microbeam({.modes = 3, .steady = true});
    EXPECT_EQ(model_warnings(steady), std::vector<std::string>{});
    std::mt19937_64 random(6);
    const std::vector<double> state = random_state(pulsed, 0.003, random);
    EXPECT_EQ(evaluate(steady, steady.modes[0].rates, state), evaluate(pulsed, pulsed.modes[0].rates, state));
    EXPECT_EQ(evaluate(steady, steady.modes[1].rates, state), evaluate(pulsed, pulsed.modes[2].rates, state));
}

TEST(Microbeam, MembersAreFoundByName) {
    EXPECT_EQ(microbeam_member("microbeam-9").value().modes, 9);
    EXPECT_EQ(microbeam_member("microbeam-polynomial").value().trial, TrialFunctions::polynomial);
    EXPECT_TRUE(microbeam_member("microbeam-steady").value().steady);
    for (const char* name : {"microbeam", "microbeam-", "microbeam-1", "microbeam-0", "microbeam-09", "microbeam-9x",
                             "microbeam-x", "beam-9", "microbeam-99999999999999999999"})
        EXPECT_FALSE(microbeam_member(name).has_value()) << name;
}

TEST(Microbeam, SymmetricMotionsStaySymmetric) {
    const Model model = microbeam({.modes = 5});
    const std::vector<double> state = {0.004, 0, -0.001, 0, 0.0002, 0.3, 0, 0.2, 0, -0.1, 1};
    for (const Mode& mode : model.modes) {
        const std::vector<double> rates = evaluate(model, mode.rates, state);
        EXPECT_EQ(rates[5 + 1], 0) << mode.name;
        EXPECT_EQ(rates[5 + 3], 0) << mode.name;
    }
}

TEST(Microbeam, ForceIsContinuousAtContact) {
    for (const double distance : {-0.004, 0.004}) {
        const MicrobeamOptions options{.stop_distance = distance};
        const Model model = microbeam(options);
        const double q = distance / ClampedBeamModes(1).shape(1, options.stop_position);
        const std::vector<double> at = {q, -0.1, 1}, beyond = {1.1 * q, -0.1, 1}, before = {0.9 * q, -0.1, 1};
        const Expression touch = model.events[*model.find_event("touch")].function;
        EXPECT_NEAR(evaluate(model, touch, at), 0, epsilon * std::abs(distance));
        EXPECT_NEAR(evaluate(model, touch, before), 0.1 * std::abs(distance), 1e-15);
        EXPECT_NEAR(evaluate(model, touch, beyond), -0.1 * std::abs(distance), 1e-15);
        const auto rate = [&](const char* mode, const std::vector<double>& state) {
            return evaluate(model, model.modes[*model.find_mode(mode)].rates, state)[1];
        };
        EXPECT_NEAR(rate("free_on", at), rate("contact_on", at), 1e-12);
        // The stop pushes the beam back towards its straight shape.
        EXPECT_LT((rate("contact_on", beyond) - rate("free_on", beyond)) * distance, 0);
    }
}

TEST(Microbeam, RefusesInvalidOptions) {
    const MicrobeamOptions wrong[] = {{.modes = 0},
                                      {.modes = 2, .trial = TrialFunctions::polynomial},
                                      {.points = 7},
                                      {.points = 0},
                                      {.width = 0},
                                      {.gap = -0.04},
                                      {.stop_position = 1},
                                      {.stop_distance = 0},
                                      {.stop_distance = 0.05},
                                      {.frequency = 0},
                                      {.damping = std::nan("")}};
    for (const MicrobeamOptions& options : wrong)
        EXPECT_THROW(microbeam(options), InputError) << &options - wrong;
}

TEST(Microbeam, CanBeBuiltForAnyNumberOfModesAndWrittenOut) {
    const Model model = microbeam({.modes = 9, .stop_stiffness = 5000});
    const std::string text = write_model(model);

    EXPECT_EQ(model.states.size(), 19u);
    EXPECT_EQ(parse_model(text, "microbeam-9.toml").name, "microbeam-9");
}

/// Returns a text without its decimal fractions, and the fractions.
std::pair<std::string, std::vector<double>> without_fractions(const std::string& text) {
    static const std::regex fraction(R"(\d+\.\d+(e[-+]?\d+)?)");
    std::vector<double> numbers;
    for (auto match = std::sregex_iterator(text.begin(), text.end(), fraction); match != std::sregex_iterator();
         ++match)
        numbers.push_back(std::stod(match->str()));
    return {std::regex_replace(text, fraction, "#"), numbers};
}

TEST(Microbeam, ShippedFileIsThatOfTheBuilder) {
    std::ifstream file(std::string(testing::source_folder) + "/models/microbeam.toml");
    ASSERT_TRUE(file);
    std::ostringstream text;
    text << file.rdbuf();
    // Mathematical libraries differ in the last digit of the mode shapes.
    const auto [shipped, shipped_numbers] = without_fractions(text.str());
    const auto [built, built_numbers] = without_fractions(write_model(microbeam()));
    EXPECT_EQ(shipped, built);
    ASSERT_EQ(shipped_numbers.size(), built_numbers.size());
    for (std::size_t i = 0; i < built_numbers.size(); ++i)
        EXPECT_NEAR(shipped_numbers[i], built_numbers[i], 32 * epsilon * std::abs(built_numbers[i]));
}

} // namespace graze::microbeam_test
