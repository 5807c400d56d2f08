#include "graze/base/file_name.hpp"
#include "graze/base/with_place.hpp"
#include "graze/model/catalogue.hpp"
#include "graze/study/plain_states.hpp"
#include "study/key_reader.hpp"
#include "study/run_description.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <filesystem>
#include <functional>

namespace graze {

void set_standards(StudyRun& run) {
    // Users ask where a branch or a curve lies, in both directions; a sweep is a motion and goes in one.
    if (run.kind == RunKind::follow || run.kind == RunKind::curve)
        run.branch().direction = SweepDirection::both;
    // An atlas shows what there is, whichever way one comes.
    if (run.kind == RunKind::atlas)
        run.motion().direction = SweepDirection::both;
    if (run.is_branch())
        run.branch().settings.monitors = usual_monitors(run.model, run.kind);
}

namespace {

Model model_of(const StudyReader& reader, const std::string& name, const Place& place, std::string& path) {
    if (const Model* given = reader.given_model(name))
        return *given;
    const bool of_file = is_model_path(name);
    path = of_file && std::filesystem::path(name).is_relative()
               ? (std::filesystem::path(reader.file()).parent_path() / name).string()
               : name;
    try {
        Model model = reader.loaded_model(path);
        if (!of_file)
            path.clear();
        return model;
    } catch (const InputError& error) {
        if (!error.place().file.empty())
            throw;
        const std::string file = name + ".toml";
        std::error_code none;
        if (!of_file && std::filesystem::exists(std::filesystem::path(reader.file()).parent_path() / file, none))
            throw InputError(place, error.problem(), fmt::format("the file beside the study is called {}", file));
        throw InputError(place, error.problem(), error.remedy());
    }
}

/// Sets parameters or initial states as a table says.
/// @param given parameters that keep their values
/// @param later true for an initial state that is read later, when it is known what varies; null: none is
void set_values(const StudyReader& reader, Model& model, const TomlEntry& entry, bool initial,
                const ParameterValues& given = {}, const std::function<bool(const TomlEntry&)>& later = nullptr) {
    reader.each_of(entry, {}, [&](const TomlEntry& item) {
        if (initial && later && later(item))
            return;
        const bool is_given =
            std::any_of(given.begin(), given.end(), [&](const auto& one) { return one.first == item.name; });
        if (is_given && model.find_independent_parameter(item.name))
            return;
        const double value = reader.number(model, item);
        with_place(item.place,
                   [&] { initial ? model.set_initial(item.name, value) : model.set_parameter(item.name, value); });
    });
}

/// Refuses more points than fit into memory or can be computed in a lifetime.
void check_points(const StudyReader& reader, const StudyRun& run, const TomlEntry& vary) {
    if (!(run.motion().points() <= most_points))
        reader.fail(vary, "there would be more than a thousand million points", "take larger steps");
    if (!(run.motion().rows(run.kind) <= most_rows))
        reader.fail(vary,
                    fmt::format("there would be more than {} million points that begin by themselves", most_rows / 1e6),
                    "make several studies, or sweep along the axis with the most values");
}

/// Sets where motions are sampled and which contacts count, unless the study says so.
void complete_motion(StudyRun& run) {
    MotionRequest& motion = run.motion();
    motion.transient.section = motion.attractor.section;
    if (motion.samplings.empty() && !motion.attractor.section.empty()) {
        Sampling sampling;
        sampling.name = sampling.section = motion.attractor.section;
        motion.samplings.push_back(sampling);
    }
    if (motion.transient.counted.empty())
        for (std::size_t i = 0; i < run.model.events.size(); ++i)
            if (run.model.events[i].kind == EventKind::barrier)
                motion.transient.counted.push_back(i);
    motion.simulation.validate();
    if (!seeks_attractors(run.kind))
        motion.transient.validate(run.model);
    else
        motion.attractor.validate(run.model);
}

/// Sets what the study leaves open.
void complete(StudyRun& run, const TomlEntry& entry) {
    const Model& model = run.model;
    AttractorOptions& attractor = run.attractor();
    if (attractor.section.empty())
        attractor.section = usual_section(model);
    if (run.values.empty())
        for (std::size_t i = 0; i < model.states.size(); ++i)
            if (!model.states[i].period && !model.states[i].drifting) {
                run.value_names.push_back(model.states[i].name);
                run.value_units.push_back(model.states[i].unit);
                run.values.push_back(model.symbol(model.states[i].name));
            }
    with_place(
        entry.place, [&] { run.is_branch() ? run.branch().simulation.validate() : complete_motion(run); },
        entry.path + ": ");
    if (run.is_branch())
        return;
    const std::vector<Variation>& axes = run.motion().axes;
    if (run.is_swept() && (axes.empty() || axes.front().values.empty()))
        throw InputError(entry.place, fmt::format("{} sweeps nothing", entry.path),
                         "give vary = { PARAMETER = { from = A, to = B, step = S } }");
}

void read_model(const StudyReader& reader, StudyRun& run, const TomlEntry& entry, const StudyDefaults& defaults,
                const RunKeys& keys) {
    if (keys.contains("model"))
        run.model = model_of(reader, reader.toml().string(keys.at("model")),
                             reader.toml().place(*keys.at("model").node), run.model_path);
    else if (!defaults.model.empty())
        run.model = model_of(reader, defaults.model, defaults.model_place, run.model_path);
    else
        throw InputError(entry.place, fmt::format("{} has no model", entry.path), "give model = \"NAME\" or a path");
}

/// Sets parameters, initial state and mode of the model as the run asks.
void read_beginning(const StudyReader& reader, StudyRun& run, const StudyDefaults& defaults, const RunKeys& keys) {
    // Given values come first, since expressions may depend on them.
    for (const auto& [name, value] : defaults.given)
        if (run.model.find_independent_parameter(name))
            run.model.set_parameter(name, value);
    Mistakes mistakes;
    if (defaults.set)
        mistakes.attempt([&] { set_values(reader, run.model, *defaults.set, false, defaults.given); });
    with_key(mistakes, keys, "set", [&](const TomlEntry& set) {
        set_values(reader, run.model, set, false, defaults.given);
        note_set(reader, run, set);
    });
    with_key(mistakes, keys, "from", [&](const TomlEntry& from) {
        set_values(reader, run.model, from, true, {},
                   [&](const TomlEntry& item) { return follows_what_varies(reader, run, item); });
    });
    with_key(mistakes, keys, "mode", [&](const TomlEntry& mode) {
        const std::string name = reader.toml().string(mode);
        with_place(reader.toml().place(*mode.node), [&] { run.model.set_initial_mode(name); });
    });
    mistakes.throw_noted();
}

void check_draws(const StudyReader& reader, const StudyRun& run, const TomlEntry& entry, const RunKeys& keys) {
    const MotionRequest& motion = run.motion();
    const bool random =
        std::any_of(motion.axes.begin(), motion.axes.end(), [](const Variation& axis) { return axis.values.empty(); });
    if (random && motion.draws == 0)
        reader.fail(keys.at("vary"), fmt::format("{} does not say how many values to draw", entry.path),
                    "give draws = N");
    if (!random && motion.draws > 0)
        reader.fail(keys.at("draws"), fmt::format("{} draws nothing", entry.path),
                    "give something random: vary = { x = { random = [0, 1] } }");
    if (motion.draws == 0 && keys.contains("seed"))
        reader.fail(keys.at("seed"), fmt::format("{} draws nothing", entry.path), "leave it out, or give draws = N");
}

/// Collects the keys of a run, and reads its kind and text.
void read_run_keys(const StudyReader& reader, StudyRun& run, const TomlEntry& entry, RunKeys& keys) {
    const std::vector<std::string>& known = names_of_keys();
    Mistakes mistakes;
    mistakes.attempt([&] { require_file_name(run.name, "name of a run", entry.place); });
    mistakes.attempt([&] {
        reader.each_of(entry, {}, [&](const TomlEntry& item) {
            if (std::find(known.begin(), known.end(), item.name) == known.end())
                throw InputError(item.place, fmt::format("unknown key '{}' in {}", item.name, entry.path),
                                 study_name_remedy(item.name, known));
            keys.emplace(item.name, item);
        });
        if (!keys.contains("kind"))
            throw InputError(entry.place, fmt::format("{} has no kind", entry.path),
                             fmt::format("give kind = \"{}\" or \"{}\"",
                                         fmt::join(kinds_of_runs().begin(), kinds_of_runs().end() - 1, "\", \""),
                                         kinds_of_runs().back()));
    });
    with_key(mistakes, keys, "kind", [&](const TomlEntry& kind) {
        run.set_kind(static_cast<RunKind>(reader.choice(kind, kinds_of_runs())));
        check_keys_of_kind(reader, run.kind, keys);
    });
    with_key(mistakes, keys, "text", [&](const TomlEntry& text) { run.text = reader.toml().string(text); });
    mistakes.throw_noted();
}

/// True when the records of a run come from a virtual bench.
bool has_bench(const RunKeys& keys) {
    return keys.contains("bench") && !keys.contains("files");
}

/// Reads runs of kind record and identify.
void read_measured(const StudyReader& reader, StudyRun& run, const TomlEntry& entry, const StudyDefaults& defaults,
                   const RunKeys& keys) {
    Mistakes mistakes;
    const bool identifies = run.kind == RunKind::identify;
    if (identifies || has_bench(keys))
        mistakes.attempt([&] { read_beginning(reader, run, defaults, keys); });
    set_standards(run);
    if (identifies && !mistakes.attempt([&] { read_estimate(reader, run, entry, keys); }))
        mistakes.throw_noted();
    KeyReader fields(reader, run, keys, mistakes);
    describe(fields, run);
    if (run.kind == RunKind::record && !fields.is_wrong({"vary", "direction", "carry", "seed"}))
        mistakes.attempt([&] { read_inputs(reader, run, entry, keys); });
    mistakes.throw_noted();
    if (identifies)
        return complete_identify(reader, run, entry);
    read_record(reader, run, keys);
    with_key(mistakes, keys, "values", [&](const TomlEntry& values) { read_values(reader, run, values); });
    mistakes.throw_noted();
    complete_record(reader, run, keys);
}

/// Reads runs of motions and branches, once the model is known.
void read_contents(const StudyReader& reader, StudyRun& run, const TomlEntry& entry, const StudyDefaults& defaults,
                   const RunKeys& keys) {
    Mistakes mistakes;
    mistakes.attempt([&] { read_beginning(reader, run, defaults, keys); });
    set_standards(run);
    KeyReader fields(reader, run, keys, mistakes);
    describe(fields, run);
    if (run.has_motions())
        with_key(mistakes, keys, "from", [&](const TomlEntry& from) { read_following_states(reader, run, from); });
    if (!keys.contains("values") && defaults.values)
        mistakes.attempt([&] { read_values(reader, run, *defaults.values); });
    if (run.has_motions() && !fields.is_wrong({"vary", "draws", "seed"}))
        mistakes.attempt([&] {
            run.kind == RunKind::atlas ? check_atlas(reader, run, keys) : check_draws(reader, run, entry, keys);
            if (keys.contains("vary"))
                check_points(reader, run, keys.at("vary"));
        });
    mistakes.throw_noted();
    if (run.is_branch())
        complete_branch(run, keys);
}

} // namespace

std::optional<StudyRun> read_run(const StudyReader& reader, const TomlEntry& entry, const StudyDefaults& defaults,
                                 RunKeys& keys) {
    StudyRun run;
    run.name = entry.name;
    run.place = entry.place;
    Mistakes mistakes;
    const bool has_keys = mistakes.attempt([&] { read_run_keys(reader, run, entry, keys); });
    // A missing model is not reported where a key that could not be read may have named it.
    const bool says_model = keys.contains("model") || !defaults.model.empty();
    if (run.is_measured() && has_keys) {
        if (run.kind == RunKind::identify || has_bench(keys))
            mistakes.attempt([&] { read_model(reader, run, entry, defaults, keys); });
        mistakes.throw_noted();
        read_measured(reader, run, entry, defaults, keys);
        return run;
    }
    if (!says_model && !(has_keys && defaults.whole)) {
        mistakes.throw_noted();
        return std::nullopt;
    }
    if (mistakes.attempt([&] { read_model(reader, run, entry, defaults, keys); }))
        mistakes.attempt([&] { read_contents(reader, run, entry, defaults, keys); });
    mistakes.throw_noted();
    complete(run, entry);
    if (run.is_branch())
        check_branch(reader, run, entry, keys);
    return run;
}

} // namespace graze
