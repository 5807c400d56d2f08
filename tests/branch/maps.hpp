// Maps as models, orbits that are their fixed points, and curves in two parameters.

#pragma once

#include "follow.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <string>
#include <vector>

namespace graze::testing {

/// A model with states x, y, z that are constant except for a map applied once per unit of time.
/// @param parameters lines of the model file; @param images expressions of the map, one for each state
inline Model map_model(const std::string& parameters, const std::vector<std::string>& images) {
    const std::vector<std::string> names{"x", "y", "z"};
    std::string states, rates, map;
    for (std::size_t i = 0; i < images.size(); ++i) {
        states += names[i] + " = 0\n";
        rates += names[i] + " = 0, ";
        map += fmt::format("{} = \"{}\"\n", names[i], images[i]);
    }
    return model_from(fmt::format(R"toml(
[parameters]
{}
[states]
{}clock = 0
[modes.rest]
rates = {{ {}clock = 1 }}
watch = ["tick"]
[events.tick]
function = "1 - clock"
[jumps.map]
{}clock = 0
[[transitions]]
mode = "rest"
event = "tick"
jump = "map"
next = "rest"
label = "map"
[initial]
mode = "rest"
)toml",
                                  parameters, states, rates, map));
}

inline Orbit fixed_point(const Model& model, std::vector<double> at) {
    at.push_back(0);
    return {parse_signature(model, "map"), model.parameter_values(), {std::move(at)}, {1}, {}};
}

inline double value_of(const Model& model, const OrbitSolution& solution, const std::string& parameter) {
    return solution.orbit.parameters[model.independent_parameter(parameter).place()];
}

inline BranchSettings in_parameter(const Model& model, const std::string& name, double least, double greatest) {
    BranchSettings settings;
    settings.parameter = model.independent_parameter(name);
    settings.least = least;
    settings.greatest = greatest;
    return settings;
}

/// Returns the curve of a special point in the parameter of the settings and a second one.
inline Branch curve_of(const Model& model, const SpecialPoint& point, BranchSettings settings,
                       const std::string& further, double least, double greatest, int direction) {
    settings.kept = point;
    settings.free = {model.independent_parameter(further)};
    settings.free_bounds = {{settings.free[0], least, greatest}};
    settings.direction = direction;
    return follow_branch(System(model), point.solution.orbit, settings);
}

} // namespace graze::testing
