#include "flow/couplings.hpp"

#include "graze/base/input_error.hpp"
#include "graze/model/model_file.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>

namespace graze::couplings_test {

constexpr double infinity = std::numeric_limits<double>::infinity(), roundoff = 1e-14;

Model model_of(const std::string& states, const std::string& rates) {
    return parse_model("name = \"a\"\nparameters = { k = 2 }\n[states]\n" + states + "[modes.m.rates]\n" + rates +
                           "[initial]\nmode = \"m\"\n",
                       "a.toml");
}

Couplings measured(const Model& model, const std::vector<double>& states, double k = 2) {
    Couplings couplings(System(model), 0);
    couplings.set_parameters(std::vector{k});
    couplings.measure(states);
    return couplings;
}

/// Returns |J_ij| time for all entries: the effect of a unit of one state on the others, by direct couplings only.
std::vector<double> row_of(const Couplings& couplings, std::size_t states, std::size_t from, double time) {
    std::vector<double> sizes(states, 0.0);
    sizes[from] = 1;
    couplings.spread(time, sizes, 1);
    return sizes;
}

TEST(Couplings, ResponseTimeOfAnOscillatorDoesNotDependOnUnits) {
    const Model model = model_of("x = 0\nv = 0\n", "x = \"v\"\nv = \"-k*x\"\n");
    for (const double k : {1e-18, 4.0, 1e12, 1e18}) {
        const Couplings couplings = measured(model, {0.3, 0.1}, k);
        EXPECT_NEAR(couplings.response_time() * std::sqrt(k), 1, 0.2);
        // Within a tenth of the response time, a displacement causes a speed of k t; this speed causes no further
        // displacement.
        const double time = 0.1 / std::sqrt(k);
        const std::vector<double> sizes = row_of(couplings, 2, 0, time);
        EXPECT_EQ(sizes[0], 1);
        EXPECT_NEAR(sizes[1] / (k * time), 1, roundoff);
    }
}

TEST(Couplings, ResponseTimeIsInfiniteWithoutCycles) {
    const Model model = model_of("x = 0\ny = 0\nz = 0\n", "x = 1\ny = \"3*x\"\nz = \"y^2\"\n");
    EXPECT_EQ(measured(model, {1, 1, 1}).response_time(), infinity);
    const std::vector<double> sizes = row_of(measured(model, {1, 5, 1}), 3, 0, 0.5);
    EXPECT_NEAR(sizes[1], 1.5, roundoff);
    EXPECT_NEAR(sizes[2], 7.5, roundoff); // the derivative of y^2 is 2 y
    // Where y = 0, y has no effect on z.
    EXPECT_EQ(row_of(measured(model, {1, 0, 1}), 3, 0, 0.5)[2], 0);
}

TEST(Couplings, FollowTheStateDependenceOfTheJacobian) {
    const Model model = model_of("x = 0\nv = 0\n", "x = \"v\"\nv = \"-x^3\"\n");
    Couplings couplings(System(model), 0);
    couplings.set_parameters(std::vector{2.0});
    couplings.measure(std::vector{0.0, 1.0});
    EXPECT_EQ(couplings.response_time(), infinity); // a free mass
    for (const double x : {1.0, 1e-6, 1e6, 1.0}) {
        couplings.measure(std::vector{x, 1.0});
        EXPECT_NEAR(couplings.response_time() * std::sqrt(3) * x, 1, 0.3) << x;
    }
    couplings.measure(std::vector{1e200, 1.0});
    EXPECT_EQ(couplings.response_time(), 0); // not finite
}

/// The units of three coupled states must not depend on the points at which they were measured before.
TEST(Couplings, DoNotDependOnEarlierMeasurements) {
    // Units of three states that all act on each other take several iterations.
    const Model model = model_of("x = 0\ny = 0\nz = 0\nw = 0\n",
                                 "x = \"k*exp(w)*y + z\"\ny = \"x + 3*z\"\nz = \"2*x + exp(-w)*y\"\nw = 1\n");
    for (const double w : {-9.0, -0.3, 0.05, 0.1, 12.0}) {
        Couplings used = measured(model, {0.3, 0.1, 0.2, w});
        used.measure(std::vector{0.3, 0.1, 0.2, 0.0});
        EXPECT_EQ(used.response_time(), measured(model, {0.3, 0.1, 0.2, 0.0}).response_time()) << w;
    }
}

TEST(Couplings, FindAllEntriesOfAFullRow) {
    std::string states, rates, sum;
    constexpr std::size_t n = 20;
    for (std::size_t i = 0; i < n; ++i) {
        states += fmt::format("x{} = 0\n", i);
        sum += fmt::format("{} sin({}*x{})", i == 0 ? "" : "+", i + 1, i);
    }
    for (std::size_t i = 0; i < n; ++i)
        rates += fmt::format("x{} = \"{}\"\n", i, i + 1 == n ? sum : "k");
    const Couplings couplings = measured(model_of(states, rates), std::vector<double>(n, 0.0));
    EXPECT_NEAR(couplings.response_time(), 1.0 / n, roundoff); // the last state acts on itself
    for (std::size_t i = 0; i + 1 < n; ++i)
        EXPECT_NEAR(row_of(couplings, n, i, 0.01)[n - 1], 0.01 * static_cast<double>(i + 1), roundoff) << i;
}

/// A chain, numbered with positions and speeds alternating or one after the other, from any link to any other.
TEST(Couplings, SpreadAlongAWholeChain) {
    constexpr std::size_t n = 30;
    constexpr double time = 0.3;
    for (const bool in_turn : {true, false}) {
        std::string states, speeds, rates;
        for (std::size_t i = 0; i < n; ++i) {
            states += fmt::format("x{} = 0\n", i);
            (in_turn ? states : speeds) += fmt::format("v{} = 0\n", i);
            rates += fmt::format("x{0} = \"v{0}\"\nv{0} = \"-2*x{0}", i) + (i > 0 ? fmt::format("+ x{}", i - 1) : "") +
                     (i + 1 < n ? fmt::format("+ x{}", i + 1) : "") + "\"\n";
        }
        const Model model = model_of(states + speeds, rates);
        const Couplings couplings = measured(model, std::vector<double>(2 * n, 0.0));
        EXPECT_NEAR(couplings.response_time(), 0.5, 0.05);
        for (const std::size_t from : {std::size_t{0}, std::size_t{11}, n - 1}) {
            const std::vector<double> sizes =
                row_of(couplings, 2 * n, model.find_state(fmt::format("x{}", from)).value(), time);
            for (std::size_t i = 0; i < n; ++i) {
                // Each link contributes the time twice.
                const double links = std::abs(static_cast<double>(i) - static_cast<double>(from));
                const double exact = std::pow(time, 2 * links);
                EXPECT_NEAR(sizes[model.find_state(fmt::format("x{}", i)).value()] / exact, 1, 1e-12) << from << i;
            }
        }
    }
}

TEST(Couplings, MisuseThrows) {
    const System system(model_of("x = 0\nv = 0\n", "x = \"v\"\nv = \"-k*x\"\n"));
    EXPECT_THROW(Couplings(system, 1), InputError);
    Couplings couplings(system, 0);
    EXPECT_THROW(couplings.set_parameters(std::vector<double>{}), InputError);
    EXPECT_THROW(couplings.measure(std::vector{1.0}), InputError);
    couplings.set_parameters(std::vector{2.0});
    couplings.measure(std::vector{1.0, 1.0});
    std::vector<double> sizes(4);
    EXPECT_THROW(couplings.spread(0.1, sizes, 1), InputError);
}

} // namespace graze::couplings_test
