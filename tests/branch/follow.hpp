#pragma once

#include "graze/base/input_error.hpp"
#include "graze/branch/switching.hpp"
#include "graze/grazing/trial.hpp"
#include "graze/trajectory/trajectory.hpp"
#include "orbit/orbits.hpp"
#include "trajectory/model_parts.hpp"

#include <gtest/gtest.h>

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace graze::testing {

/// (u, v) rotate with the frequency w and grow at the rate p: the orbit u = v = 0, x = cos(theta), y = sin(2 theta) /
/// 3, has multipliers exp(2 pi (p +- i w)).
inline Model torus_model() {
    return OneMode{.parameters = "p = -0.1\nw = 0.3",
                   .states = "x = 1\ny = 0",
                   .definitions = "u = 'x - cos(theta)'\nv = 'y - sin(2*theta)/3'",
                   .rates = "x = 'p*u - w*v - u*(u^2 + v^2) - sin(theta)', "
                            "y = 'w*u + p*v - v*(u^2 + v^2) + 2*cos(2*theta)/3'",
                   .clock = "1"}
        .model();
}

/// u' = rate in units of length and time, with x = u + cos(theta), so that a solution u = 0 is not apparent from the
/// equations. @param u initial value
inline Model about_clock(const std::string& parameters, const std::string& rate, double u = 0,
                         const std::string& more = "", double length = 1, double time = 1) {
    return OneMode{.parameters = parameters,
                   .states = fmt::format("x = {:.17g}", length * (u + 1)),
                   .definitions = fmt::format("u = 'x/{:.17g} - cos(theta)'", length),
                   .rates = fmt::format("x = '{:.17g}*({} - sin(theta))'", length / time, rate),
                   .clock = fmt::format("{:.17g}", 1 / time),
                   .more = more}
        .model();
}

/// x'' = acceleration, with a clock.
inline Model driven(const std::string& parameters, const std::string& acceleration, const std::string& clock = "1",
                    std::vector<Stop> stops = {}, const std::string& more = "") {
    return OneMode{.parameters = parameters,
                   .states = "x = 0\nv = 0",
                   .rates = fmt::format("x = 'v', v = '{}'", acceleration),
                   .clock = clock,
                   .stops = std::move(stops),
                   .more = more}
        .model();
}

/// x'' + 2 zeta x' + x = F cos(theta). @param phase at which orbits start
inline Model linear_oscillator(double phase = 0) {
    return driven("zeta = 0.1\nomega = 1.7\nF = 0.8", "F*cos(theta) - 2*zeta*v - x", "omega", {}, at_phase(phase));
}

inline double value_of(const Model& model, const OrbitSolution& solution, const std::string& parameter) {
    return solution.orbit.parameters[model.independent_parameter(parameter).place()];
}

/// Settings of a branch in a parameter, up to bounds.
inline BranchSettings in_parameter(const Model& model, const std::string& name, std::optional<double> least = {},
                                   std::optional<double> greatest = {}, int direction = 1) {
    BranchSettings settings;
    settings.parameter = model.independent_parameter(name);
    settings.direction = direction;
    settings.least = least;
    settings.greatest = greatest;
    return settings;
}

/// Returns the curve of a special point in the parameter of the settings and a second one.
inline Branch curve_of(const Model& model, const SpecialPoint& point, BranchSettings settings,
                       const std::string& further, std::optional<double> least, std::optional<double> greatest,
                       int direction) {
    settings.kept = point;
    settings.free = {model.independent_parameter(further)};
    if (least || greatest)
        settings.free_bounds = {{settings.free[0], least, greatest}};
    settings.direction = direction;
    return follow_branch(System(model), point.solution.orbit, settings);
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

inline std::vector<SpecialPoint> of_type(const std::vector<SpecialPoint>& points, PointType type) {
    std::vector<SpecialPoint> result;
    std::copy_if(points.begin(), points.end(), std::back_inserter(result),
                 [type](const SpecialPoint& point) { return point.type == type; });
    return result;
}

inline std::vector<SpecialPoint> of_type(const Branch& branch, PointType type) {
    return of_type(branch.special, type);
}

/// Returns the first grazing of the settled motion along a branch.
inline SpecialPoint first_touch(const Model& model, const std::string& section, BranchSettings settings,
                                std::size_t cycles = 2000) {
    settings.stop_at = {PointType::grazing};
    const auto found =
        of_type(follow_branch(System(model), settled(model, section, cycles).orbit, settings), PointType::grazing);
    EXPECT_FALSE(found.empty()) << model.name;
    return found.at(0);
}

/// Returns the map of a cycle that touches.
inline CycleMap cycle_at(const Model& model, const SpecialPoint& point, std::optional<ParameterId> parameter,
                         bool next_order = false) {
    CycleMapOptions options;
    options.parameter = parameter;
    options.next_order = next_order;
    return cycle_map(System(model), point.solution.orbit, {point.segment, point.event, point.time, point.at_end},
                     options);
}

/// What a map and simulation tell about motions beyond a touch.
struct Judged {
    Judged(const Model& model, const SpecialPoint& point, ParameterId parameter)
        : map(cycle_at(model, point, parameter)), verdict(verdict_of(map)),
          trial(try_verdict(System(model), map, verdict, parameter)) {}
    CycleMap map;
    Verdict verdict;
    Trial trial;
};

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
inline void expect_fold(const Branch& branch, const SpecialPoint& fold) {
    EXPECT_EQ(fold.type, PointType::fold);
    EXPECT_TRUE(fold.located);
    EXPECT_LT(nearest_multiplier(fold.solution, 1), 1e-6);
    ASSERT_GE(fold.step, 1U);
    ASSERT_LT(fold.step, branch.points.size());
    // The last point may be a special point; both neighbours must lie on the fold's step.
    const double before = branch.points[fold.step - 1].parameter - fold.parameter,
                 after = branch.points[fold.step].parameter - fold.parameter;
    EXPECT_GE(before * after, 0) << before << ' ' << after;
}

inline void expect_flip(const SpecialPoint& flip) {
    EXPECT_EQ(flip.type, PointType::flip);
    EXPECT_TRUE(flip.located);
    EXPECT_LT(nearest_multiplier(flip.solution, -1), 1e-8);
}

/// Returns the value of an event function after simulating for a time.
inline double simulated(const Model& model, const SpecialPoint& point, double time) {
    const Orbit& orbit = point.solution.orbit;
    const Simulation simulation{System(model)};
    Trajectory trajectory(simulation, orbit.parameters);
    trajectory.start(orbit.starts[point.segment], orbit.signature[point.segment].mode, 0, time);
    run(trajectory);
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
