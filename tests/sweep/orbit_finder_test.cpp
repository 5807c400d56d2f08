// Multipliers of orbits that motions settle on, against closed forms.

#include "settle.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <string>
#include <vector>

namespace graze::orbit_finder_test {

/// An elastic ball, from rest at x = 1 with g = 2: it returns after 2 units of time.
Model elastic_ball(const std::string& state, const std::string& rate) {
    return testing::OneMode{.states = "x = 1\nv = 0\n" + state,
                            .rates = "x = 'v', v = -2" + rate,
                            .stops = {{"floor", "x", "v = '-v'"}},
                            .more = testing::section("top", "v", "falling")}
        .model();
}

void expect_multipliers(const PointResult& result, const std::vector<double>& known, double error = 1e-10) {
    ASSERT_EQ(result.label, Label::periodic) << result.outcome.detail;
    ASSERT_EQ(result.multipliers.size(), known.size());
    for (std::size_t m = 0; m < known.size(); ++m)
        EXPECT_NEAR(std::abs(result.multipliers[m] - known[m]), 0, error) << m << ": " << result.multipliers[m];
    EXPECT_EQ(result.outcome.detail.find("multiplier is 1") != std::string::npos, known.front() == 1);
}

TEST(OrbitFinder, MultipliersAreThoseOfTheOrbitNotOfTheTransient) {
    // The product of r (1 - 2z) along the orbit, which is sensitive for long orbits.
    AttractorOptions options;
    options.largest_period = 12;
    struct Case {
        double r;
        std::size_t period;
    };
    for (const Case& one : {Case{3.8494, 48}, Case{3.632987341772152, 36}, Case{3.845586440677966, 6}, Case{3.2, 2}})
        for (const double z : {0.3, 0.41, 0.77}) {
            const PointResult result = settle(iterated(fmt::format("{:.17g}*z*(1 - z)", one.r), z), options);
            ASSERT_EQ(result.label, Label::periodic) << one.r << " " << z << " " << result.outcome.detail;
            ASSERT_EQ(result.period, one.period);
            double known = 1, at = result.state[0];
            for (std::size_t k = 0; k < one.period; ++k) {
                known *= one.r * (1 - 2 * at);
                at = one.r * at * (1 - at);
            }
            ASSERT_EQ(result.multipliers.size(), 1U);
            EXPECT_NEAR(result.multipliers[0].real(), known, 1e-7) << one.r << " " << z;
        }
}

TEST(OrbitFinder, AnElasticBallHasTheMultiplierOne) {
    expect_multipliers(settle(elastic_ball("", "")), {1});
    // y shrinks by a factor e in each unit of time, whether or not it follows the ball.
    expect_multipliers(settle(elastic_ball("y = 0.5", ", y = \"x - y\"")), {1, std::exp(-2)});
    expect_multipliers(settle(elastic_ball("y = 0.5", ", y = \"cos(v) - 0.1*y\"")), {1, std::exp(-0.2)});
}

TEST(OrbitFinder, EachStateThatReturnsAfterTwoTicksHasAMultiplierOne) {
    expect_multipliers(settle(testing::ticking("x = 0.25", "x = 0", "x = \"1 - x\"")), {1});
    expect_multipliers(settle(testing::ticking("x = 0.25\ny = 0.5", "x = 0, y = 0", "x = \"y\"\ny = \"x\"")), {1, 1});
    expect_multipliers(settle(testing::ticking("x = 0.25\ny = 0.5", "x = 0, y = 0", "x = \"y\"\ny = \"-x\"")), {1, 1});
    expect_multipliers(settle(testing::ticking("x = 0.25\ny = 0.5\nz = 0", "x = 0, y = 0, z = 0",
                                               "x = \"y\"\ny = \"x\"\nz = \"0.5*z + x\"")),
                       {1, 1, 0.25});
}

TEST(OrbitFinder, ConstantStatesHaveNoMultiplier) {
    expect_multipliers(settle(testing::ticking("x = 0.25\nz = 0", "x = 0, z = 0", "z = \"0.5*z + x\"")), {0.5});
}

/// A chain of many oscillators with the same damping c, the first of which is forced: all multipliers have the
/// magnitude exp(-c T / 2), with those of the waves of the chain without damping as closed forms.
TEST(OrbitFinder, OrbitsOfManyStatesAreFoundWithAllTheirMultipliers) {
    constexpr std::size_t oscillators = 130;
    constexpr double damping = 0.04, pi = std::numbers::pi;
    std::string states, rates;
    for (std::size_t i = 1; i <= oscillators; ++i) {
        states += fmt::format("x{0} = 0.001\nv{0} = 0\n", i);
        rates += fmt::format("x{0} = 'v{0}', v{0} = '-2.2*x{0} - {1}*v{0}{2}{3}{4}', ", i, damping,
                             i > 1 ? fmt::format(" + x{}", i - 1) : "",
                             i < oscillators ? fmt::format(" + x{}", i + 1) : "", i > 1 ? "" : " + cos(theta)");
    }
    rates.resize(rates.size() - 2);
    AttractorOptions options;
    options.cycles = 4000;
    const PointResult result =
        settle(testing::OneMode{.states = states, .rates = rates, .clock = "1"}.model(), options);
    ASSERT_EQ(result.label, Label::periodic) << result.outcome.detail;
    ASSERT_EQ(result.multipliers.size(), 2 * oscillators);
    std::vector<std::complex<double>> waves;
    for (std::size_t k = 1; k <= oscillators; ++k) {
        const double square = 2.2 - 2 * std::cos(pi * static_cast<double>(k) / (oscillators + 1)),
                     frequency = std::sqrt(square - 0.25 * damping * damping);
        for (const double sign : {1.0, -1.0})
            waves.push_back(std::polar(std::exp(-damping * pi), sign * 2 * pi * frequency));
    }
    for (const std::complex<double> wave : waves) {
        const auto apart = [&](auto one) { return std::abs(one - wave); };
        EXPECT_LT(apart(*std::ranges::min_element(result.multipliers, {}, apart)), 1e-9);
    }
}

} // namespace graze::orbit_finder_test
