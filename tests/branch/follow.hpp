#pragma once

#include "graze/base/input_error.hpp"
#include "graze/branch/switching.hpp"
#include "graze/model/catalogue.hpp"
#include "graze/model/model_file.hpp"

#include "graze/trajectory/trajectory.hpp"

#include <gtest/gtest.h>

#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <vector>

namespace graze::testing {

inline Model model_from(const std::string& text) {
    return parse_model(text, "test.toml");
}

/// (u, v) rotate with the frequency w and grow at the rate p: the orbit u = v = 0, x = cos(theta), y = sin(2 theta) /
/// 3, has multipliers exp(2 pi (p +- i w)).
inline Model torus_model() {
    return model_from(R"toml(
[parameters]
p = -0.1
w = 0.3
[states]
x = 1
y = 0
theta = { initial = 0, period = "2*pi" }
[definitions]
u = "x - cos(theta)"
v = "y - sin(2*theta)/3"
[modes.only]
rates = { x = "p*u - w*v - u*(u^2 + v^2) - sin(theta)", y = "w*u + p*v - v*(u^2 + v^2) + 2*cos(2*theta)/3", theta = 1 }
[sections.start]
state = "theta"
value = 0
)toml");
}

inline OrbitSolution settled(const Model& model, const std::string& section, std::size_t cycles = 2000) {
    AttractorOptions settle;
    settle.section = section;
    settle.cycles = cycles;
    OrbitSolution solution = find_orbit(System(model), settle);
    EXPECT_EQ(solution.outcome, OrbitOutcome::converged) << solution.detail;
    return solution;
}

inline Branch follow(const Model& model, const BranchStart& start, const BranchSettings& settings) {
    OrbitBranch follower(System(model), start.orbit, settings);
    Branch branch;
    for (bool going = follower.start_along(start.direction, start.distance); going; going = follower.step()) {
        branch.points.push_back(follower.point());
        branch.special.insert(branch.special.end(), follower.found().begin(), follower.found().end());
    }
    branch.outcome = follower.outcome();
    branch.detail = follower.detail();
    return branch;
}

inline std::vector<SpecialPoint> of_type(const Branch& branch, PointType type) {
    std::vector<SpecialPoint> result;
    std::copy_if(branch.special.begin(), branch.special.end(), std::back_inserter(result),
                 [type](const SpecialPoint& point) { return point.type == type; });
    return result;
}

/// Returns the short names of all special points in order, such as "PD PD SN GR".
inline std::string names(const Branch& branch) {
    std::string result;
    for (const SpecialPoint& point : branch.special)
        result += (result.empty() ? "" : " ") + std::string(short_name(point.type));
    return result;
}

/// Returns the distance of the nearest multiplier from a number.
inline double nearest_multiplier(const OrbitSolution& solution, double number) {
    double nearest = 1e300;
    for (const auto one : solution.multipliers)
        nearest = std::min(nearest, std::abs(one - number));
    return nearest;
}

/// Verifies a fold by its multiplier and by its neighbours: the parameter has an extremum there.
inline void expect_fold(const Branch& branch, const SpecialPoint& fold, double tolerance = 1e-6) {
    EXPECT_EQ(fold.type, PointType::fold);
    EXPECT_TRUE(fold.located);
    EXPECT_LT(nearest_multiplier(fold.solution, 1), tolerance);
    ASSERT_GE(fold.step, 1U);
    ASSERT_LT(fold.step, branch.points.size());
    // The last point may be a special point; both neighbours must lie on the fold's step.
    const double before = branch.points[fold.step - 1].parameter - fold.parameter,
                 after = branch.points[fold.step].parameter - fold.parameter;
    EXPECT_GE(before * after, 0) << before << ' ' << after;
}

inline void expect_flip(const SpecialPoint& flip, double tolerance = 1e-8) {
    EXPECT_EQ(flip.type, PointType::flip);
    EXPECT_TRUE(flip.located);
    EXPECT_LT(nearest_multiplier(flip.solution, -1), tolerance);
}

/// Returns the value of an event function after simulating for a time.
inline double simulated(const Model& model, const SpecialPoint& point, double time) {
    const Orbit& orbit = point.solution.orbit;
    const Simulation simulation{System(model)};
    Trajectory trajectory(simulation, orbit.parameters);
    trajectory.start(orbit.starts[point.segment], orbit.signature[point.segment].mode, 0, time);
    JetSet jets(simulation, LaneKind::single);
    run(trajectory, jets);
    std::vector<double> values(trajectory.state().begin(), trajectory.state().end());
    values.insert(values.end(), orbit.parameters.begin(), orbit.parameters.end());
    return simulation.system().event(point.event)(values)[0];
}

/// Verifies a touch inside an arc: the minimum on the orbit is zero, and simulation gives the same value.
inline void expect_touch(const Model& model, const SpecialPoint& grazing, double size) {
    EXPECT_EQ(grazing.type, PointType::grazing);
    EXPECT_TRUE(grazing.located);
    EXPECT_FALSE(grazing.at_end);
    double least = 1e300;
    for (const OrbitMinimum& minimum : grazing.solution.certificate.minima)
        if (minimum.segment == grazing.segment && minimum.event == grazing.event)
            least = std::min(least, minimum.value);
    EXPECT_NEAR(least, 0, 1e-13 * size);
    EXPECT_NEAR(simulated(model, grazing, grazing.time), 0, 1e-11 * size);
    EXPECT_GT(simulated(model, grazing, 0.99 * grazing.time), 1e-9 * size);
}

} // namespace graze::testing
