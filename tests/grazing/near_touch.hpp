// States near a touch.

#pragma once

#include "graze/flow/mode_flow.hpp"
#include "graze/grazing/discontinuity_map.hpp"
#include "trajectory/simulate.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

namespace graze::testing {

inline TouchState touch_of(const Model& model, const std::string& mode, const std::string& event,
                           std::vector<double> state, std::vector<double> scales = {}) {
    TouchState touch;
    touch.mode = *model.find_mode(mode);
    touch.event = *model.find_event(event);
    touch.parameters = model.parameter_values();
    touch.scales = scales.empty() ? std::vector<double>(state.size(), 1.0) : std::move(scales);
    touch.state = std::move(state);
    return touch;
}

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

/// Returns the largest scaled difference between the simulation and the map for a motion that passes a state near the
/// touch, from a time before it to the same time after it.
/// @param depth to which the motion would penetrate
inline double error_of_map(const System& system, const DiscontinuityMap& map, const std::vector<double>& state,
                           double depth, double time, double tolerance) {
    const TouchState& touch = map.touch;
    std::vector<double> before = state, predicted = state;
    for (std::size_t i = 0; i < state.size(); ++i)
        predicted[i] += map.direction[i] * map.by_depth(depth) +
                        (map.second.empty() ? 0 : map.second[i] * map.second_by_depth(depth));
    ModeFlow flow(system, tolerance);
    flow.set_parameters(touch.parameters);
    EXPECT_EQ(flow.run(touch.mode, before, -time), ModeFlow::Ending::done);
    EXPECT_EQ(flow.run(touch.mode, predicted, time), ModeFlow::Ending::done);
    const Simulation simulation(system, {}, {}, with_tolerance(tolerance));
    Trajectory trajectory(simulation, touch.parameters);
    trajectory.start(before, touch.mode, 0, 2 * time);
    run(trajectory);
    EXPECT_EQ(trajectory.outcome().ending, Ending::end_time) << trajectory.outcome().detail;
    EXPECT_EQ(trajectory.mode(), touch.mode);
    double error = 0;
    for (std::size_t i = 0; i < predicted.size(); ++i)
        error = std::max(error, std::abs(trajectory.state()[i] - predicted[i]) / touch.scales[i]);
    return error;
}

} // namespace graze::testing
