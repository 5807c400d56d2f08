#include "graze/model/check.hpp"
#include "graze/base/input_error.hpp"
#include "graze/flow/derivative_check.hpp"
#include "graze/model/catalogue.hpp"
#include "graze/results/model_table.hpp"
#include "graze/trajectory/trajectory.hpp"
#include "program/commands.hpp"
#include "program/describe.hpp"
#include "program/drawing.hpp"
#include "program/output_file.hpp"
#include "program/values.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <string>

namespace graze {

namespace {

/// The place in a model file where the part "TABLE.NAME" is defined: as [TABLE.NAME], or as NAME = ... under [TABLE].
/// It has no line if the definition is not found.
Place place_of(const std::string& model, const std::string& part) {
    Place place{model, 0, 0};
    const std::size_t dot = part.find('.');
    if (dot == std::string::npos || !is_model_path(model))
        return place;
    const std::string table = part.substr(0, dot), name = part.substr(dot + 1);
    std::ifstream stream(model, std::ios::binary);
    bool inside = false;
    int number = 0;
    for (std::string line; std::getline(stream, line);) {
        ++number;
        const std::size_t begin = line.find_first_not_of(" \t");
        if (begin == std::string::npos)
            continue;
        const bool header = line[begin] == '[';
        if (header)
            inside = line.compare(begin, table.size() + 2, fmt::format("[{}]", table)) == 0;
        const std::string whole = fmt::format("[{}]", part);
        const std::size_t after = line.find_first_not_of(" \t", begin + name.size());
        const bool key = inside && !header && line.compare(begin, name.size(), name) == 0 &&
                         after != std::string::npos && (line[after] == '=' || line[after] == '.');
        if (key || (header && line.compare(begin, whole.size(), whole) == 0))
            return {model, number, static_cast<int>(begin) + 1};
    }
    return place;
}

/// Ends a motion after a number of steps; models with many operations in a step get fewer steps.
class StepLimit : public Observer {
public:
    explicit StepLimit(const System& system)
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
    StepLimit limit(system);
    Trajectory trajectory(simulation, model.parameter_values(), borrowed(limit));
    trajectory.start(model.initial_state(), model.initial_mode, 0, 1e300);
    JetSet jets(simulation, LaneKind::single);
    run(trajectory, jets);
    const Outcome& outcome = trajectory.outcome();
    const bool wrong = outcome.ending == Ending::inadmissible || outcome.ending == Ending::no_separation ||
                       outcome.ending == Ending::no_progress || outcome.ending == Ending::no_transition;
    // An inadmissible initial state already has a warning of located_warnings.
    if (!wrong || (outcome.ending == Ending::inadmissible && outcome.time == 0))
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

int check_command(const CheckArguments& arguments, const Console& console) {
    const Model model = load_model(arguments.model);
    std::vector<ModelWarning> warnings = located_warnings(model);
    const System system(model);
    for (auto* more : {motion_warnings, derivative_warnings})
        for (ModelWarning& warning : more(system))
            warnings.push_back(std::move(warning));
    for (const ModelWarning& warning : warnings)
        console.err << "graze: warning: " << place_of(arguments.model, warning.part).text() << ": " << warning.text
                    << '\n';
    if (!arguments.graph.empty())
        draw_graph(model, arguments.graph);
    if (arguments.output.format != TableFormat::table) {
        JsonObject heading;
        heading.add("model", model.name);
        deliver(model_table(model), arguments.output, heading, console);
    } else if (arguments.output.file.empty()) {
        console.out << describe(model, console.width);
    } else {
        write_file(arguments.output.file, describe(model));
    }
    return exit_success;
}

} // namespace graze
