// States near a touch.

#pragma once

#include "graze/grazing/discontinuity_map.hpp"

#include <cstddef>
#include <vector>

namespace graze::testing {

/// States and parameters, as functions of a system want them.
inline std::vector<double> inputs_at(const TouchState& touch, std::vector<double> state) {
    state.insert(state.end(), touch.parameters.begin(), touch.parameters.end());
    return state;
}

/// Returns the rate of the touched function.
inline double rate_at(const System& system, const TouchState& touch, const std::vector<double>& state) {
    const auto value = system.event(touch.event)(inputs_at(touch, state)),
               field = system.mode(touch.mode).rates(inputs_at(touch, state));
    double rate = 0;
    for (std::size_t i = 0; i < state.size(); ++i)
        rate += value[1 + i] * field[i];
    return rate;
}

/// Returns the nearest scaled state at which the touched function has zero rate and is -depth, by Newton's method along
/// the gradients of function and rate.
inline std::vector<double> state_at_depth(const System& system, const DiscontinuityMap& map, double depth) {
    const TouchState& touch = map.touch;
    std::vector<double> state = touch.state;
    for (int iteration = 0; iteration < 30; ++iteration) {
        double gg = 0, gr = 0, rr = 0;
        for (std::size_t i = 0; i < state.size(); ++i) {
            const double unit = touch.scales[i] * touch.scales[i];
            gg += map.gradient[i] * map.gradient[i] * unit;
            gr += map.gradient[i] * map.rate_gradient[i] * unit;
            rr += map.rate_gradient[i] * map.rate_gradient[i] * unit;
        }
        const double value = -depth - system.event(touch.event)(inputs_at(touch, state))[0],
                     rate = rate_at(system, touch, state), determinant = gg * rr - gr * gr;
        for (std::size_t i = 0; i < state.size(); ++i)
            state[i] += ((value * rr + rate * gr) * map.gradient[i] - (rate * gg + value * gr) * map.rate_gradient[i]) /
                        determinant * touch.scales[i] * touch.scales[i];
    }
    return state;
}

} // namespace graze::testing
