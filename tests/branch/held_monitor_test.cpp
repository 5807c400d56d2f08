// Branches with a fixed extremum or mean, which have closed forms.

#include "graze/model/named_value.hpp"

#include "follow.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace graze::held_monitor_test {

using namespace graze::testing;

Monitor held(const Model& model, Monitor::Kind kind, const std::string& expression, double value) {
    Monitor result;
    result.name = "held";
    result.kind = kind;
    result.expression = named_value(model, expression, {}).value;
    result.fixed = true;
    result.held = value;
    return result;
}

double response(double zeta, double omega) {
    return 1 / std::hypot(1 - omega * omega, 2 * zeta * omega);
}

TEST(HeldMonitors, FixedExtremumPassesTheEndOfTheOrbit) {
    // The phase of the response goes from 0 to pi: near resonance the maximum passes through the section, at other
    // frequencies the minimum.
    for (const double phase : {0.5, 0.5 * std::numbers::pi, 2.5, 4.0}) {
        const Model model = linear_oscillator(phase);
        const Orbit orbit = settled(model, "start").orbit;
        for (const auto& [kind, expression, value] : {std::tuple{Monitor::Kind::maximum, "x", 0.3},
                                                      {Monitor::Kind::minimum, "2*x", -0.6},
                                                      {Monitor::Kind::mean, "x^2", 0.045},
                                                      {Monitor::Kind::maximum, "-x", 0.3}}) {
            BranchSettings settings = in_parameter(model, "omega");
            settings.free = {model.independent_parameter("F")};
            settings.direction = -1;
            settings.least = 0.4;
            settings.monitors = {held(model, kind, expression, value)};
            const Branch branch = follow_branch(System(model), orbit, settings);
            ASSERT_EQ(branch.outcome, BranchOutcome::bound) << branch.detail << ' ' << branch.points.size();
            EXPECT_LT(branch.points.size(), 150U) << phase << ' ' << expression;
            EXPECT_EQ(names(branch), "BD");
            for (const BranchPoint& point : branch.points)
                EXPECT_NEAR(point.solution.orbit.parameters[settings.free[0].place()] * response(0.1, point.parameter),
                            0.3, 1e-9);
        }
    }
}

TEST(HeldMonitors, TouchCanBeFixed) {
    // The force at which an oscillator just touches its stop, at all frequencies.
    const Model model =
        shipped_with("impact-oscillator", {{"sigma", 0.5}, {"zeta", 0.1}, {"omega", 1.7}, {"amplitude", 0.2}});
    BranchSettings settings = in_parameter(model, "amplitude", {}, 3);
    const Branch up = follow_branch(System(model), settled(model, "phase0").orbit, settings);
    ASSERT_EQ(names(up), "GR");
    const Orbit& grazing = up.special[0].solution.orbit;
    for (const int direction : {1, -1}) {
        settings = {};
        settings.parameter = model.independent_parameter("omega");
        settings.free = {model.independent_parameter("amplitude")};
        settings.direction = direction;
        settings.least = 0.4;
        settings.greatest = 3;
        settings.monitors = {held(model, Monitor::Kind::maximum, "x", 0.5)};
        const Branch branch = follow_branch(System(model), grazing, settings);
        ASSERT_EQ(branch.outcome, BranchOutcome::bound) << name_of(branch.outcome) << branch.detail << names(branch);
        EXPECT_EQ(names(branch), "BD");
        EXPECT_LT(branch.points.size(), 150U);
        for (const BranchPoint& point : branch.points) {
            EXPECT_NEAR(point.solution.orbit.parameters[settings.free[0].place()] * response(0.1, point.parameter), 0.5,
                        1e-9);
            EXPECT_TRUE(point.solution.certificate.admissible) << point.solution.certificate.reason;
        }
    }
}

/// Returns the mean number of Newton iterations per point of a branch.
double mean_iterations(const Branch& branch) {
    double sum = 0;
    for (const BranchPoint& point : branch.points)
        sum += static_cast<double>(point.iterations);
    return sum / static_cast<double>(branch.points.size());
}

TEST(HeldMonitors, FixedMonitorsDoNotSlowABranchDown) {
    const Model model =
        shipped_with("impact-oscillator", {{"sigma", 0.5}, {"zeta", 0.1}, {"omega", 1.7}, {"amplitude", 1.3}});
    const Orbit orbit = settled(model, "phase0").orbit;
    const BranchSettings settings = in_parameter(model, "omega", 1.3);
    const auto follow_down = [&](const BranchSettings& given) {
        BranchSettings own = given;
        own.direction = -1;
        return follow_branch(System(model), orbit, own);
    };
    const Branch free = follow_down(settings);
    ASSERT_EQ(free.outcome, BranchOutcome::bound) << free.detail;
    using Kind = Monitor::Kind;
    for (const auto& [kind, expression] : {std::pair{Kind::minimum, "x"},
                                           {Kind::maximum, "v"},
                                           {Kind::mean, "x^2"},
                                           {Kind::norm, "v"},
                                           {Kind::value, "v"},
                                           {Kind::start, "v"}}) {
        BranchSettings holding = settings;
        holding.free = {model.independent_parameter("amplitude")};
        Monitor monitor = held(model, kind, expression, 0);
        monitor.held.reset(); // held at its current value
        holding.monitors = {monitor};
        const Branch branch = follow_down(holding);
        ASSERT_EQ(branch.outcome, BranchOutcome::bound) << expression << ' ' << branch.detail << names(branch);
        const double value = branch.points.front().monitors[0];
        for (const BranchPoint& point : branch.points)
            EXPECT_NEAR(point.monitors[0], value, 1e-9 * std::abs(value)) << expression;
        EXPECT_LT(mean_iterations(branch), mean_iterations(free) + 0.5) << expression;
        EXPECT_LT(branch.points.size(), 2 * free.points.size() + 10) << expression;
    }
}

} // namespace graze::held_monitor_test
