#include "graze/model/catalogue.hpp"
#include "graze/trajectory/trajectory.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <utility>
#include <vector>

namespace graze::stop_test {

/// Stops at passages of the first probe, on request.
struct Stopper : Observer {
    bool stops = false, passed = false;
    void passage(const Passage&) override { passed = stops; }
    bool stop() override { return std::exchange(passed, false); }
};

TEST(Stop, AtAPassageWhereAClockSwitchesLosesNothing) {
    // The pulse begins where the phase begins its period: the section and the event have the same surface.
    for (const char* name : {"microbeam", "mems-switch"}) {
        const Model model = load_model(name);
        const Simulation simulation(System(model), {section_probe(model, "phase0")});
        JetSet jets(simulation, LaneKind::single);
        Stopper observer;
        std::vector<std::vector<double>> states;
        std::vector<std::size_t> modes, stops;
        for (const bool stopping : {false, true}) {
            observer.stops = stopping;
            Trajectory trajectory(simulation, model.parameter_values(), borrowed(observer));
            const double end = std::string(name) == "microbeam" ? 1.5 : 20;
            trajectory.start(model.initial_state(), model.initial_mode, 0, end);
            run(trajectory, jets);
            std::size_t count = 0;
            for (; trajectory.outcome().ending == Ending::stopped; ++count) {
                trajectory.extend(end);
                run(trajectory, jets);
            }
            EXPECT_EQ(trajectory.outcome().ending, Ending::end_time);
            states.emplace_back(trajectory.state().begin(), trajectory.state().end());
            modes.push_back(trajectory.mode());
            stops.push_back(count);
        }
        EXPECT_GE(stops[1], 3u) << name;
        EXPECT_EQ(modes[0], modes[1]) << name;
        for (std::size_t i = 0; i < states[0].size(); ++i)
            EXPECT_NEAR(states[0][i], states[1][i], 1e-9 * (1 + std::abs(states[0][i]))) << name << i;
    }
}

} // namespace graze::stop_test
