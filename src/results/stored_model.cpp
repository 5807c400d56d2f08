#include "graze/base/input_error.hpp"
#include "graze/model/model_file.hpp"
#include "graze/results/result_file.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace graze {

namespace {

bool fits(const Model& model, const RunRecord& run) {
    const auto is_known = [&](const ResultColumn& column) {
        return model.find_independent_parameter(column.name) || (!run.is_branch() && model.find_state(column.name));
    };
    const bool states =
        std::equal(model.states.begin(), model.states.end(), run.states.begin(), run.states.end(),
                   [](const State& state, const ResultColumn& column) { return state.name == column.name; });
    // The modes of a branch are stored with its segments, and checked when these are read.
    const bool modes =
        run.is_branch() || std::equal(model.modes.begin(), model.modes.end(), run.modes.begin(), run.modes.end(),
                                      [](const Mode& mode, const std::string& name) { return mode.name == name; });
    return states && modes && std::all_of(run.coordinates.begin(), run.coordinates.end(), is_known);
}

} // namespace

Place stored_place(const std::string& file, const std::string& what) {
    return {file.empty() ? what : fmt::format("{}: {}", file, what), 0, 0};
}

Model stored_model(const RunRecord& run) {
    const Place place = stored_place(run.file, fmt::format("model of run '{}'", run.name));
    Model model = parse_model(run.model, place.file);
    if (!fits(model, run))
        throw InputError(place, fmt::format("the model stored for run '{}' is not the one of its columns", run.name),
                         "the result file has been changed: ask for another copy, or run the study again");
    return model;
}

} // namespace graze
