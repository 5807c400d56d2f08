#include "graze/base/file_name.hpp"
#include "graze/base/require.hpp"
#include "graze/base/text_file.hpp"
#include "graze/results/result_file.hpp"
#include "graze/study/stored_study.hpp"
#include "study/asked_run.hpp"
#include "study/measured_settings.hpp"
#include "study/point_limits.hpp"
#include "study/settings_fields.hpp"
#include "study/start_state.hpp"
#include "study/study_reader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace graze {

namespace {

std::vector<std::string> short_names() {
    std::vector<std::string> names;
    for (const PointKind& kind : point_kinds())
        names.emplace_back(kind.short_name);
    return names;
}

/// Empty when it cannot be read, which is told when the run reads it.
std::string text_of_table(const BranchRequest& branch) {
    if (!branch.table_text.empty() || branch.table.empty())
        return branch.table_text;
    try {
        return read_text_file(branch.table, "table of an orbit", longest_table);
    } catch (const InputError&) {
        return "";
    }
}

// What follows describes settings to what writes and to what reads them; of the first, runs are constant.

template <class Fields, class Axis>
void describe_axis(Fields& fields, Axis& axis) {
    fields.field("name", axis.name);
    if (fields.has("values", !axis.values.empty())) {
        fields.field("values", axis.values);
        return;
    }
    fields.field("low", axis.low);
    fields.field("high", axis.high);
    fields.field("logarithmic", axis.logarithmic);
    fields.field("offset", axis.offset);
}

template <class Fields, class Bounds>
void describe_bounds(Fields& fields, Bounds& bounds, const Model& model) {
    fields.list("bounds", bounds, [names = names_of(model.states)](auto& one, auto& bound) {
        one.named("state", bound.state, names);
        one.field("least", bound.least);
        one.field("greatest", bound.greatest);
    });
}

template <class Fields, class One>
void describe_sampling(Fields& fields, One& sampling, const Model& model) {
    fields.field("name", sampling.name);
    if (fields.has("section", sampling.at == Sampling::At::section)) {
        fields.follows(sampling.at, Sampling::At::section);
        fields.field("section", sampling.section);
    }
    if (fields.has("extrema", sampling.at == Sampling::At::extremum)) {
        fields.follows(sampling.at, Sampling::At::extremum);
        fields.expression("extrema", sampling.expression);
        fields.number("direction", sampling.direction, 3);
    }
    if (fields.has("events", sampling.at == Sampling::At::contact)) {
        fields.follows(sampling.at, Sampling::At::contact);
        fields.field("events", sampling.events);
    }
    if (fields.has("image", sampling.symmetry.has_value())) {
        fields.follows(sampling.symmetry, std::optional<std::size_t>(0));
        fields.named("image", *sampling.symmetry, names_of(model.symmetries));
    }
}

template <class Fields, class One>
void describe_monitor(Fields& fields, One& monitor) {
    fields.field("name", monitor.name);
    fields.number("kind", monitor.kind, static_cast<std::size_t>(Monitor::Kind::multiplier) + 1);
    fields.field("segment", monitor.segment);
    if (monitor.kind == Monitor::Kind::multiplier)
        fields.field("place", monitor.place);
    else if (monitor.kind != Monitor::Kind::duration)
        fields.expression("expression", monitor.expression);
    fields.field("fixed", monitor.fixed);
    fields.field("crossings", monitor.crossings);
    fields.optional("held", monitor.held);
    fields.optional("least", monitor.least);
    fields.optional("greatest", monitor.greatest);
}

template <class Fields, class Run>
void describe_continuation(Fields& fields, Run& run, const std::vector<std::string>& parameters) {
    auto& branch = run.branch.settings;
    fields.named("along", branch.parameter, parameters);
    fields.field("steps", branch.steps);
    if (fields.has("work", branch.work != BranchSettings().work))
        fields.field("work", branch.work);
    fields.named("free", branch.free, parameters);
    if (fields.has("free_bounds", !branch.free_bounds.empty()))
        fields.list("free_bounds", branch.free_bounds, [&parameters](auto& one, auto& bounds) {
            one.named("parameter", bounds.parameter, parameters);
            one.optional("least", bounds.least);
            one.optional("greatest", bounds.greatest);
        });
    fields.words("stop", branch.stop_at, short_names());
    fields.field("stop_when_unphysical", branch.stop_when_unphysical);
    fields.field("reorder", branch.reorder);
    fields.optional("least", branch.least);
    fields.optional("greatest", branch.greatest);
    auto& step = branch.continuation;
    fields.field("first_step", step.first_step);
    fields.field("smallest_step", step.smallest_step);
    fields.field("largest_step", step.largest_step);
    fields.field("step_accuracy", step.accuracy);
    fields.field("largest_angle", step.largest_angle);
    fields.field("step_iterations", step.iterations);
    if (run.kind == RunKind::ladder)
        fields.field("rungs", run.branch.rungs);
    if (fields.has("grazing", run.branch.touches))
        fields.field("grazing", run.branch.touches);
}

template <class Fields, class Run>
void describe_branch(Fields& fields, Run& run) {
    auto& branch = run.branch.settings;
    fields.field("signature", run.branch.signature);
    if constexpr (Fields::reading)
        fields.field("table", run.branch.table_text);
    else
        fields.field("table", text_of_table(run.branch));
    fields.list("monitors", branch.monitors, [](auto& one, auto& monitor) { describe_monitor(one, monitor); });
    fields.field("accuracy", branch.orbit.accuracy);
    fields.field("orbit_tolerance", branch.orbit.tolerance);
    fields.field("orbit_iterations", branch.orbit.iterations);
    fields.field("error_estimate", branch.orbit.error_estimate);
    // Of an orbit too: when it does not settle, what is not admissible may do.
    if (run.is_followed())
        describe_continuation(fields, run, run.model.independent_parameters());
    else
        fields.field("stop_when_unphysical", branch.stop_when_unphysical);
}

template <class Fields, class Transient>
void describe_transient(Fields& fields, Transient& transient) {
    fields.field("section", transient.section);
    fields.field("skip_time", transient.skip_time);
    fields.field("time", transient.time);
    fields.field("skip_periods", transient.skip_periods);
    fields.field("periods", transient.periods);
    fields.field("contacts", transient.contacts);
    fields.field("counted", transient.counted);
    fields.field("greatest_speed", transient.greatest_speed);
}

template <class Fields, class Attractor>
void describe_attractor(Fields& fields, Attractor& attractor) {
    fields.field("section", attractor.section);
    fields.field("cycles", attractor.cycles);
    fields.field("keep", attractor.keep);
    fields.field("largest_period", attractor.largest_period);
    fields.field("recurrence", attractor.recurrence);
    fields.field("disturbance", attractor.disturbance);
    fields.field("lyapunov_cycles", attractor.lyapunov_cycles);
    fields.field("chaos_cycles", attractor.chaos_cycles);
    fields.field("longest_return", attractor.longest_return);
}

template <class Fields, class Start>
void describe_start(Fields& fields, Start& start) {
    fields.field("run", start.run);
    fields.optional("coordinate", start.coordinate);
    fields.field("value", start.value);
    fields.optional("direction", start.direction);
    fields.field("point", start.point);
    fields.field("onto", start.onto);
}

/// Runs that simulate nothing themselves.
template <class Fields, class Run>
void describe_measured(Fields& fields, Run& run) {
    fields.field("value_names", run.value_names);
    if (run.kind == RunKind::record) {
        fields.object("record", [&](auto& one) { describe_record(one, run.record); });
        fields.expressions("values", run.values);
        return;
    }
    fields.object("identify", [&](auto& one) { describe_identify(one, run.identify); });
    fields.field("parameters", run.parameters);
    fields.field("tolerance", run.simulation.tolerance);
}

template <class Fields, class Run>
void describe(Fields& fields, Run& run) {
    fields.word("kind", run.kind, kinds_of_runs());
    if (run.is_measured())
        return describe_measured(fields, run);
    fields.list("vary", run.axes, [](auto& one, auto& axis) { describe_axis(one, axis); });
    if (fields.has("following", !run.following.empty()))
        fields.list("following", run.following, [&](auto& one, auto& following) {
            one.named("state", following.state, names_of(run.model.states));
            one.expression("value", following.value);
        });
    fields.named("set", run.branch.set, run.model.independent_parameters());
    if (fields.has("draws", run.draws > 0)) {
        fields.field("draws", run.draws);
        fields.field("seed", run.seed);
    }
    if (run.kind == RunKind::sweep || run.is_followed())
        fields.number("direction", run.direction, 3);
    if (run.kind == RunKind::sweep)
        fields.field("carry", run.carry);
    if (run.is_branch())
        fields.object("branch", [&](auto& one) { describe_branch(one, run); });
    const bool transient = run.kind == RunKind::simulate;
    if (transient)
        describe_transient(fields, run.transient);
    else
        describe_attractor(fields, run.attractor);
    describe_bounds(fields, transient ? run.transient.bounds : run.attractor.bounds, run.model);
    fields.list("samplings", run.samplings,
                [&](auto& one, auto& sampling) { describe_sampling(one, sampling, run.model); });
    fields.expressions("values", run.values);
    fields.field("value_names", run.value_names);
    if (fields.has("start", run.start.has_value())) {
        fields.follows(run.start, std::optional(StartFrom{}));
        fields.object("start", [&](auto& one) { describe_start(one, *run.start); });
    }
    if (fields.has("parameters", !run.parameters.empty()))
        fields.field("parameters", run.parameters);
    auto& simulation = run.simulation;
    fields.field("tolerance", simulation.tolerance);
    fields.field("order", simulation.order);
    fields.field("largest_step", simulation.largest_step);
    fields.field("step_limit", simulation.step_limit);
    fields.field("contacts_at_once", simulation.contacts_at_once);
    fields.field("touch", simulation.touch);
}

/// What an axis has from the model. @throws InputError when it is none, or has no values
void complete(Variation& axis, const Model& model, const SettingsReader& fields) {
    const auto parameter = model.find_independent_parameter(axis.name);
    const auto state = model.find_state(axis.name);
    if (!parameter && !state)
        fields.fail("vary", fmt::format("made of names that the model has, as '{}'", axis.name));
    if (parameter)
        axis.parameter = *parameter;
    else
        axis.state = *state;
    axis.unit = parameter ? model.parameters[*model.find_parameter(axis.name)].unit : model.states[*state].unit;
    const bool finite = std::all_of(axis.values.begin(), axis.values.end(), [](double x) { return std::isfinite(x); });
    if (!finite || (axis.values.empty() && !(axis.low < axis.high && (!axis.logarithmic || axis.low > 0))))
        fields.fail("vary", "made of finite values");
}

/// Units of values and monitors, which do not change numbers and so are no settings.
void take_units(StudyRun& run, const std::vector<std::string>& units) {
    const auto unit = [&](std::size_t value) { return value < units.size() ? units[value] : std::string(); };
    for (std::size_t v = 0; v < run.value_names.size(); ++v)
        run.value_units.push_back(run.is_branch() ? "" : unit(v));
    for (std::size_t m = 0; m < run.branch.settings.monitors.size(); ++m)
        run.branch.settings.monitors[m].unit = unit(m);
}

/// The same of runs that simulate nothing themselves. Texts of theirs become names, titles and units.
void check_measured(const StudyRun& run, const SettingsReader& fields) {
    const RecordRequest& request = run.record;
    std::vector<std::string> texts = run.sampling_names();
    for (const auto* names : {&run.value_names, &request.directions, &run.parameters, &run.identify.records})
        texts.insert(texts.end(), names->begin(), names->end());
    for (const RecordInput& input : request.inputs)
        texts.push_back(input.name);
    for (const std::string& text : texts)
        require_plain_line(text, "text of a run", run.place);
    if (run.kind == RunKind::record && run.value_names.size() != run.values.size())
        fields.fail("value_names", "a name for each value");
    if (!request.coordinate.empty() && !run.model.find_independent_parameter(request.coordinate))
        fields.fail("coordinate", "a parameter of the record");
    if (request.directions.empty() || request.directions.size() > 2)
        fields.fail("directions", "one or two");
    for (const RecordInput& input : request.inputs)
        if (input.direction >= request.directions.size())
            fields.fail("direction", "one of the run's");
    if (!request.bench)
        return;
    const RecordBench& bench = *request.bench;
    if (bench.levels.size() != bench.directions.size() || !bench.model.find_independent_parameter(bench.parameter) ||
        bench.repeats > 10'000 || !(bench.rate * bench.time >= 2) || !(bench.rate * bench.time <= most_bench_samples) ||
        !(bench.settle >= 0) || !std::isfinite(bench.settle) || !(bench.rate > 0))
        fields.fail("bench", "one that a study could ask for");
    for (const std::size_t direction : bench.directions)
        if (direction >= request.directions.size())
            fields.fail("direction", "one of the run's");
}

/// @throws InputError for what no study has, and what would be out of range
void check(const StudyRun& run, const SettingsReader& fields) {
    if (run.is_measured())
        return check_measured(run, fields);
    double points = static_cast<double>(std::max<std::size_t>(run.draws, 1));
    for (const Variation& axis : run.axes)
        points *= static_cast<double>(std::max<std::size_t>(axis.values.size(), 1));
    if (!(points <= most_points))
        fields.fail("vary", "something with less than a thousand million points");
    if (run.kind == RunKind::sweep && (run.axes.empty() || run.axes.front().values.empty()))
        fields.fail("vary", "something to sweep along");
    if (run.kind == RunKind::sweep)
        points /= static_cast<double>(run.axes.front().values.size());
    if (!(points <= most_chains))
        fields.fail("vary", "something with less than twenty million points that begin by themselves");
    if (run.value_names.size() != run.values.size())
        fields.fail("value_names", "a name for each value");
    for (const Sampling& sampling : run.samplings) {
        if (sampling.at == Sampling::At::section && !run.model.find_section(sampling.section))
            fields.fail("section", "one of the model's");
        for (const std::size_t event : sampling.events)
            if (event >= run.model.events.size())
                fields.fail("events", "some of the model's");
    }
    check_following_states(run, run.place);
    run.simulation.validate();
    if (run.kind == RunKind::simulate)
        run.transient.validate(run.model);
    else if (!run.is_branch())
        run.attractor.validate(run.model);
    else
        run.branch.validate(run.kind, run.model);
}

} // namespace

