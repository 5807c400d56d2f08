#pragma once

#include "graze/model/catalogue.hpp"
#include "graze/trajectory/recorder.hpp"
#include "graze/trajectory/trajectory.hpp"
#include "record/waves.hpp"

#include <cmath>
#include <string>
#include <vector>

namespace graze::testing {

/// A simulated record of a shipped model: channels are its states, and `drive`, the sine of the phase.
struct RecordedModel {
    RecordHeader header;
    Samples samples;
    Recorder truth; ///< contacts and passages of the simulation

    /// @param skipped time before the first sample. @param phase name of the cyclic state
    RecordedModel(Model model, const std::string& phase, double skipped, double frequency, std::size_t count,
                  const std::vector<Probe>& probes = {}) {
        const Simulation simulation(System(model), probes);
        std::vector<double> periods;
        std::size_t cyclic = 0;
        for (std::size_t i = 0; i < model.states.size(); ++i) {
            header.channels.push_back({model.states[i].name, model.states[i].unit});
            periods.push_back(0);
            if (model.states[i].name == phase) {
                cyclic = i;
                periods.back() = 2 * std::acos(-1.0);
            }
        }
        header.channels.push_back({"drive", ""});
        header.time.unit = model.time_unit;
        samples.clear(header.channels.size());
        Sampler sampler(skipped, 1 / frequency, count, periods,
                        [&](double time, std::size_t, std::span<const double> state) {
                            samples.times.push_back(time);
                            for (std::size_t i = 0; i < state.size(); ++i)
                                samples.values[i].push_back(state[i]);
                            samples.values.back().push_back(std::sin(state[cyclic]));
                        });
        Relay relay({borrowed(sampler), borrowed(truth)});
        Trajectory trajectory(simulation, model.parameter_values(), borrowed(relay));
        trajectory.start(model.initial_state(), model.initial_mode, 0,
                         skipped + static_cast<double>(count) / frequency);
        JetSet jets(simulation, LaneKind::single);
        run(trajectory, jets);
    }
    void add_noise(const std::string& channel, double deviation, Noise& noise) {
        for (double& value : samples.values[header.channel(channel, "test")])
            value += deviation * noise.normal();
    }
};

} // namespace graze::testing
