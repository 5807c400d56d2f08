#include "graze/tape/jet.hpp"

#include "graze/base/input_error.hpp"

#include "tape/problems.hpp"

#include <gtest/gtest.h>

#include <functional>
#include <numbers>
#include <utility>

namespace graze::jet_test {

using testing::eps;
using testing::Problem;
using testing::Time;

using Function = std::function<Expression(const Expression&)>;
/// Coefficient k of a function at `start`.
using ClosedForm = std::function<long double(int k, double start)>;

struct KnownSeries {
    std::string name;
    double start;
    Function function;
    ClosedForm closed_form;
};

long double factorial(int k) {
    return std::tgamma(static_cast<long double>(k) + 1);
}
long double binomial(long double exponent, int k) {
    long double result = 1;
    for (int j = 0; j < k; ++j)
        result *= (exponent - j) / (j + 1);
    return result;
}
ClosedForm power_of_time(long double exponent) {
    return [exponent](int k, double t) { return binomial(exponent, k) * std::pow((long double)t, exponent - k); };
}
constexpr long double quarter = std::numbers::pi_v<long double> / 2;

/// tan t = sum of T_n t^(2n-1), from Bernoulli numbers: T_n = 2^2n (2^2n - 1) |B_2n| / (2n)!, with
/// |B_2n| = 2 (2n)! zeta(2n) / (2 pi)^2n; (2^2n - 1) zeta(2n) = 2^2n (1 + 3^-2n + 5^-2n + ...).
long double tangent_coefficient(int n) {
    long double sum = 0;
    for (int odd = 1999; odd > 0; odd -= 2)
        sum += std::pow(static_cast<long double>(odd), -2 * n);
    if (n <= 2) // the sum converges slowly here, but the values are known
        sum = n == 1 ? std::pow(quarter, 2) / 2 : std::pow(quarter, 4) / 6;
    return 2 * sum * std::pow(1 / quarter, 2 * n);
}

/// erf^(k)(t) = 2/sqrt(pi) (-1)^(k-1) H_(k-1)(t) exp(-t^2), with Hermite's polynomials H.
long double error_function_coefficient(int k, double at) {
    const long double t = at;
    if (k == 0)
        return std::erf(t);
    long double before = 0, hermite = 1;
    for (int n = 0; n < k - 1; ++n)
        before = std::exchange(hermite, 2 * t * hermite - 2 * n * before);
    return (k % 2 ? 2 : -2) / std::sqrt(std::numbers::pi_v<long double>) * hermite * std::exp(-t * t) / factorial(k);
}

std::vector<KnownSeries> known_series() {
    const auto odd_only = [](auto coefficient) {
        return [coefficient](int k, double) -> long double { return k % 2 == 0 ? 0.0L : coefficient((k + 1) / 2); };
    };
    return {
        {"exp", 0.5, [](auto& t) { return exp(t); },
         [](int k, double t) { return std::exp((long double)t) / factorial(k); }},
        {"exp2t", 0.5, [](auto& t) { return exp(2 * t); },
         [](int k, double t) { return std::exp(2 * (long double)t) * std::pow(2.0L, k) / factorial(k); }},
        {"sin", 0.6, [](auto& t) { return sin(t); },
         [](int k, double t) { return std::sin(t + k * quarter) / factorial(k); }},
        {"cos", 0.6, [](auto& t) { return cos(t); },
         [](int k, double t) { return std::cos(t + k * quarter) / factorial(k); }},
        {"sinh", 0.6, [](auto& t) { return sinh(t); },
         [](int k, double t) {
             return (k % 2 ? std::cosh((long double)t) : std::sinh((long double)t)) / factorial(k);
         }},
        {"cosh", 0.6, [](auto& t) { return cosh(t); },
         [](int k, double t) {
             return (k % 2 ? std::sinh((long double)t) : std::cosh((long double)t)) / factorial(k);
         }},
        {"log", 2.5, [](auto& t) { return log(t); },
         [](int k, double t) {
             return k == 0 ? std::log((long double)t) : (k % 2 ? 1 : -1) / (k * std::pow((long double)t, k));
         }},
        {"reciprocal", 1.5, [](auto& t) { return 1 / t; }, power_of_time(-1)},
        {"geometric", 0.0, [](auto& t) { return 1 / (1 - t); }, [](int, double) { return 1.0L; }},
        {"quotient", 0.0, [](auto& t) { return (1 + t) / (1 - t); },
         [](int k, double) { return k == 0 ? 1.0L : 2.0L; }},
        {"sqrt", 1.5, [](auto& t) { return sqrt(t); }, power_of_time(0.5L)},
        {"inverse_sqrt", 1.5, [](auto& t) { return pow(t, -0.5); }, power_of_time(-0.5L)},
        {"power_1.5", 1.5, [](auto& t) { return pow(t, 1.5); }, power_of_time(1.5L)},
        {"power_-2.5", 1.5, [](auto& t) { return pow(t, -2.5); }, power_of_time(-2.5L)},
        {"power_0.3", 1.5, [](auto& t) { return pow(t, 0.3); }, power_of_time(0.3)},
        {"power_-1.7", 1.5, [](auto& t) { return pow(t, -1.7); }, power_of_time(-1.7)},
        {"power_7", 1.5, [](auto& t) { return pow(t, 7); }, power_of_time(7)},
        {"power_7_at_0", 0.0, [](auto& t) { return pow(t, 7); }, [](int k, double) { return k == 7 ? 1.0L : 0.0L; }},
        {"power_-5", 1.5, [](auto& t) { return pow(t, -5); }, power_of_time(-5)},
        {"square_at_0", 0.0, [](auto& t) { return t * t; }, [](int k, double) { return k == 2 ? 1.0L : 0.0L; }},
        {"base_2", 0.5, [](auto& t) { return pow(t.graph()->number(2), t); },
         [](int k, double t) { return std::pow(2.0L, t) * std::pow(std::log(2.0L), k) / factorial(k); }},
        {"atan", 0.7, [](auto& t) { return atan(t); },
         [](int k, double t) { // imaginary part of log(t + i)
             const long double angle = std::atan2(1.0L, (long double)t);
             return k == 0
                        ? std::atan((long double)t)
                        : (k % 2 ? 1 : -1) * std::sin(k * angle) / (k * std::pow(std::hypot(1.0L, (long double)t), k));
         }},
        {"erf", 0.6, [](auto& t) { return erf(t); }, error_function_coefficient},
        {"erf_at_0", 0.0, [](auto& t) { return erf(t); }, error_function_coefficient},
        {"erf_at_3", 3.0, [](auto& t) { return erf(t); }, error_function_coefficient},
        {"erf_2t", -0.4, [](auto& t) { return erf(2 * t); },
         [](int k, double t) { return std::pow(2.0L, k) * error_function_coefficient(k, 2 * t); }},
        {"tan", 0.0, [](auto& t) { return tan(t); }, odd_only(tangent_coefficient)},
        {"tanh", 0.0, [](auto& t) { return tanh(t); },
         odd_only([](int n) { return (n % 2 ? 1 : -1) * tangent_coefficient(n); })},
        {"asin", 0.0, [](auto& t) { return asin(t); },
         odd_only([](int n) { return (n % 2 ? 1 : -1) * binomial(-0.5L, n - 1) / (2 * n - 1); })},
        {"acos", 0.0, [](auto& t) { return acos(t); },
         [](int k, double) -> long double {
             const int n = (k + 1) / 2;
             return k == 0 ? quarter : k % 2 ? (n % 2 ? -1 : 1) * binomial(-0.5L, n - 1) / (2 * n - 1) : 0.0L;
         }},
    };
}

class SeriesOfTime : public ::testing::TestWithParam<KnownSeries> {};

TEST_P(SeriesOfTime, MatchesClosedForm) {
    const KnownSeries& known = GetParam();
    for (const auto set : testing::supported_sets())
        for (const Time kind : {Time::linear, Time::hidden})
            for (const int order : {1, 2, 7, 20, highest_order}) {
                Problem problem;
                problem.outputs = {known.function(testing::add_time(problem, kind, known.start))};
                const auto series = testing::output_series(problem, order, set)[0];
                for (int k = 0; k <= order; ++k) {
                    const long double expected = known.closed_form(k, known.start);
                    /// Round-off grows at most in proportion to the order. A coefficient that happens to be small has
                    /// the round-off of its neighbours.
                    const long double size =
                        std::max({std::abs(expected), std::abs(known.closed_form(k + 1, known.start)),
                                  k > 0 ? std::abs(known.closed_form(k - 1, known.start)) : 0});
                    EXPECT_LE(std::abs(series[k] - expected), 4 * (k + 2) * eps * size)
                        << known.name << " order " << k << " of " << order << " " << name_of(set);
                }
            }
}

INSTANTIATE_TEST_SUITE_P(Jet, SeriesOfTime, ::testing::ValuesIn(known_series()), [](const auto& known) {
    std::string name = known.param.name;
    std::ranges::replace_if(
        name, [](char c) { return !std::isalnum(c); }, '_');
    return name;
});

TEST(Jet, IdentitiesOfFunctionsHold) {
    const auto near_zero = [](const std::string& name, const Function& identity) {
        for (const auto set : testing::supported_sets()) {
            Problem p;
            const Expression x = p.state("x", 0.2), y = p.state("y", 0.9);
            p.rates = {y, 0.25 * y * cos(x) - 0.5 * x};
            p.outputs = {identity(0.5 * x + 0.25 * x * y)};
            const auto series = testing::output_series(p, highest_order, set)[0];
            for (int k = 0; k <= highest_order; ++k)
                EXPECT_LE(std::abs(series[k]), 200 * eps) << name << " order " << k << " " << name_of(set);
        }
    };
    near_zero("sin^2 + cos^2", [](auto& g) { return sin(g) * sin(g) + cos(g) * cos(g) - 1; });
    near_zero("cosh^2 - sinh^2", [](auto& g) { return cosh(g) * cosh(g) - sinh(g) * sinh(g) - 1; });
    near_zero("tan cos - sin", [](auto& g) { return tan(g) * cos(g) - sin(g); });
    near_zero("tanh cosh - sinh", [](auto& g) { return tanh(g) * cosh(g) - sinh(g); });
    near_zero("exp - cosh - sinh", [](auto& g) { return exp(g) - cosh(g) - sinh(g); });
    near_zero("log exp", [](auto& g) { return log(exp(g)) - g; });
    near_zero("exp log", [](auto& g) { return exp(log(1 + g)) - 1 - g; });
    near_zero("sin asin", [](auto& g) { return sin(asin(g)) - g; });
    near_zero("cos acos", [](auto& g) { return cos(acos(g)) - g; });
    near_zero("tan atan", [](auto& g) { return tan(atan(g)) - g; });
    near_zero("asin + acos", [](auto& g) { return asin(g) + acos(g) - std::numbers::pi / 2; });
    near_zero("sqrt^2", [](auto& g) { return sqrt(1 + g) * sqrt(1 + g) - 1 - g; });
    near_zero("powers", [](auto& g) { return pow(1 + g, 0.3) * pow(1 + g, 0.7) - 1 - g; });
    near_zero("power of a series", [](auto& g) { return pow(1 + g, g) - exp(g * log(1 + g)); });
    near_zero("division", [](auto& g) { return g / (1 + g) * (1 + g) - g; });
    near_zero("reciprocal", [](auto& g) { return 1 / (1 + g) + g / (1 + g) - 1; });
    // Kernels that compute an operation together with its only use.
    near_zero("multiple of a product",
              [](auto& g) { return (0.5 - 2 * (g * sin(g))) * g - 0.5 * g + 2 * g * g * sin(g); });
    near_zero("multiple of a square", [](auto& g) { return (0.5 - 2 * (g * g)) * g - 0.5 * g + 2 * pow(g, 3); });
    near_zero("multiple of a quotient", [](auto& g) { return (0.5 - 2 * (g / (1 + g))) * (1 + g) - 0.5 + 1.5 * g; });
    near_zero("multiple of a reciprocal", [](auto& g) { return (0.5 - 2 / (1 + g)) * (1 + g) + 1.5 - 0.5 * g; });
    near_zero("quotient of a sum",
              [](auto& g) { return (g * g - 3 * pow(g, 3)) / (1 + g) * (1 + g) - g * g + 3 * pow(g, 3); });
}

/// Where erf is 1 to the last digit, up to arguments whose square overflows.
TEST(Jet, ErrorFunctionOfLargeArgumentsIsConstant) {
    for (const auto set : testing::supported_sets())
        for (const double start : {7.0, 30.0, 1e3, 1e100, 1e160})
            for (const double sign : {1.0, -1.0}) {
                Problem p;
                const Expression x = p.state("x", sign * start);
                p.rates = {p.graph->number(1)};
                p.outputs = {erf(x)};
                const auto series = testing::output_series(p, highest_order, set)[0];
                EXPECT_EQ(series[0], sign) << start << " " << name_of(set);
                for (int k = 1; k <= highest_order; ++k) {
                    const auto expected = static_cast<double>(error_function_coefficient(k, std::min(start, 1e3)));
                    EXPECT_NEAR(std::abs(series[k]), std::abs(expected), 1e-12 * std::abs(expected) + 1e-300)
                        << k << " at " << start << " " << name_of(set);
                }
            }
}

TEST(Jet, SeriesOfKnownSolutionsAreExact) {
    for (const auto set : testing::supported_sets()) {
        Problem exponential;
        const Expression x = exponential.state("x", 1.5);
        exponential.rates = {x};
        const auto grown = testing::state_series(exponential, 0, highest_order, set);
        Problem blow_up;
        const Expression y = blow_up.state("y", 0.8);
        blow_up.rates = {y * y};
        const auto pole = testing::state_series(blow_up, 0, highest_order, set);
        Problem oscillator;
        const Expression q = oscillator.state("q", 0.3), v = oscillator.state("v", -0.4);
        oscillator.rates = {v, -q};
        const auto turned = testing::state_series(oscillator, 0, highest_order, set);
        for (int k = 0; k <= highest_order; ++k) {
            const double tolerance = (k + 2) * eps;
            EXPECT_NEAR(grown[k] * factorial(k), 1.5, 1.5 * tolerance);
            EXPECT_NEAR(pole[k] / std::pow(0.8, k + 1), 1, 2 * tolerance);
            EXPECT_NEAR(turned[k] * factorial(k), (k % 2 ? -0.4 : 0.3) * (k % 4 < 2 ? 1 : -1), tolerance);
        }
    }
}

/// The recurrences for one problem in long double.
TEST(Jet, PendulumAgreesWithLongDouble) {
    constexpr int order = highest_order;
    long double angle[order + 1] = {0.7L}, speed[order + 1] = {0.4L}, sine[order + 1], cosine[order + 1];
    angle[0] = 0.7;
    speed[0] = 0.4;
    sine[0] = std::sin(angle[0]);
    cosine[0] = std::cos(angle[0]);
    for (int k = 1; k <= order; ++k) {
        angle[k] = speed[k - 1] / k;
        speed[k] = (-sine[k - 1] - 0.125L * speed[k - 1]) / k;
        sine[k] = cosine[k] = 0;
        for (int j = 1; j <= k; ++j) {
            sine[k] += j * angle[j] * cosine[k - j] / k;
            cosine[k] -= j * angle[j] * sine[k - j] / k;
        }
    }
    Problem p;
    const Expression x = p.state("x", 0.7), v = p.state("v", 0.4);
    p.rates = {v, -sin(x) - 0.125 * v};
    for (const auto set : testing::supported_sets()) {
        const auto series = testing::state_series(p, 0, order, set);
        for (int k = 0; k <= order; ++k)
            EXPECT_NEAR(series[k], static_cast<double>(angle[k]), 20 * eps * std::pow(0.7, k)) << k;
    }
}

TEST(Jet, FreeFlightIsAPolynomial) {
    Problem p;
    const Expression x = p.state("x", 2), v = p.state("v", 3), g = p.parameter("g", 9.81);
    p.rates = {v, -g};
    p.outputs = {x * x, x * v - g};
    for (const auto set : testing::supported_sets()) {
        const auto flight = testing::state_series(p, 0, 10, set);
        EXPECT_EQ(flight, (std::vector<double>{2, 3, -9.81 / 2, 0, 0, 0, 0, 0, 0, 0, 0}));
        const auto outputs = testing::output_series(p, 10, set);
        EXPECT_NEAR(outputs[0][4], 9.81 * 9.81 / 4, 1e-14);
        EXPECT_EQ(outputs[0][5], 0);
        EXPECT_NEAR(outputs[1][3], 9.81 * 9.81 / 2, 1e-14);
        EXPECT_EQ(outputs[1][4], 0);
    }
}

TEST(Jet, BeginComputesTheFirstTwoCoefficients) {
    const Problem p = testing::everything();
    const Tape tape = p.tape();
    for (const auto set : testing::supported_sets()) {
        const auto jet = make_jet(tape, 5, LaneKind::single, set);
        const auto values = make_jet(tape, 5, LaneKind::single, set);
        jet->set_parameters(p.parameter_values);
        values->set_parameters(p.parameter_values);
        jet->compute(p.state_values);
        values->begin(p.state_values);
        for (std::size_t i = 0; i < p.outputs.size(); ++i)
            EXPECT_EQ(jet->output(i)[0], values->output(i)[0]) << i;
        for (std::size_t i = 0; i < p.states.size(); ++i) {
            EXPECT_EQ(jet->state(i)[0], p.state_values[i]);
            EXPECT_EQ(values->state(i)[0], p.state_values[i]);
            EXPECT_EQ(jet->state(i)[1], values->state(i)[1]) << i;
        }
    }
}

TEST(Jet, ComputeContinuesFromBegin) {
    const Problem p = testing::everything();
    const Tape tape = p.tape();
    std::vector<double> elsewhere = p.state_values;
    elsewhere[0] *= 1.25;
    for (const auto set : testing::supported_sets())
        for (const bool same : {true, false}) {
            const auto direct = make_jet(tape, 7, LaneKind::single, set);
            const auto begun = make_jet(tape, 7, LaneKind::single, set);
            direct->set_parameters(p.parameter_values);
            begun->set_parameters(p.parameter_values);
            direct->compute(p.state_values);
            begun->begin(same ? p.state_values : elsewhere);
            begun->compute(p.state_values);
            for (std::size_t i = 0; i < p.outputs.size(); ++i)
                for (int k = 0; k <= 7; ++k)
                    EXPECT_EQ(direct->output(i)[k], begun->output(i)[k]) << i << ' ' << k;
        }
}

TEST(Jet, ComparesEndsOfStepsWithItsOwnTapeOnly) {
    const Problem p = testing::everything();
    const auto jet = make_jet(p.tape(), 7, LaneKind::single), other = make_jet(p.tape(), 6, LaneKind::single);
    std::vector<double> numbers(p.states.size()), worst(1);
    EXPECT_THROW(jet->find_disagreement(*other, {}, std::vector<double>{1}, numbers, numbers, worst), InputError);
}

TEST(Jet, RepeatedComputationsAgree) {
    const Problem p = testing::everything();
    const Tape tape = p.tape();
    const auto jet = make_jet(tape, 12, LaneKind::single);
    jet->set_parameters(p.parameter_values);
    jet->compute(p.state_values);
    const std::vector<double> first(jet->output(9), jet->output(9) + 13);
    std::vector<double> parameters = p.parameter_values;
    parameters[0] = std::numeric_limits<double>::quiet_NaN();
    jet->set_parameters(parameters);
    jet->compute(std::vector<double>(p.states.size(), std::numeric_limits<double>::infinity()));
    jet->set_parameters(p.parameter_values);
    jet->compute(p.state_values);
    EXPECT_EQ(first, std::vector<double>(jet->output(9), jet->output(9) + 13));
}

TEST(Jet, RatesAndOutputsMayBeConstant) {
    Problem p;
    const Expression a = p.parameter("a", 4);
    p.state("x", 1);
    p.rates = {sqrt(a)};
    p.outputs = {a * a, p.graph->number(7), p.states[0]};
    for (const auto set : testing::supported_sets())
        for (const int order : {1, 3}) {
            std::vector<double> zeros(order + 1, 0.0);
            const auto outputs = testing::output_series(p, order, set);
            zeros[0] = 16;
            EXPECT_EQ(outputs[0], zeros);
            zeros[0] = 7;
            EXPECT_EQ(outputs[1], zeros);
            zeros[0] = 1;
            zeros[1] = 2;
            EXPECT_EQ(outputs[2], zeros);
        }
}

TEST(Jet, TapesMayHaveNoStates) {
    Problem p;
    p.outputs = {2 * p.parameter("a", 3)};
    const auto outputs = testing::output_series(p, 2, best_instruction_set());
    EXPECT_EQ(outputs[0], (std::vector<double>{6, 0, 0}));
    EXPECT_NO_THROW(make_jet(compile_tape({}, {}, {}, {}), 1, LaneKind::single)->compute({}));
}

TEST(Jet, UnsupportedInstructionSetsAreRefused) {
    for (const auto set : {InstructionSet::avx2, InstructionSet::avx512})
        if (!is_supported(set)) {
            EXPECT_THROW(make_jet(testing::everything().tape(), 3, LaneKind::single, set), InputError);
        }
}

TEST(Jet, BestInstructionSetIsSupported) {
    EXPECT_TRUE(is_supported(InstructionSet::baseline));
    EXPECT_TRUE(is_supported(best_instruction_set()));
    EXPECT_EQ(lanes_of(LaneKind::single, best_instruction_set()), 1);
}

} // namespace graze::jet_test
