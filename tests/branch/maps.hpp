// Maps as models, and orbits that are their fixed points.

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
        map += fmt::format("{} = '{}'\n", names[i], images[i]);
    }
    return OneMode{.parameters = parameters,
                   .states = states + "clock = 0",
                   .rates = rates + "clock = 1",
                   .stops = {{"tick", "1 - clock", map + "clock = 0", "map"}}}
        .model();
}

inline Orbit fixed_point(const Model& model, std::vector<double> at) {
    at.push_back(0);
    return given_orbit(model, "map", {std::move(at)}, {1});
}

} // namespace graze::testing
