#include "graze/flow/tangent_steps.hpp"

#include "graze/flow/mode_flow.hpp"
#include "graze/flow/variational_system.hpp"
#include "graze/model/model_file.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

namespace graze::tangent_steps_test {

using Number = long double;
using Matrix = std::vector<std::vector<Number>>;

constexpr double omega = 0.9, force = 1.3;

/// A chain of oscillators, each with its own unit of length and all with one unit of time; the first is forced. States:
/// displacement and speed alternating, then the phase of the force.
struct Chain {
    std::size_t links;
    double time_unit = 1;
    std::vector<double> units; ///< units of displacements, one for each oscillator
    double cubic = 0;

    double unit(std::size_t state) const {
        return state == 2 * links ? 1 : state % 2 == 0 ? units[state / 2] : units[state / 2] / time_unit;
    }
    /// Returns the coefficient of a state in the acceleration of an oscillator.
    double coefficient(std::size_t link, std::size_t state) const {
        const double share = unit(2 * link + 1) / unit(state) / time_unit;
        return state == 2 * link ? -2.2 * share : state == 2 * link + 1 ? -0.04 * share : share;
    }
    std::string model() const {
        std::string text = fmt::format("name = \"chain\"\n[parameters]\nF = {}\n[states]\n", force), rates;
        for (std::size_t i = 0; i < links; ++i) {
            text += fmt::format("x{} = {:.17g}\nv{} = 0\n", i, 0.001 * units[i], i);
            rates += fmt::format("x{0} = \"v{0}\"\nv{0} = \"({1:.17g})*x{0} + ({2:.17g})*v{0}", i,
                                 coefficient(i, 2 * i), coefficient(i, 2 * i + 1));
            if (i > 0)
                rates += fmt::format(" + ({:.17g})*x{}", coefficient(i, 2 * i - 2), i - 1);
            if (i + 1 < links)
                rates += fmt::format(" + ({:.17g})*x{}", coefficient(i, 2 * i + 2), i + 1);
            if (cubic != 0)
                rates += fmt::format(" - {:.17g}*x{}^3", cubic, i);
            rates += i == 0 ? fmt::format(" + {:.17g}*F*cos(phase)\"\n", unit(1) / time_unit) : "\"\n";
        }
        return text + "phase = { initial = 0.4, period = \"2*pi\" }\n[modes.m.rates]\n" + rates +
               fmt::format("phase = {:.17g}\n[initial]\nmode = \"m\"\n", omega / time_unit);
    }

