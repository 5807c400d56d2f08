#include "graze/results/model_findings.hpp"

#include "graze/base/borrowed.hpp"
#include "graze/flow/derivative_check.hpp"
#include "graze/trajectory/trajectory.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace graze {

namespace {

/// Ends a motion after a number of steps; models with many operations in a step get fewer steps.
class StepsOfCheck : public Observer {
public:
    explicit StepsOfCheck(const System& system)
        : most_(std::clamp(work / (system.operations() + 1), fewest_steps, most_steps)) {}
    void step(const Step&) override { ++steps_; }
    bool stop() override { return steps_ > most_; }

private:
    static constexpr std::size_t most_steps = 2000, fewest_steps = 20, work = 40'000'000; ///< a second or two
    std::size_t most_, steps_ = 0;
};

/// Warns if derivatives at the initial state disagree with differences.
std::vector<ModelWarning> derivative_warnings(const System& system) {
    constexpr std::size_t most = 60; // states and parameters: the work is proportional to their square
    std::vector<ModelWarning> warnings;
    const Model& model = system.model();
    if (system.states() + system.parameters() > most)
        return warnings;
    for (const DerivativeFinding& finding : check_derivatives(system, model.initial_state(), model.parameter_values()))
        warnings.push_back({finding.part, finding.text()});
    return warnings;
}

/// Warns if the motion from the initial state soon ends irregularly, as beyond a barrier.
std::vector<ModelWarning> motion_warnings(const System& system) {
    const Model& model = system.model();
    const Simulation simulation(system);
    StepsOfCheck limit(system);
    Trajectory trajectory(simulation, model.parameter_values(), borrowed(limit));
    trajectory.start(model.initial_state(), model.initial_mode, 0, 1e300);
    JetSet jets(simulation, LaneKind::single);
    run(trajectory, jets);
    const Outcome& outcome = trajectory.outcome();
    const bool wrong = outcome.ending == Ending::inadmissible || outcome.ending == Ending::no_separation ||
                       outcome.ending == Ending::no_progress || outcome.ending == Ending::no_transition ||
                       outcome.ending == Ending::two_fold || outcome.ending == Ending::painleve;
    // An inadmissible initial state already has a warning of located_warnings.
    if (!wrong || (outcome.time == 0 && outcome.detail.find("is already violated") != std::string::npos))
        return {};
    ModelWarning warning{
        "", fmt::format("the motion from the initial state ends at time {:.6g}: {}", outcome.time, outcome.detail)};
    for (const Event& event : model.events)
        if (outcome.detail.find(fmt::format("barrier '{}'", event.name)) != std::string::npos) {
            warning.part = "events." + event.name;
            warning.text += "; perhaps its function has the wrong sign";
        }
    return {warning};
}

} // namespace

std::vector<ModelWarning> model_findings(const Model& model) {
    std::vector<ModelWarning> warnings = located_warnings(model);
    const System system(model);
    for (auto* more : {motion_warnings, derivative_warnings})
        for (ModelWarning& warning : more(system))
            warnings.push_back(std::move(warning));
    return warnings;
}

} // namespace graze