std::string settings_of(const StudyRun& run) {
    SettingsWriter fields;
    describe(fields, run);
    return fields.text();
}

StudyRun run_of(const AskedRun& asked, Model model) {
    StudyRun run;
    run.name = asked.name;
    run.place = stored_place(asked.file, fmt::format("settings of run '{}'", asked.name));
    run.model = std::move(model);
    const Json json = parse_json(asked.settings, run.place);
    const SettingsReader fields(json, &run.model, run.place);
    describe(fields, run);
    if (name_of(run.kind) != asked.kind)
        fields.fail("kind", "that of the run");
    for (Variation& axis : run.axes)
        complete(axis, run.model, fields);
    if (run.kind == RunKind::simulate)
        run.attractor.section = run.transient.section, run.attractor.bounds = run.transient.bounds;
    else
        run.transient.section = run.attractor.section, run.transient.bounds = run.attractor.bounds;
    run.branch.signature_place = run.place;
    if (run.start)
        run.start->place = run.place;
    run.parameters_place = run.identify.records_place = run.place;
    take_units(run, asked.units);
    check(run, fields);
    if (settings_of(run) != asked.settings) {
        if (asked.version != GRAZE_VERSION)
            throw InputError(run.place, "the stored settings say more than this version of graze knows",
                             fmt::format("use graze {}, which wrote them", asked.version));
        throw InputError(run.place, "the stored settings are not as they were written: they were changed afterwards",
                         "change the study file instead, and run it");
    }
    return run;
}

StudyRun stored_run(const RunRecord& record) {
    AskedRun asked{record.name, record.kind, record.settings, record.version, record.file, {}};
    for (const ResultColumn& value : record.values)
        asked.units.push_back(value.unit);
    StudyRun run = run_of(asked, stored_model(record));
    run.point_names = record.point_names;
    return run;
}

} // namespace graze
