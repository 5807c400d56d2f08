#pragma once

#include "graze/model/catalogue.hpp"
#include "graze/model/model_file.hpp"
#include "graze/trajectory/recorder.hpp"
#include "graze/trajectory/trajectory.hpp"

#include <fmt/format.h>

#include <limits>
#include <string>
#include <utility>
#include <vector>

namespace graze::testing {

inline constexpr double epsilon = std::numeric_limits<double>::epsilon();

using Settings = std::vector<std::pair<std::string, double>>;

/// Returns a shipped model with other parameters.
inline Model shipped_with(const std::string& name, const Settings& settings = {}) {
    Model model = load_model(name);
    for (const auto& [parameter, value] : settings)
        model.set_parameter(parameter, value);
    return model;
}

inline SimulationOptions with_tolerance(double tolerance) {
    return {.tolerance = tolerance};
}

/// Runs a trajectory to its end, on jets of its own.
inline void run(Trajectory& trajectory) {
    JetSet jets(trajectory.simulation(), LaneKind::single);
    graze::run(trajectory, jets);
}

/// One trajectory with all that it needs, recorded.
class Experiment {
public:
    explicit Experiment(Model model, SimulationOptions options = {}, std::vector<Probe> probes = {},
                        std::vector<Expression> observed = {})
        : simulation(System(std::move(model)), std::move(probes), std::move(observed), options),
          jets(simulation, LaneKind::single), observer({borrowed(recorder)}),
          trajectory(simulation, simulation.model().parameter_values(), borrowed(observer)) {}
    Experiment(const Experiment&) = delete;

    const Outcome& run(double end_time) {
        return run_from(simulation.model().initial_state(), simulation.model().initial_mode, end_time);
    }
    const Outcome& run_from(std::vector<double> state, std::size_t mode, double end_time) {
        recorder.clear();
        trajectory.start(state, mode, 0, end_time);
        graze::run(trajectory, jets);
        return trajectory.outcome();
    }
    const Outcome& go_on(double end_time) {
        trajectory.extend(end_time);
        graze::run(trajectory, jets);
        return trajectory.outcome();
    }
    std::vector<double> state() const { return {trajectory.state().begin(), trajectory.state().end()}; }
    /// Returns the label of a contact's transition.
    const std::string& label(std::size_t contact) const {
        return simulation.model().transitions[recorder.contacts()[contact].contact.transition].label;
    }

    Simulation simulation;
    JetSet jets;
    Recorder recorder;

private:
    Relay observer;

public:
    Trajectory trajectory;
};

/// Returns the model of a TOML text.
inline Model model_from(const std::string& text) {
    return parse_model(text, "test.toml");
}

} // namespace graze::testing
