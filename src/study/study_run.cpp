#include "graze/base/file_name.hpp"
#include "graze/model/catalogue.hpp"
#include "study/point_limits.hpp"
#include "study/start_state.hpp"
#include "study/study_reader.hpp"
#include "study/study_sampling.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <functional>

namespace graze {

namespace {

Model model_of(const StudyReader& reader, const std::string& name, const Place& place, std::string& path) {
    const bool of_file = is_model_path(name);
    path = of_file && std::filesystem::path(name).is_relative()
               ? (std::filesystem::path(reader.file()).parent_path() / name).string()
               : name;
    try {
        Model model = load_model(path);
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

/// @param given parameters that keep the values that they have
/// @param later whether an initial state is read later, when it is known what varies; null: none is
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
        try {
            initial ? model.set_initial(item.name, value) : model.set_parameter(item.name, value);
        } catch (const InputError& error) {
            throw InputError(item.place, error.problem(), error.remedy());
        }
    });
}

void read_bounds(const StudyReader& reader, StudyRun& run, const TomlEntry& entry) {
    reader.each_of(entry, {}, [&](const TomlEntry& item) {
        const auto state = run.model.find_state(item.name);
        if (!state)
            throw InputError(item.place, fmt::format("the model has no state '{}'", item.name),
                             "give bounds of states: { q = [-1, 1] }");
        const auto [least, greatest] = reader.range(run.model, item);
        run.attractor.bounds.push_back({*state, least, greatest});
    });
    run.transient.bounds = run.attractor.bounds;
}

/// Which branch through a point, or which curve.
std::vector<std::string> ways_on() {
    std::vector<std::string> names{"same", "other", "twin"};
    for (const PointKind& kind : point_kinds())
        if (kind.may_be_kept)
            names.emplace_back(kind.short_name);
    return names;
}

void read_start(const StudyReader& reader, StudyRun& run, const TomlEntry& entry) {
    StartFrom start;
    start.place = entry.place;
    reader.each_of(entry, {"run", "at", "direction", "point", "onto"}, [&](const TomlEntry& item) {
        if (item.name == "run") {
            start.run = reader.toml().string(item);
        } else if (item.name == "direction") {
            reader.choice(item, {"up", "down"});
            start.direction = reader.toml().string(item);
        } else if (item.name == "point") {
            start.point = item.node->is_integer() ? std::to_string(reader.count(item)) : reader.toml().string(item);
        } else if (item.name == "onto") {
            reader.choice(item, ways_on());
            start.onto = reader.toml().string(item);
        } else {
            const auto at = reader.toml().entries(reader.toml().table(item), item.path);
            if (at.size() != 1)
                reader.fail(item, fmt::format("{} names {} coordinates", item.path, at.size()), "name one");
            start.coordinate = at.front().name;
            start.value = reader.number(run.model, at.front());
        }
    });
    if (start.run.empty())
        reader.fail(entry, fmt::format("{} names no run", entry.path), "write { run = \"NAME\", at = { V = 1 } }");
    run.start = start;
}

void read_vary(const StudyReader& reader, StudyRun& run, const TomlEntry& entry, bool& random) {
    double points = static_cast<double>(std::max<std::size_t>(run.draws, 1));
    reader.each_of(entry, {}, [&](const TomlEntry& item) {
        run.axes.push_back(read_variation(reader, run.model, item, random));
        points *= static_cast<double>(std::max<std::size_t>(run.axes.back().values.size(), 1));
        if (points > most_points) // before the next axis takes room
            reader.fail(entry, "there would be more than a thousand million points", "take larger steps");
    });
    const bool swept = run.kind == RunKind::sweep && !run.axes.empty();
    if (points / static_cast<double>(swept ? std::max<std::size_t>(run.axes.front().values.size(), 1) : 1) >
        most_chains)
        reader.fail(
            entry,
            fmt::format("there would be more than {} million points that begin by themselves", most_chains / 1e6),
            "make several studies, or sweep along the axis with the most values");
}

void read_skip(const StudyReader& reader, StudyRun& run, const TomlEntry& entry) {
    reader.each_of(entry, {"time", "periods"}, [&](const TomlEntry& item) {
        if (item.name == "time")
            run.transient.skip_time = reader.positive(run.model, item);
        else
            run.transient.skip_periods = reader.count(item);
    });
}

/// Keys whose order does not matter once the model is known.
void read_settings(const StudyReader& reader, StudyRun& run, const RunKeys& keys) {
    const Model& model = run.model;
    Mistakes mistakes;
    const auto with = [&](const char* key, auto use) { with_key(mistakes, keys, key, use); };
    AttractorOptions& attractor = run.attractor;
    TransientOptions& transient = run.transient;
    with("direction", [&](const TomlEntry& e) {
        run.direction = static_cast<SweepDirection>(reader.choice(e, {"up", "down", "both"}));
    });
    with("carry", [&](const TomlEntry& e) { run.carry = reader.toml().boolean(e); });
    with("cycles", [&](const TomlEntry& e) { attractor.cycles = reader.count(e, 1, most_cycles); });
    with("keep", [&](const TomlEntry& e) { attractor.keep = reader.count(e, 1, most_kept_returns); });
    with("largest_period",
         [&](const TomlEntry& e) { attractor.largest_period = reader.count(e, 1, most_returns_of_orbit); });
    with("recurrence", [&](const TomlEntry& e) { attractor.recurrence = reader.positive(model, e); });
    with("disturbance", [&](const TomlEntry& e) { attractor.disturbance = reader.number(model, e); });
    with("lyapunov_cycles", [&](const TomlEntry& e) { attractor.lyapunov_cycles = reader.count(e, 0, most_cycles); });
    with("chaos_cycles", [&](const TomlEntry& e) { attractor.chaos_cycles = reader.count(e, 0, most_cycles); });
    with("longest_return", [&](const TomlEntry& e) { attractor.longest_return = reader.positive(model, e); });
    with("bounds", [&](const TomlEntry& e) { read_bounds(reader, run, e); });
    with("time", [&](const TomlEntry& e) { transient.time = reader.positive(model, e); });
    with("periods", [&](const TomlEntry& e) { transient.periods = reader.count(e, 1); });
    with("skip", [&](const TomlEntry& e) { read_skip(reader, run, e); });
    with("contacts", [&](const TomlEntry& e) { transient.contacts = reader.count(e, 1); });
    with("events", [&](const TomlEntry& e) { transient.counted = events_of(reader, model, e); });
    with("greatest_speed", [&](const TomlEntry& e) { transient.greatest_speed = reader.positive(model, e); });
    with("tolerance", [&](const TomlEntry& e) { run.simulation.tolerance = reader.positive(model, e); });
    with("order", [&](const TomlEntry& e) { run.simulation.order = static_cast<int>(reader.count(e)); });
    with("largest_step", [&](const TomlEntry& e) { run.simulation.largest_step = reader.positive(model, e); });
    with("draws", [&](const TomlEntry& e) { run.draws = reader.count(e, 1); });
    with("seed", [&](const TomlEntry& e) { run.seed = reader.count(e); });
    mistakes.throw_noted();
}

/// What the user left to us.
void complete(StudyRun& run, const TomlEntry& entry) {
    const Model& model = run.model;
    if (run.attractor.section.empty() && !model.sections.empty()) {
        const auto phase = std::find_if(model.sections.begin(), model.sections.end(),
                                        [](const Section& section) { return section.state.has_value(); });
        run.attractor.section = (phase == model.sections.end() ? model.sections.front() : *phase).name;
    }
    run.transient.section = run.attractor.section;
    if (run.samplings.empty() && !run.attractor.section.empty()) {
        Sampling sampling;
        sampling.name = sampling.section = run.attractor.section;
        run.samplings.push_back(sampling);
    }
    if (run.transient.counted.empty())
        for (std::size_t i = 0; i < model.events.size(); ++i)
            if (model.events[i].kind == EventKind::barrier)
                run.transient.counted.push_back(i);
    if (run.values.empty())
        for (std::size_t i = 0; i < model.states.size(); ++i)
            if (!model.states[i].period && !model.states[i].drifting) {
                run.value_names.push_back(model.states[i].name);
                run.value_units.push_back(model.states[i].unit);
                run.values.push_back(model.symbol(model.states[i].name));
            }
    try {
        run.simulation.validate();
        if (run.is_branch())
            return;
        if (run.kind == RunKind::simulate)
            run.transient.validate(model);
        else
            run.attractor.validate(model);
    } catch (const InputError& error) {
        throw InputError(entry.place, fmt::format("{}: {}", entry.path, error.problem()), error.remedy());
    }
    if (run.kind == RunKind::sweep && (run.axes.empty() || run.axes.front().values.empty()))
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

/// Parameters, initial state and mode of the model, as the run asks for.
void read_beginning(const StudyReader& reader, StudyRun& run, const StudyDefaults& defaults, const RunKeys& keys) {
    // Before the others, whose expressions may depend on them.
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
        try {
            run.model.set_initial_mode(reader.toml().string(mode));
        } catch (const InputError& error) {
            reader.fail(mode, error.problem(), error.remedy());
        }
    });
    mistakes.throw_noted();
}

