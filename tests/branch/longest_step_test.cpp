// Step lengths where a growing mean has a small oscillation, and that such long steps pass over no special point.

#include "follow.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace graze::longest_step_test {

using namespace graze::testing;
using std::numbers::pi;

/// The orbit x = p^2 (1 + ripple cos(theta)), in some unit of length, and a stop at half that unit.
Model growing(double p, double ripple, double unit) {
    return OneMode{.parameters = fmt::format("p = {:.17g}", p),
                   .states = fmt::format("x = {:.17g}", unit * p * p * (1 + ripple)),
                   .definitions = fmt::format("wanted = '{:.17g}*p^2*(1 + {:.17g}*cos(theta))'", unit, ripple),
                   .rates = fmt::format("x = 'wanted - x - {:.17g}*p^2*{:.17g}*sin(theta)'", unit, ripple),
                   .clock = "1",
                   .stops = {{.event = "stop", .function = fmt::format("{:.17g} - x", 0.5 * unit), .next = "end"}}}
        .model();
}

TEST(LongestStep, GrowsWithAMeanThatExceedsItsOscillation) {
    for (const double unit : {1e-9, 1.0, 1e6})
        for (const double ripple : {1.0, 0.1, 0.03}) {
            constexpr double first = 0.01;
            const Model model = growing(first, ripple, unit);
            BranchSettings settings;
            settings.greatest = 2;
            const Branch branch = follow_branch(
                System(model), given_orbit(model, "start", {{unit * first * first * (1 + ripple), 0}}, {2 * pi}),
                settings);
            ASSERT_EQ(names(branch), "GR") << name_of(branch.outcome) << " at " << branch.points.back().parameter;
            EXPECT_NEAR(branch.special[0].parameter, std::sqrt(0.5 / (1 + ripple)), 1e-10);
            EXPECT_LT(branch.points.size(), 400U) << ripple;
        }
}

/// x = u + cos(theta), where u settles at p = function(u).
Model about_mean(const std::string& function, double unit, double p, double u) {
    return about_clock(fmt::format("p = {:.17g}", p), fmt::format("p - ({})", function), u, "", unit);
}

TEST(LongestStep, DoesNotPassOverFolds) {
    // A mean that grows to a hundred times the oscillation, with two folds on the way at various distances, or with
    // many folds in pairs as near as 6e-7.
    for (const double unit : {1e-9, 1.0, 1e6}) {
        for (const double place : {3.0, 30.0, 80.0})
            for (const double width : {0.5, 1.0, 3.0}) {
                const double height = 1.2 * width, half = std::acosh(std::sqrt(1.2));
                const Model model =
                    about_mean(fmt::format("u - {:.17g}*tanh((u - {:.17g})/{:.17g})", height, place, width), unit, 0.5,
                               0.5 - height);
                BranchSettings settings;
                settings.greatest = 120;
                settings.steps = 4000;
                const Branch branch = follow_branch(
                    System(model), given_orbit(model, "start", {{unit * (1.5 - height), 0}}, {2 * pi}), settings);
                ASSERT_EQ(names(branch), "SN SN BD") << place << ' ' << width;
                const double off = height * std::tanh(half) - width * half;
                EXPECT_NEAR(branch.special[0].parameter, place + off, 1e-9);
                EXPECT_NEAR(branch.special[1].parameter, place - off, 1e-9);
            }
        for (const double frequency : {3.0, 1.0, 0.3}) {
            constexpr double strength = 1.0001;
            const Model model = about_mean(
                fmt::format("u + {:.17g}*sin({:.17g}*u)/{:.17g}", strength, frequency, frequency), unit, 0.1, 0.05);
            BranchSettings settings;
            settings.greatest = 30;
            const Branch branch =
                follow_branch(System(model), given_orbit(model, "start", {{unit * 1.05, 0}}, {2 * pi}), settings);
            ASSERT_EQ(branch.outcome, BranchOutcome::bound);
            std::size_t folds = 0;
            const double first = std::acos(-1 / strength);
            for (double turn = 0; (turn + pi) / frequency < 29.5; turn += 2 * pi)
                for (const double angle : {first + turn, 2 * pi - first + turn}) {
                    ASSERT_LT(folds, branch.special.size());
                    EXPECT_NEAR(branch.special[folds++].parameter, (angle + strength * std::sin(angle)) / frequency,
                                1e-9);
                }
            EXPECT_EQ(of_type(branch, PointType::fold).size(), folds);
        }
    }
}

} // namespace graze::longest_step_test
