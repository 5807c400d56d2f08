// Errors of the map of a whole cycle against simulation.

#pragma once

#include "follow.hpp"

#include "graze/flow/mode_flow.hpp"
#include "graze/grazing/cycle_map.hpp"
#include "graze/trajectory/trajectory.hpp"
#include "grazing/near_touch.hpp"

#include <gtest/gtest.h>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <iostream>
#include <string>
#include <vector>

namespace graze::testing {

/// Simulates one cycle from states near the touch.
class Cycle {
public:
    Cycle(const Model& model, const CycleMap& map)
        : system_(model), map_(map), touch_(map.contact.touch), simulation_(system_, {}, {}, exact()),
          flow_(system_, 1e-15) {
        flow_.set_parameters(touch_.parameters);
    }

    /// Returns the largest scaled difference between simulation and map after one cycle, from a state near the touch
    /// whose motion would penetrate to `depth`.
    double error_at(double depth, const CycleMap& map) {
        std::vector<double> state = state_at_depth(system_, map_.contact, depth), from;
        for (const std::size_t i : map.active)
            from.push_back(state[i] - touch_.state[i]);
        const double time = 1 / map.contact.acceleration, speed = std::sqrt(2 * map.contact.acceleration * depth);
        // Start before the contact, and stop before the next pass, which may be a contact.
        const double early = 3 * speed * time,
                     late = std::max(20 * speed * time, 3 * std::sqrt(2 * std::abs(map.projections(1)[0]) *
                                                                      map.contact.by_depth(depth) * time));
        EXPECT_EQ(flow_.run(touch_.mode, state, -early), ModeFlow::Ending::done);
        Trajectory trajectory(simulation_, touch_.parameters);
        trajectory.start(state, touch_.mode, 0, early + map.time - late);
        run(trajectory);
        EXPECT_EQ(trajectory.outcome().ending, Ending::end_time) << trajectory.outcome().detail;
        std::vector<double> end(trajectory.state().begin(), trajectory.state().end());
        if (map.half)
            end = system_.symmetry(0).map(inputs_at(touch_, end));
        else
            EXPECT_EQ(trajectory.mode(), touch_.mode);
        EXPECT_EQ(flow_.run(touch_.mode, end, late), ModeFlow::Ending::done);
        onto_surface(end);
        const std::vector<double> expected = map.image(from, 0), periods = system_.periods()(touch_.parameters);
        double error = 0;
        for (std::size_t k = 0; k < expected.size(); ++k) {
            const std::size_t i = map.active[k];
            double difference = end[i] - touch_.state[i] - expected[k];
            if (periods[i] > 0)
                difference -= periods[i] * std::round(difference / periods[i]);
            error = std::max(error, std::abs(difference) / map.scales[k]);
        }
        return error;
    }

private:
    static SimulationOptions exact() { return {.tolerance = 1e-15, .order = 0, .largest_step = 0}; }
    /// Integrates a state to where the touched function has zero rate.
    void onto_surface(std::vector<double>& state) {
        for (int iteration = 0; iteration < 40; ++iteration)
            EXPECT_EQ(flow_.run(touch_.mode, state, -rate_at(system_, touch_, state) / map_.contact.acceleration),
                      ModeFlow::Ending::done);
    }
    System system_;
    const CycleMap& map_;
    const TouchState& touch_;
    Simulation simulation_;
    ModeFlow flow_;
};

/// Checks the order of the error without the next order, and with it where known, over a factor of 30 in the depth.
inline void expect_rates(const Model& model, const CycleMap& map, double share) {
    ASSERT_TRUE(map.exists()) << map.reason << map.contact.reason;
    Cycle cycle(model, map);
    double size = 0;
    for (std::size_t i = 0; i < map.contact.gradient.size(); ++i)
        size += std::abs(map.contact.gradient[i]) * map.contact.touch.scales[i];
    constexpr double nearer = 30;
    const auto rate_of = [&](const CycleMap& one, double& error) {
        const double far = cycle.error_at(share * size, one);
        error = cycle.error_at(share * size / nearer, one);
        return std::log(far / error) / std::log(nearer);
    };
    CycleMap leading = map;
    leading.second.clear();
    const double stated = map.contact.order == MapOrder::square_root ? 1
                          : map.contact.order == MapOrder::linear    ? 1.5
                                                                     : 2;
    double error = 0, next_error = 0;
    const double rate = rate_of(leading, error);
    EXPECT_GT(rate, stated - 0.1) << error;
    std::string line =
        fmt::format("{}: {} rate {:.3f} error {:.2e}", model.name, name_of(map.contact.order), rate, error);
    if (!map.second.empty()) {
        const double next_rate = rate_of(map, next_error);
        EXPECT_GT(next_rate, stated + 0.5 - 0.1) << next_error;
        EXPECT_LT(next_error, 0.3 * error);
        line += fmt::format(", next order {:.3f} error {:.2e}", next_rate, next_error);
    }
    std::cout << line << "\n";
}

inline CycleMap map_at(const Model& model, const SpecialPoint& point) {
    return cycle_at(model, point, {}, true);
}

} // namespace graze::testing
