#include "study/run_forms.hpp"
#include "study/study_reader.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace graze {

void read_starts(const StudyReader& reader, StudyRun& run, const TomlEntry& entry) {
    reader.each_of(entry, {}, [&](const TomlEntry& item) {
        const std::vector<std::string> known = names_of(run.model.states);
        if (!run.model.find_state(item.name))
            throw InputError(item.place, fmt::format("the model has no state '{}'", item.name),
                             study_name_remedy(item.name, known));
        const auto [low, high] = reader.range(run.model, item);
        run.motion().atlas.starts.push_back({item.name, low, high});
    });
    if (run.motion().atlas.starts.empty())
        reader.fail(entry, fmt::format("{} names no state", entry.path),
                    "write starts = { STATE = [LEAST, GREATEST] }, or leave it out");
}

std::string why_no_axis_of_atlas(const Variation& axis) {
    if (axis.state)
        return "is a state, and an atlas is of parameters";
    if (axis.values.empty())
        return "is random, and an atlas goes through values in their order";
    return axis.values.size() < 2 ? "has one value, along which nothing can be followed" : "";
}

namespace {

/// @throws InputErrors for axes that are no box of one or two parameters
void check_box(const StudyReader& reader, const StudyRun& run, const TomlEntry& vary) {
    const std::vector<Variation>& axes = run.motion().axes;
    if (axes.size() > most_axes_of_atlas)
        reader.fail(vary, fmt::format("an atlas is of one or two parameters, and {} varies {}", vary.path, axes.size()),
                    "give the others values: set = { PARAMETER = VALUE }");
    reader.each_of(vary, {}, [&](const TomlEntry& item) {
        const auto axis = std::ranges::find(axes, item.name, &Variation::name);
        const std::string why = axis == axes.end() ? "" : why_no_axis_of_atlas(*axis);
        if (!why.empty())
            reader.fail(item, fmt::format("{} {}", item.path, why),
                        axis->state ? fmt::format("give a range of initial states: starts = {{ {} = [LEAST, GREATEST] "
                                                  "}}",
                                                  item.name)
                                    : "write { from = A, to = B, points = N }, or a list of values");
    });
}

} // namespace

void check_atlas(const StudyReader& reader, const StudyRun& run, const RunKeys& keys) {
    Mistakes mistakes;
    with_key(mistakes, keys, "vary", [&](const TomlEntry& vary) { check_box(reader, run, vary); });
    if (run.motion().axes.size() == 1)
        with_key(mistakes, keys, "curves", [&](const TomlEntry& curves) {
            reader.fail(curves, "`curves` has no effect here: curves lie in a plane of two parameters",
                        "leave it out, or vary a second parameter");
        });
    if (run.motion().atlas.draws == 0)
        for (const char* key : {"starts", "seed"})
            with_key(mistakes, keys, key, [&](const TomlEntry& entry) {
                reader.fail(entry, fmt::format("`{}` has no effect here: nothing is drawn at random", key),
                            "leave it out, or give draws = N");
            });
    mistakes.throw_noted();
}

} // namespace graze