/// What varies, with draws where it does so at random. @return whether anything does
bool read_axes(const StudyReader& reader, StudyRun& run, const RunKeys& keys) {
    bool random = false;
    if (keys.contains("vary"))
        read_vary(reader, run, keys.at("vary"), random);
    return random;
}

void check_draws(const StudyReader& reader, const StudyRun& run, bool random, const TomlEntry& entry,
                 const RunKeys& keys) {
    if (random && run.draws == 0)
        reader.fail(keys.at("vary"), fmt::format("{} does not say how many values to draw", entry.path),
                    "give draws = N");
    if (!random && run.draws > 0)
        reader.fail(keys.at("draws"), fmt::format("{} draws nothing", entry.path),
                    "give something random: vary = { x = { random = [0, 1] } }");
    if (run.draws == 0 && keys.contains("seed"))
        reader.fail(keys.at("seed"), fmt::format("{} draws nothing", entry.path), "leave it out, or give draws = N");
}

/// The keys that a run has, and what it is.
void read_keys(const StudyReader& reader, StudyRun& run, const TomlEntry& entry, RunKeys& keys) {
    const std::vector<std::string> known = run_keys();
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
                             "give kind = \"simulate\", \"sweep\", \"basin\", \"orbit\", \"continue\", \"curve\", "
                             "\"ladder\", \"record\" or \"identify\"");
    });
    with_key(mistakes, keys, "kind", [&](const TomlEntry& kind) {
        run.kind = static_cast<RunKind>(reader.choice(kind, kinds_of_runs()));
        check_keys_of_kind(reader, run.kind, keys);
    });
    with_key(mistakes, keys, "text", [&](const TomlEntry& text) { run.text = reader.toml().string(text); });
    mistakes.throw_noted();
}

