// Branches of models with hundreds of states, of which only the multipliers near and outside the unit circle are
// computed: fixed points at zero of maps with closed forms, beside many states that decay.

#include "follow.hpp"

#include "graze/orbit/solve.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <string>
#include <vector>

namespace graze::many_states_test {

using namespace graze::testing;

constexpr std::size_t decaying = 258;
constexpr double decay = 0.8;

/// @param x, y images of the two states that do not decay
Model map_with_many(const std::string& x, const std::string& y) {
    std::string states = "x = 0\ny = 0\n", rates = "x = 0, y = 0, ", map = fmt::format("x = '{}'\ny = '{}'\n", x, y);
    for (std::size_t i = 1; i <= decaying; ++i) {
        states += fmt::format("w{} = 0\n", i);
        rates += fmt::format("w{} = 0, ", i);
        map += fmt::format("w{} = '{} * w{} + 0.1 * x'\n", i, decay, i);
    }
    return OneMode{.parameters = "p = 0.5",
                   .states = states + "clock = 0",
                   .rates = rates + "clock = 1",
                   .stops = {{"tick", "1 - clock", map + "clock = 0", "map"}}}
        .model();
}

struct Case {
    std::string x, y;
    PointType type;
    std::size_t unstable;                     ///< beyond p = 1
    std::vector<std::complex<double>> ratios; ///< of multipliers to p
};

TEST(ManyStates, BifurcationsAreFoundWithTheMultipliersThatMatter) {
    const double angle = 1.1;
    const std::complex<double> turn = std::polar(1.0, angle);
    const std::string c = fmt::format("{:.17g}", std::cos(angle)), s = fmt::format("{:.17g}", std::sin(angle));
    for (const Case& one : {Case{"-p*x + x^3", "0.3*y", PointType::flip, 1, {-1.0}},
                            Case{"p*x - x^3", "0.3*y", PointType::branch_point, 1, {1.0}},
                            Case{"p*(" + c + "*x - " + s + "*y) - x*(x^2 + y^2)",
                                 "p*(" + s + "*x + " + c + "*y) - y*(x^2 + y^2)",
                                 PointType::torus,
                                 2,
                                 {turn, std::conj(turn)}}}) {
        const System system(map_with_many(one.x, one.y));
        std::vector<double> start(decaying + 3, 0.0);
        BranchSettings settings;
        settings.parameter = system.model().independent_parameter("p");
        settings.least = 0.4;
        settings.greatest = 1.4;
        settings.steps = 40;
        settings.continuation.largest_step = 0.1;
        const Branch branch = follow_branch(system, given_orbit(system.model(), "map", {start}, {1}), settings);
        std::size_t beyond = 0;
        for (const BranchPoint& point : branch.points) {
            const OrbitSolution& solution = point.solution;
            const double p = point.parameter;
            EXPECT_EQ(number_of_multipliers(solution), decaying + 2) << p;
            EXPECT_GE(solution.other_multipliers, decaying) << p;
            EXPECT_GE(solution.others_within, decay) << p;
            EXPECT_LT(solution.others_within, 0.99) << p;
            EXPECT_EQ(solution.multipliers.size(), p > 0.95 ? one.ratios.size() : 0) << p;
            for (const std::complex<double> multiplier : solution.multipliers)
                EXPECT_TRUE(std::ranges::any_of(one.ratios, [&](auto ratio) {
                    return std::abs(multiplier - p * ratio) < 1e-10;
                })) << p;
            EXPECT_EQ(point.stable, p < 1 - 1e-8) << p;
            EXPECT_EQ(unstable_directions(solution), p > 1 + 1e-8 ? one.unstable : 0) << p;
            beyond += p > 1 ? 1 : 0;
        }
        EXPECT_GT(beyond, 0U);
        ASSERT_FALSE(branch.special.empty());
        for (std::size_t i = 1; i < branch.special.size(); ++i) // the end of the branch
            EXPECT_EQ(branch.special[i].type, PointType::bound);
        EXPECT_EQ(branch.special.front().type, one.type);
        EXPECT_TRUE(branch.special.front().located);
        EXPECT_NEAR(branch.special.front().parameter, 1, 1e-9);
    }
}

/// A single orbit has all its multipliers, and so has a branch whose monitor is one of them.
TEST(ManyStates, AllMultipliersAreComputedWhereTheyAreAskedFor) {
    const System system(map_with_many("-p*x + x^3", "0.3*y"));
    std::vector<double> start(decaying + 3, 0.0);
    const Orbit orbit = given_orbit(system.model(), "map", {start}, {1});
    EXPECT_EQ(solve_orbit(system, orbit).multipliers.size(), decaying + 2);
    BranchSettings settings;
    settings.parameter = system.model().independent_parameter("p");
    settings.least = 0.4;
    settings.greatest = 1.4;
    settings.steps = 1;
    Monitor& largest = settings.monitors.emplace_back();
    largest.name = "largest";
    largest.kind = Monitor::Kind::multiplier;
    for (const BranchPoint& point : follow_branch(system, orbit, settings).points) {
        EXPECT_EQ(point.solution.multipliers.size(), decaying + 2);
        EXPECT_NEAR(point.monitors.front(), std::max(decay, point.parameter), 1e-10);
    }
}

} // namespace graze::many_states_test
