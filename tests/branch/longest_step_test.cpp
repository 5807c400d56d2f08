// Step lengths where a growing mean has a small oscillation, and that such long steps pass over no special point.

#include "follow.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace graze {
namespace {

using namespace graze::testing;
using std::numbers::pi;

Orbit orbit_from(const Model& model, std::vector<double> state) {
    return {parse_signature(model, "start"), model.parameter_values(), {std::move(state)}, {2 * pi}, {}};
}

/// The orbit x = p^2 (1 + ripple cos(theta)), in some unit of length, and a stop at half that unit.
Model growing(double p, double ripple, double unit) {
    return model_from(fmt::format(R"toml(
[parameters]
p = {0:.17g}
[states]
x = {3:.17g}
theta = {{ initial = 0, period = "2*pi" }}
[definitions]
wanted = "{2:.17g}*p^2*(1 + {1:.17g}*cos(theta))"
[modes.only]
rates = {{ x = "wanted - x - {2:.17g}*p^2*{1:.17g}*sin(theta)", theta = 1 }}
watch = ["stop"]
[events.stop]
function = "{4:.17g} - x"
[[transitions]]
mode = "only"
event = "stop"
next = "end"
[sections.start]
state = "theta"
value = 0
)toml",
                                  p, ripple, unit, unit * p * p * (1 + ripple), 0.5 * unit));
}

TEST(LongestStep, GrowsWithAMeanThatExceedsItsOscillation) {
    for (const double unit : {1e-9, 1.0, 1e6})
        for (const double ripple : {1.0, 0.1, 0.03}) {
            constexpr double first = 0.01;
            const Model model = growing(first, ripple, unit);
            BranchSettings settings;
            settings.greatest = 2;
            const Branch branch =
                follow_branch(System(model), orbit_from(model, {unit * first * first * (1 + ripple), 0}), settings);
            ASSERT_EQ(names(branch), "GR") << name_of(branch.outcome) << " at " << branch.points.back().parameter;
            EXPECT_NEAR(branch.special[0].parameter, std::sqrt(0.5 / (1 + ripple)), 1e-10);
            EXPECT_LT(branch.points.size(), 400U) << ripple;
        }
}

/// x = u + cos(theta), where u settles at p = function(u).
Model about_mean(const std::string& function, double unit, double p, double u) {
    return model_from(fmt::format(R"toml(
[parameters]
p = {2:.17g}
[states]
x = {3:.17g}
theta = {{ initial = 0, period = "2*pi" }}
[definitions]
u = "x/{1:.17g} - cos(theta)"
[modes.only]
rates = {{ x = "{1:.17g}*(p - ({0}) - sin(theta))", theta = 1 }}
[sections.start]
state = "theta"
value = 0
)toml",
                                  function, unit, p, unit * (u + 1)));
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
                const Branch branch =
                    follow_branch(System(model), orbit_from(model, {unit * (1.5 - height), 0}), settings);
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
            const Branch branch = follow_branch(System(model), orbit_from(model, {unit * 1.05, 0}), settings);
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

} // namespace
} // namespace graze
