// Derivatives of trajectories with respect to initial state and parameters.

#include "closed_form.hpp"
#include "simulate.hpp"

#include <gtest/gtest.h>

#include <numbers>

using namespace graze;
using namespace graze::testing;

namespace tangents_test {

using Real = long double;

/// A run with derivatives with respect to all states and parameters.
class Differentiated {
public:
    Differentiated(const Model& model, std::vector<double> state, std::size_t mode, double end_time,
                   double tolerance = 1e-14)
        : simulation_(System(model), {}, {}, with_tolerance(tolerance)),
          trajectory_(simulation_, model.parameter_values(), borrowed(recorder_)),
          columns_(state.size() + trajectory_.parameters().size()) {
        std::vector<double> seeds(columns_ * columns_, 0.0);
        for (std::size_t i = 0; i < columns_; ++i)
            seeds[i * columns_ + i] = 1;
        trajectory_.start(state, mode, 0, end_time);
        trajectory_.carry_tangents(seeds, columns_);
        run(trajectory_);
    }
    /// Returns the derivative of a state with respect to an initial state, or (higher columns) a parameter.
    double operator()(std::size_t state, std::size_t column) const {
        return trajectory_.tangents()[state * columns_ + column];
    }
    double by_parameter(std::size_t state, const char* name) const {
        const auto symbols = simulation_.model().parameter_symbols();
        for (std::size_t j = 0; j < symbols.size(); ++j)
            if (symbols[j].name() == name)
                return (*this)(state, trajectory_.state().size() + j);
        throw InputError(std::string("no parameter ") + name, "");
    }
    std::size_t columns() const { return columns_; }
    const Trajectory& trajectory() const { return trajectory_; }
    std::span<const double> state() const { return trajectory_.state(); }
    std::size_t contacts() const { return recorder_.contacts().size(); }

private:
    Simulation simulation_;
    Recorder recorder_;
    Trajectory trajectory_;
    std::size_t columns_;
};

/// Central differences, extrapolated to order 4.
template <class Number, class Function>
std::vector<Number> difference(Function f, Number h) {
    const auto wide_up = f(h), wide_down = f(-h), up = f(h / 2), down = f(-h / 2);
    std::vector<Number> result(up.size());
    for (std::size_t i = 0; i < up.size(); ++i)
        result[i] = (8 * (up[i] - down[i]) - (wide_up[i] - wide_down[i])) / (6 * h);
    return result;
}

/// zeta, omega, amplitude, sigma, e; then x, v, theta.
using OscillatorInput = std::array<Real, 8>;

/// The linear impact oscillator in closed form between impacts.
std::vector<Real> impact_oscillator(const OscillatorInput& in, Real end, int* impacts = nullptr) {
    Real time = 0, x = in[5], v = in[6];
    for (;;) {
        LinearOscillator oscillator(in[0], in[1], in[2]);
        oscillator.start(x, v, in[7] + in[1] * time);
        const Real spacing = 0.02L / std::max<Real>(1, in[1]);
        Real s = 1e-9L; // just after the impact
        while (s < end - time && oscillator.x(s) < in[3])
            s += spacing;
        if (s >= end - time && !(oscillator.x(end - time) >= in[3])) {
            const auto motion = oscillator.at(end - time);
            return {motion.x, motion.v};
        }
        const auto height = [&](Real t) {
            const auto motion = oscillator.at(t);
            return std::pair(motion.x - in[3], motion.v);
        };
        s = root_in(height, s - spacing, std::min(s, end - time));
        time += s;
        x = in[3];
        v = -in[4] * oscillator.v(s);
        if (impacts)
            ++*impacts;
    }
}

TEST(Tangents, OfTheLinearImpactOscillatorAreExact) {
    Random random(31);
    int impacts = 0;
    double worst = 0;
    for (int i = 0; i < 60; ++i) {
        OscillatorInput in{random.uniform(0.01, 0.1), random.uniform(1.8, 3),   random.uniform(0.5, 1),
                           random.uniform(0, 0.3),    random.uniform(0.6, 0.9), random.uniform(-1, -0.2),
                           random.uniform(-0.5, 0.5), random.uniform(0, 6)};
        const double end = random.uniform(1, 12);
        const auto number = [&](std::size_t k) { return static_cast<double>(in[k]); };
        const Model model = shipped_with("impact-oscillator", {{"zeta", number(0)},
                                                               {"omega", number(1)},
                                                               {"amplitude", number(2)},
                                                               {"sigma", number(3)},
                                                               {"e", number(4)}});
        const Differentiated run(model, {number(5), number(6), number(7)}, 0, end);
        ASSERT_TRUE(run.trajectory().tangents_valid());
        int made = 0;
        impact_oscillator(in, end, &made);
        if (static_cast<std::size_t>(made) != run.contacts())
            continue; // at rest, or grazing
        impacts += made;
        for (std::size_t k = 0; k < 8; ++k) {
            const auto expected = difference(
                [&](Real h) {
                    OscillatorInput moved = in;
                    moved[k] += h;
                    return impact_oscillator(moved, end);
                },
                Real(1e-5L));
            const std::size_t column = k < 5 ? 3 + k : k - 5;
            for (std::size_t s = 0; s < 2; ++s) {
                const double scale = 1 + static_cast<double>(std::abs(expected[0]) + std::abs(expected[1]));
                worst = std::max(worst, std::abs(run(s, column) - static_cast<double>(expected[s])) / scale);
            }
        }
        // Each impact multiplies areas by e^2.
        const double determinant = run(0, 0) * run(1, 1) - run(0, 1) * run(1, 0);
        const double expected = std::pow(number(4), 2 * made) * std::exp(-2 * number(0) * end);
        const double terms = std::abs(run(0, 0) * run(1, 1)) + std::abs(run(0, 1) * run(1, 0));
        EXPECT_NEAR(determinant, expected, 1e-13 * (terms + 1)) << i;
    }
    EXPECT_GT(impacts, 100);
    EXPECT_LT(worst, 1e-10);
}

/// A motion that follows a slow force takes long steps, during which disturbances oscillate several times.
TEST(Tangents, AreAccurateWhereTheMotionIsSlow) {
    Model model = load_model("impact-oscillator");
    const double zeta = 0.02, omega = 0.02, amplitude = 0.1;
    model.set_parameter("sigma", 0.5);
    model.set_parameter("amplitude", amplitude);
    model.set_parameter("omega", omega);
    // The motion is the particular solution A cos(theta) + B sin(theta).
    const double detuning = 1 - omega * omega, damping = 2 * zeta * omega;
    const double denominator = detuning * detuning + damping * damping;
    const double A = amplitude * detuning / denominator, B = amplitude * damping / denominator;
    for (const double time : {1.0, 20.0, 100.0}) {
        const Differentiated run(model, {A, B * omega, 0}, 0, time, 1e-12);
        const double d = std::sqrt(1 - zeta * zeta), decay = std::exp(-zeta * time);
        const double c = std::cos(d * time), s = std::sin(d * time);
        const double tolerance = 1e-11 * time;
        EXPECT_NEAR(run(0, 0), decay * (c + zeta / d * s), tolerance) << time;
        EXPECT_NEAR(run(0, 1), decay * s / d, tolerance) << time;
        EXPECT_NEAR(run(1, 0), -decay * s / d, tolerance) << time;
        EXPECT_NEAR(run(1, 1), decay * (c - zeta / d * s), tolerance) << time;
    }
}

TEST(Tangents, PropagateTimeShiftsAlongAutonomousFlows) {
    // A start slightly later on the same trajectory stays later by the same time: through impacts, slips and rests.
    for (const auto& [name, end] : std::vector<std::pair<std::string, double>>{{"impact-oscillator", 40},
                                                                               {"impact-microactuator", 25},
                                                                               {"electromagnetic-testbed", 1},
                                                                               {"mems-switch", 20},
                                                                               {"ball-and-shaker", 1.7},
                                                                               {"bouncing-ball", 1.03},
                                                                               {"dry-friction-oscillator", 30},
                                                                               {"impact-oscillator-two-stops", 20},
                                                                               {"microbeam", 1}}) {
        const Model model = load_model(name);
        const System compiled(model);
        const std::size_t n = model.states.size();
        std::vector<double> state = model.initial_state(), inputs, work(compiled.workspace());
        const auto field = [&](std::span<const double> at, std::size_t mode) {
            inputs.assign(at.begin(), at.end());
            const auto parameters = model.parameter_values();
            inputs.insert(inputs.end(), parameters.begin(), parameters.end());
            std::vector<double> rates(n);
            compiled.mode(mode).rates.evaluate(inputs, rates, work);
            return rates;
        };
        const auto before = field(state, model.initial_mode);
        const Differentiated run(model, state, model.initial_mode, end);
        ASSERT_TRUE(run.trajectory().tangents_valid()) << name;
        const auto after = field(run.state(), run.trajectory().mode());
        double size = 0;
        for (std::size_t i = 0; i < n; ++i)
            for (std::size_t j = 0; j < n; ++j)
                size = std::max(size, std::abs(run(i, j) * before[j]));
        for (std::size_t i = 0; i < n; ++i) {
            double moved = 0;
            for (std::size_t j = 0; j < n; ++j)
                moved += run(i, j) * before[j];
            EXPECT_NEAR(moved, after[i], 1e-9 * (size + std::abs(after[i]))) << name << " " << model.states[i].name;
        }
        EXPECT_GT(run.contacts(), 0U) << name;
    }
}

/// The final state of a run, and its sequence of contacts.
struct End {
    std::vector<double> state;
    std::vector<std::size_t> transitions;
};

End end_of(const Simulation& simulation, JetSet& jets, const std::vector<double>& input, std::size_t states,
           std::size_t mode, double end_time) {
    Recorder recorder;
    const std::span<const double> all(input);
    Trajectory trajectory(simulation, all.subspan(states), borrowed(recorder));
    trajectory.start(all.first(states), mode, 0, end_time);
    graze::run(trajectory, jets);
    End end{{trajectory.state().begin(), trajectory.state().end()}, {}};
    for (const auto& record : recorder.contacts())
        if (record.contact.kind != ContactKind::touch)
            end.transitions.push_back(record.contact.transition);
    return end;
}

TEST(Tangents, OfShippedModelsAgreeWithDifferences) {
    struct Case {
        std::string name;
        double end, step;
    };
    // Closer to grazing, smaller differences are needed.
    for (const Case& one : std::vector<Case>{{"impact-oscillator", 12.3, 1e-4},
                                             {"impact-microactuator", 21, 1e-5},
                                             {"electromagnetic-testbed", 0.45, 1e-4},
                                             {"mems-switch", 13, 1e-7},
                                             {"ball-and-shaker", 0.5, 4e-6},
                                             {"bouncing-ball", 0.63, 1e-4},
                                             {"dry-friction-oscillator", 20, 1e-4},
                                             {"impact-oscillator-two-stops", 9, 1e-4},
                                             {"microbeam", 0.4, 1e-4}}) {
        const Model model = load_model(one.name);
        const std::size_t n = model.states.size();
        const Differentiated run(model, model.initial_state(), model.initial_mode, one.end);
        ASSERT_TRUE(run.trajectory().tangents_valid()) << one.name;
        const Simulation simulation(System(model), {}, {}, with_tolerance(1e-15));
        JetSet jets(simulation, LaneKind::single);
        std::vector<double> input = model.initial_state();
        const auto parameters = model.parameter_values();
        input.insert(input.end(), parameters.begin(), parameters.end());
        const End plain = end_of(simulation, jets, input, n, model.initial_mode, one.end);
        std::size_t compared = 0;
        for (std::size_t k = 0; k < input.size(); ++k) {
            const double scale = std::abs(input[k]) > 0 ? std::abs(input[k]) : 1e-2;
            bool comparable = true;
            const auto expected = difference(
                [&](double h) {
                    std::vector<double> moved = input;
                    moved[k] += h;
                    End other = end_of(simulation, jets, moved, n, model.initial_mode, one.end);
                    comparable = comparable && other.transitions == plain.transitions;
                    for (std::size_t i = 0; i < n; ++i)
                        if (model.states[i].period && std::abs(other.state[i] - plain.state[i]) > 1)
                            other.state[i] +=
                                other.state[i] < plain.state[i] ? 2 * std::numbers::pi : -2 * std::numbers::pi;
                    return other.state;
                },
                one.step * scale);
            if (!comparable)
                continue;
            ++compared;
            for (std::size_t i = 0; i < n; ++i) {
                // Errors in units of the states and of the parameter.
                const double unit = (std::abs(plain.state[i]) + 1e-3) / scale;
                double size = unit;
                for (std::size_t j = 0; j < n; ++j)
                    size = std::max(size, std::abs(expected[j]) * (std::abs(plain.state[i]) + 1e-3) /
                                              (std::abs(plain.state[j]) + 1e-3));
                const double error = std::abs(run(i, k) - expected[i]) / size;
                EXPECT_LT(error, 1e-6) << one.name << ": " << model.states[i].name << " by input " << k << ", "
                                       << run(i, k) << " for " << expected[i];
            }
        }
        EXPECT_GT(run.contacts(), 1U) << one.name;
        EXPECT_GE(compared, input.size() - 3) << one.name;
    }
}

TEST(Tangents, PassCompletedChatterToRest) {
    // At rest the ball has the height and velocity of the table, independent of its earlier motion.
    const double a = 0.002, f = 10, omega = 2 * std::numbers::pi * f;
    const Model model = shipped_with("bouncing-ball", {{"a", a}, {"f", 10}, {"e", 0.4}, {"g", 25}});
    const Differentiated run(model, {0.01, 0, 0.3}, 0, 0.42);
    ASSERT_EQ(model.modes[run.trajectory().mode()].name, "rest");
    ASSERT_TRUE(run.trajectory().tangents_valid());
    const double theta = run.state()[2];
    for (const std::size_t column : {0U, 1U}) {
        EXPECT_NEAR(run(0, column), 0, 1e-10);
        EXPECT_NEAR(run(1, column), 0, 1e-8);
    }
    EXPECT_NEAR(run(0, 2), a * std::cos(theta), 1e-11);
    EXPECT_NEAR(run(1, 2), -a * omega * std::sin(theta), 1e-9);
    EXPECT_NEAR(run.by_parameter(0, "e"), 0, 1e-10);
    EXPECT_NEAR(run.by_parameter(0, "g"), 0, 1e-10);
    EXPECT_NEAR(run.by_parameter(0, "a"), std::sin(theta), 1e-9);
    EXPECT_NEAR(run.by_parameter(1, "a"), omega * std::cos(theta), 1e-7);
    EXPECT_NEAR(run.by_parameter(0, "f"), a * std::cos(theta) * 2 * std::numbers::pi * 0.42, 1e-10);
}

TEST(Tangents, OfTheTimeOfRestAreExact) {
    // A second state counts the time since rest: its derivatives are minus those of sqrt(2 h / g) (1 + e) / (1 - e).
    const Model model = model_from(R"toml(
name = "ball-and-clock"
parameters = { g = 9.81, e = 0.6 }
states = { x = 1, v = 0, rested = 0 }
modes.flight = { rates = { x = "v", v = "-g", rested = 0 }, watch = ["floor"] }
modes.rest = { rates = { x = 0, v = 0, rested = 1 } }
initial.mode = "flight"
events = { floor = "x" }
jumps.impact.v = "-e*v"
jumps.land = { x = 0, v = 0 }
transitions = [
  { mode = "flight", event = "floor", jump = "impact", next = "flight", chatter = { jump = "land", mode = "rest" } },
]
)toml");
    for (const double tolerance : {1e-8, 1e-14}) {
        const double g = 9.81, e = 0.6, h = 1, rest = std::sqrt(2 * h / g) * (1 + e) / (1 - e);
        const Differentiated run(model, {h, 0, 0}, 0, 5, tolerance);
        ASSERT_TRUE(run.trajectory().tangents_valid());
        EXPECT_NEAR(run.state()[2], 5 - rest, 1e-13);
        EXPECT_NEAR(run(2, 0), -rest / (2 * h), 1e-9);
        EXPECT_NEAR(run(2, 1), -1 / g, 1e-9);
        EXPECT_NEAR(run.by_parameter(2, "g"), rest / (2 * g), 1e-9);
        // The effect of e on the flights that are completed at once, which last for about sqrt(tolerance), is
        // neglected.
        EXPECT_NEAR(run.by_parameter(2, "e"), -std::sqrt(2 * h / g) * 2 / ((1 - e) * (1 - e)), std::sqrt(tolerance));
    }
}

TEST(Tangents, AreInvalidAfterAGraze) {
    const Differentiated pressed(load_model("impact-oscillator"), {0.1, 0, 0.3}, 0, 0.2);
    EXPECT_GT(pressed.contacts(), 0U);
    EXPECT_FALSE(pressed.trajectory().tangents_valid());
    const Differentiated clear(load_model("impact-oscillator"), {-0.9, 0, 0.3}, 0, 0.2);
    EXPECT_TRUE(clear.trajectory().tangents_valid());
}

TEST(Tangents, GiveTheMultipliersOfTheSmoothGrazingOrbit) {
    const Model model = shipped_with("mems-switch", {{"V", 0.2013662121541341}, {"delta", 10}});
    const Differentiated run(model, {-0.6, 0, 0.7306205700512591}, 0, 2 * std::numbers::pi, 1e-16);
    EXPECT_NEAR(run.state()[0], -0.6, 1e-11);
    EXPECT_NEAR(run.state()[1], 0, 1e-11);
    const double trace = run(0, 0) + run(1, 1), determinant = run(0, 0) * run(1, 1) - run(0, 1) * run(1, 0);
    EXPECT_NEAR(trace / 2, 0.8765517138529, 1e-9);
    EXPECT_NEAR(std::sqrt(determinant - trace * trace / 4), 0.0970812655112, 1e-9);
    EXPECT_NEAR(determinant, std::exp(-0.08 * std::numbers::pi), 1e-13);
}

TEST(Tangents, GiveTheMultipliersOfTheImpactingPeriodThreeOrbit) {
    const Model model = load_model("electromagnetic-testbed");
    const double beta2 = 1.631e-3, w0 = 95.94;
    const double current = std::sqrt(2 * 0.6462 * w0 * w0 * beta2 * beta2 * beta2 / 1.902e-5);
    std::vector<double> state{-0.02132575268965 * beta2, -0.51756427523650 * beta2 * w0, -0.73263907207969 * current,
                              0};
    const std::vector<double> units{beta2, beta2 * w0, current};
    const Differentiated run(model, state, 0, 0.48, 1e-15);
    EXPECT_GE(run.contacts(), 1U);
    double m[3][3];
    for (std::size_t i = 0; i < 3; ++i) {
        EXPECT_NEAR(run.state()[i] / units[i], state[i] / units[i], 1e-12);
        for (std::size_t j = 0; j < 3; ++j)
            m[i][j] = run(i, j) * units[j] / units[i];
    }
    const auto characteristic = [&](double lambda) {
        const double a = m[0][0] - lambda, b = m[1][1] - lambda, c = m[2][2] - lambda;
        return a * (b * c - m[1][2] * m[2][1]) - m[0][1] * (m[1][0] * c - m[1][2] * m[2][0]) +
               m[0][2] * (m[1][0] * m[2][1] - b * m[2][0]);
    };
    // The published value is bracketed by a change of sign between the neighbours of its last digit.
    for (const double multiplier : {0.6128, 0.1126})
        EXPECT_LT(characteristic(multiplier - 5e-5) * characteristic(multiplier + 5e-5), 0) << multiplier;
    EXPECT_NEAR(m[0][0] + m[1][1] + m[2][2], 0.6128 + 0.1126, 1e-3);
}

} // namespace tangents_test