    /// Returns exp(A t) with A y = y' for y of displacements, speeds, and cosine and sine of the force, by scaling and
    /// squaring of a Taylor series.
    Matrix exponential(Number time) const {
        const std::size_t n = 2 * links + 2;
        Matrix a(n, std::vector<Number>(n, 0));
        for (std::size_t i = 0; i < links; ++i) {
            a[2 * i][2 * i + 1] = 1;
            a[2 * i + 1][2 * i] = coefficient(i, 2 * i);
            a[2 * i + 1][2 * i + 1] = coefficient(i, 2 * i + 1);
            if (i > 0)
                a[2 * i + 1][2 * i - 2] = coefficient(i, 2 * i - 2);
            if (i + 1 < links)
                a[2 * i + 1][2 * i + 2] = coefficient(i, 2 * i + 2);
        }
        const Number rate = omega / time_unit;
        a[1][n - 2] = Number(unit(1) / time_unit);
        a[n - 2][n - 1] = -rate;
        a[n - 1][n - 2] = rate;
        const auto times = [n](const Matrix& b, const Matrix& c) {
            Matrix product(n, std::vector<Number>(n, 0));
            for (std::size_t i = 0; i < n; ++i)
                for (std::size_t k = 0; k < n; ++k)
                    for (std::size_t j = 0; j < n && b[i][k] != 0; ++j)
                        product[i][j] += b[i][k] * c[k][j];
            return product;
        };
        constexpr int squarings = 10, terms = 24;
        Matrix sum(n, std::vector<Number>(n, 0)), term = sum;
        for (std::size_t i = 0; i < n; ++i)
            term[i][i] = sum[i][i] = 1;
        for (auto& row : a)
            for (Number& entry : row)
                entry *= std::ldexp(time, -squarings);
        for (int k = 1; k <= terms; ++k) {
            term = times(term, a);
            for (std::size_t i = 0; i < n; ++i)
                for (std::size_t j = 0; j < n; ++j)
                    sum[i][j] += (term[i][j] /= k);
        }
        for (int k = 0; k < squarings; ++k)
            sum = times(sum, sum);
        return sum;
    }
    /// Returns the derivatives of the states with respect to initial states and the force, from the exponential.
    Matrix derivatives(Number time) const {
        const Matrix e = exponential(time);
        const std::size_t n = 2 * links + 1;
        const Number phase = 0.4L;
        Matrix all(n, std::vector<Number>(n + 1, 0));
        for (std::size_t i = 0; i + 1 < n; ++i) {
            for (std::size_t j = 0; j + 1 < n; ++j)
                all[i][j] = e[i][j];
            all[i][n - 1] = Number(force) * (e[i][n] * std::cos(phase) - e[i][n - 1] * std::sin(phase));
            all[i][n] = e[i][n - 1] * std::cos(phase) + e[i][n] * std::sin(phase);
        }
        all[n - 1][n - 1] = 1;
        return all;
    }
};

Chain chain_of(std::size_t links, double time_unit, double even, double odd) {
    Chain chain{links, time_unit, {}, 0};
    for (std::size_t i = 0; i < links; ++i)
        chain.units.push_back(i % 2 == 0 ? even : odd);
    return chain;
}

struct Flow {
    std::vector<double> state, derivatives;
    std::size_t steps = 0;
};

Flow flow_of(const Model& model, double tolerance, double time, bool with_derivatives) {
    const std::size_t n = model.states.size();
    ModeFlow flow(System(model), tolerance, 0, {ParameterId(0)});
    flow.set_parameters(model.parameter_values());
    Flow result{model.initial_state(), std::vector<double>(n * (n + 1)), 0};
    EXPECT_EQ(with_derivatives ? flow.run(0, result.state, time, result.derivatives) : flow.run(0, result.state, time),
              ModeFlow::Ending::done);
    result.steps = flow.steps();
    return result;
}

/// Errors of entries are measured against the size of their direction, in the units of the states.
TEST(TangentSteps, AreAccurateAlongAChainInAnyUnits) {
    constexpr double micro = 1e-6, nano = 1e-9, mega = 1e6;
    for (const std::size_t links : {1, 6, 14})
        for (const auto& [time_unit, even, odd] :
             {std::array{1.0, 1.0, 1.0}, {nano, micro, micro}, {mega, nano, mega}, {micro, mega, nano}})
            for (const double share : {0.03, 1.0}) {
                const Chain chain = chain_of(links, time_unit, even, odd);
                const double time = share * 2 * std::numbers::pi / omega * time_unit;
                const Model model = parse_model(chain.model(), "chain.toml");
                const Matrix exact = chain.derivatives(time);
                const std::size_t n = model.states.size();
                for (const double tolerance : {1e-6, 1e-9, 1e-12}) {
                    const Flow flow = flow_of(model, tolerance, time, true);
                    for (std::size_t d = 0; d <= n; ++d) {
                        Number size = 0;
                        for (std::size_t i = 0; i < n; ++i)
                            size = std::max(size, std::abs(exact[i][d]) / chain.unit(i));
                        for (std::size_t i = 0; i < n; ++i)
                            // Usually the error is below one tolerance per step; round-off adds a few hundred units.
                            EXPECT_LE(std::abs(flow.derivatives[i * (n + 1) + d] - exact[i][d]) / chain.unit(i),
                                      (3 * tolerance + 1e-13) * size)
                                << links << " links, entry " << i << ' ' << d << " tolerance " << tolerance
                                << " units of time " << time_unit;
                    }
                }
            }
}

/// States that have only begun to move need no shorter steps than the others; units have no effect.
TEST(TangentSteps, StepsAreHardlyMoreThanThoseOfTheMotion) {
    for (const double tolerance : {1e-6, 1e-9, 1e-12}) {
        std::size_t others = 0;
        for (const double unit : {1.0, 0x1p-30, 0x1p20}) {
            Chain chain = chain_of(20, 1, unit, unit);
            chain.cubic = 0.1 / (unit * unit);
            const Model model = parse_model(chain.model(), "chain.toml");
            const Flow alone = flow_of(model, tolerance, 7, false), flow = flow_of(model, tolerance, 7, true);
            // Floors are used where steps would be shorter than 0.8 of the motion's.
            EXPECT_LE(flow.steps, alone.steps + 1 + alone.steps / 4) << tolerance;
            EXPECT_TRUE(others == 0 || flow.steps == others) << tolerance << ' ' << unit;
            others = flow.steps;
            for (std::size_t i = 0; i < alone.state.size(); ++i)
                EXPECT_NEAR(flow.state[i], alone.state[i], 10 * tolerance * chain.unit(i));
        }
    }
}

/// Directions that are faster than the motion and come after others: all take the shorter steps.
TEST(TangentSteps, StepsAreShortenedForFasterDirections) {
    std::string states, rates;
    constexpr std::size_t slow = 33; // more directions than are computed side by side
    ASSERT_LT(TangentSteps::together(slow), slow);
    for (std::size_t i = 0; i < slow; ++i) {
        states += fmt::format("x{} = {}\n", i, 1 + i);
        rates += fmt::format("x{0} = \"-x{0}\"\n", i);
    }
    const Model model = parse_model("name = \"a\"\n[states]\n" + states + "a = 0\nb = 0\n[modes.m.rates]\n" + rates +
                                        "a = \"b\"\nb = \"-10000*a\"\n[initial]\nmode = \"m\"\n",
                                    "a.toml");
    constexpr double tolerance = 1e-12, time = 2;
    ModeFlow flow(System(model), tolerance);
    flow.set_parameters({});
    const std::size_t n = model.states.size();
    std::vector<double> state = model.initial_state(), derivatives(n * n);
    ASSERT_EQ(flow.run(0, state, time, derivatives), ModeFlow::Ending::done);
    EXPECT_LE(flow.steps(), 200u); // a step of one radian is not long
    for (std::size_t i = 0; i < slow; ++i)
        EXPECT_NEAR(derivatives[i * n + i], std::exp(-time), 10 * tolerance);
    // Two hundred radians, each with an error of about one tolerance.
    constexpr double angle = 100 * time;
    EXPECT_NEAR(derivatives[slow * n + slow], std::cos(angle), angle * tolerance);
    EXPECT_NEAR(100 * derivatives[slow * n + slow + 1], std::sin(angle), angle * tolerance);
    EXPECT_NEAR(derivatives[(slow + 1) * n + slow] / 100, -std::sin(angle), angle * tolerance);
    EXPECT_EQ(derivatives[slow * n], 0);
}

/// Oscillators coupled to their mean, which is an intermediate quantity of the first variational equations.
std::string mean_field(std::size_t count) {
    std::string states, rates, mean;
    for (std::size_t i = 0; i < count; ++i) {
        states += fmt::format("x{0} = {1}\nv{0} = {2}\n", i, 0.3 + 0.05 * static_cast<double>(i), 0.1);
        rates += fmt::format("x{0} = \"v{0}\"\nv{0} = \"-{1}*x{0} - 0.1*v{0} + K*mean*cos(x{0}) + exp(-mean^2)\"\n", i,
                             1 + 0.1 * static_cast<double>(i));
        mean += fmt::format("{}sin(x{})*v{}", i == 0 ? "" : " + ", i, (i + 1) % count);
    }
    return fmt::format("name = \"mean-field\"\n[parameters]\nK = 0.4\n[definitions]\nmean = \"({})/{}\"\n[states]\n{}"
                       "[modes.m.rates]\n{}[initial]\nmode = \"m\"\n",
                       mean, count, states, rates);
}

/// The tangent computed as part of the state of a larger system, without derivatives of flows.
TEST(TangentSteps, AgreeWithTheVariationalSystemOfAMeanField) {
    constexpr double tolerance = 1e-13, time = 3;
    const Model model = parse_model(mean_field(12), "mean_field.toml");
    const System system(model);
    ASSERT_GT(system.linear(0).equations.intermediates, 0u);
    const std::size_t n = system.states();
    const std::vector<ParameterId> free = {model.independent_parameter("K")};
    ModeFlow flow(system, tolerance, 0, free);
    flow.set_parameters(model.parameter_values());
    std::vector<double> state = model.initial_state(), derivatives(n * (n + 1));
    ASSERT_EQ(flow.run(0, state, time, derivatives), ModeFlow::Ending::done);
    const VariationalSystem variational(system, free);
    ModeFlow larger(variational.modes(), tolerance, 0, {}, std::vector<std::size_t>{});
    for (const std::size_t d : {std::size_t{0}, std::size_t{7}, n - 1, n}) {
        std::vector<double> parameters = model.parameter_values(), both = model.initial_state();
        parameters.push_back(d == n ? 1 : 0);
        both.resize(2 * n, 0.0);
        if (d < n)
            both[n + d] = 1;
        larger.set_parameters(parameters);
        ASSERT_EQ(larger.run(0, both, time), ModeFlow::Ending::done);
        for (std::size_t i = 0; i < n; ++i)
            // Derivatives are allowed fifty tolerances, but need only a few.
            EXPECT_NEAR(derivatives[i * (n + 1) + d], both[n + i], 20 * tolerance) << i << ' ' << d;
    }
}

} // namespace graze::tangent_steps_test