/// What comes from other runs.
void read_parameters(const StudyReader& reader, StudyRun& run, const TomlEntry& entry) {
    run.parameters = reader.strings(entry);
    run.parameters_place = entry.place;
    if (run.parameters.empty())
        reader.fail(entry, fmt::format("{} names no run", entry.path), "name a run of kind \"identify\"");
}

/// Whether a run's records are those of a virtual bench.
bool has_bench(const RunKeys& keys) {
    return keys.contains("bench") && !keys.contains("files");
}

/// Records, and what is found from them.
void read_measured(const StudyReader& reader, StudyRun& run, const TomlEntry& entry, const StudyDefaults& defaults,
                   const RunKeys& keys) {
    Mistakes mistakes;
    const bool identifies = run.kind == RunKind::identify;
    if (identifies || has_bench(keys))
        mistakes.attempt([&] { read_beginning(reader, run, defaults, keys); });
    if (identifies)
        mistakes.attempt([&] { read_settings(reader, run, keys); });
    if (has_bench(keys)) {
        with_key(mistakes, keys, "direction", [&](const TomlEntry& e) {
            run.direction = static_cast<SweepDirection>(reader.choice(e, {"up", "down", "both"}));
        });
        with_key(mistakes, keys, "carry", [&](const TomlEntry& e) { run.carry = reader.toml().boolean(e); });
        with_key(mistakes, keys, "seed", [&](const TomlEntry& e) { run.seed = reader.count(e); });
        mistakes.attempt([&] { read_axes(reader, run, keys); });
    }
    mistakes.throw_noted();
    if (run.kind == RunKind::record) {
        read_record(reader, run, entry, keys);
        with_key(mistakes, keys, "values", [&](const TomlEntry& values) { read_values(reader, run, values); });
        mistakes.throw_noted();
        complete_record(reader, run, keys);
        return;
    }
    with_key(mistakes, keys, "parameters", [&](const TomlEntry& from) { read_parameters(reader, run, from); });
    mistakes.attempt([&] { read_identify(reader, run, entry, keys); });
    mistakes.throw_noted();
}

/// All that needs the model.
void read_contents(const StudyReader& reader, StudyRun& run, const TomlEntry& entry, const StudyDefaults& defaults,
                   const RunKeys& keys) {
    Mistakes mistakes;
    mistakes.attempt([&] { read_beginning(reader, run, defaults, keys); });
    with_key(mistakes, keys, "section", [&](const TomlEntry& section) {
        run.attractor.section = run.model.sections[section_index(reader, run.model, section)].name;
    });
    // Where a branch or a curve lies is what one asks; a sweep is a motion, which can go one way only.
    if (run.kind == RunKind::follow || run.kind == RunKind::curve)
        run.direction = SweepDirection::both;
    const bool settings = mistakes.attempt([&] { read_settings(reader, run, keys); });
    bool random = false;
    if (mistakes.attempt([&] { random = read_axes(reader, run, keys); }) && settings)
        mistakes.attempt([&] { check_draws(reader, run, random, entry, keys); });
    if (run.kind == RunKind::simulate || run.kind == RunKind::sweep || run.kind == RunKind::basin)
        with_key(mistakes, keys, "from", [&](const TomlEntry& from) { read_following_states(reader, run, from); });
    with_key(mistakes, keys, "start", [&](const TomlEntry& start) { read_start(reader, run, start); });
    with_key(mistakes, keys, "parameters", [&](const TomlEntry& from) { read_parameters(reader, run, from); });
    with_key(mistakes, keys, "sample", [&](const TomlEntry& sample) { read_samplings(reader, run, sample); });
    if (keys.contains("values"))
        mistakes.attempt([&] { read_values(reader, run, keys.at("values")); });
    else if (defaults.values)
        mistakes.attempt([&] { read_values(reader, run, *defaults.values); });
    if (run.is_branch())
        mistakes.attempt([&] { read_branch(reader, run, keys); });
    mistakes.throw_noted();
}

} // namespace

std::optional<StudyRun> read_run(const StudyReader& reader, const TomlEntry& entry, const StudyDefaults& defaults,
                                 RunKeys& keys) {
    StudyRun run;
    run.name = entry.name;
    run.place = entry.place;
    Mistakes mistakes;
    const bool has_keys = mistakes.attempt([&] { read_keys(reader, run, entry, keys); });
    // A key that could not be read may have been the one that names the model.
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
