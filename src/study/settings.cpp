#include "graze/base/file_name.hpp"
#include "graze/base/require.hpp"
#include "graze/base/text_file.hpp"
#include "graze/results/result_file.hpp"
#include "graze/study/stored_study.hpp"
#include "study/run_description.hpp"
#include "study/run_record.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace graze {

std::vector<std::string> short_names_of_points(bool PointKind::*which) {
    std::vector<std::string> names;
    for (const PointKind& kind : point_kinds())
        if (!which || kind.*which)
            names.emplace_back(kind.short_name);
    return names;
}

std::string text_of_table(const BranchRequest& branch) {
    if (!branch.table_text.empty() || branch.table.empty())
        return branch.table_text;
    try {
        return read_text_file(branch.table, "table of an orbit", longest_table);
    } catch (const InputError&) {
        return "";
    }
}

MotionRequest motion_of_branch(const BranchRequest& branch) {
    MotionRequest motion;
    if (!branch.attractor.section.empty()) {
        Sampling& sampling = motion.samplings.emplace_back();
        sampling.name = sampling.section = branch.attractor.section;
    }
    return motion;
}

namespace {

/// Sets what an axis takes from the model. @throws InputError for an unknown name, and without values
void complete_axis(Variation& axis, const Model& model, const SettingsReader& fields) {
    const auto parameter = model.find_independent_parameter(axis.name);
    const auto state = model.find_state(axis.name);
    if (!parameter && !state)
        fields.fail("vary", fmt::format("made of names that the model has, as '{}'", axis.name));
    if (parameter)
        axis.parameter = *parameter;
    else
        axis.state = *state;
    axis.unit = parameter ? model.parameter_unit(axis.name) : model.states[*state].unit;
    const bool finite = std::all_of(axis.values.begin(), axis.values.end(), [](double x) { return std::isfinite(x); });
    if (!finite || (axis.values.empty() && !(axis.low < axis.high && (!axis.logarithmic || axis.low > 0))))
        fields.fail("vary", "made of finite values");
}

void complete_stored(StudyRun& run, const SettingsReader& fields) {
    MotionRequest& motion = run.motion();
    for (Variation& axis : motion.axes)
        complete_axis(axis, run.model, fields);
    if (!seeks_attractors(run.kind))
        motion.attractor.section = motion.transient.section, motion.attractor.bounds = motion.transient.bounds;
    else
        motion.transient.section = motion.attractor.section, motion.transient.bounds = motion.attractor.bounds;
}

/// Sets units of values and monitors, which are not stored as settings since they do not influence results.
void take_units(StudyRun& run, const std::vector<std::string>& units) {
    const auto unit = [&](std::size_t value) { return value < units.size() ? units[value] : std::string(); };
    for (std::size_t v = 0; v < run.value_names.size(); ++v)
        run.value_units.push_back(run.is_branch() ? "" : unit(v));
    if (!run.is_branch())
        return;
    std::vector<Monitor>& monitors = run.branch().settings.monitors;
    for (std::size_t m = 0; m < monitors.size(); ++m)
        monitors[m].unit = unit(m);
}

void check_record(const StudyRun& run, const SettingsReader& fields) {
    const RecordRequest& request = run.record();
    std::vector<std::string> samplings = run.sampling_names(), inputs;
    for (const RecordInput& input : request.inputs)
        inputs.push_back(input.name);
    require_lines({&samplings, &run.value_names, &request.directions, &inputs}, "text of a run", run.place);
    if (run.value_names.size() != run.values.size())
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

void check_atlas(const StudyRun& run, const SettingsReader& fields) {
    const MotionRequest& motion = run.motion();
    if (motion.axes.size() > most_axes_of_atlas || motion.draws > 0 ||
        !std::ranges::all_of(motion.axes, [](const Variation& axis) { return why_no_axis_of_atlas(axis).empty(); }))
        fields.fail("vary", "one or two parameters with values in their order");
    for (const AtlasStart& start : motion.atlas.starts)
        if (!run.model.find_state(start.state) || !(start.low < start.high) || !std::isfinite(start.high - start.low))
            fields.fail("starts", "ranges of states");
}

/// @throws InputError for settings that no study can have
void check_run(const StudyRun& run, const SettingsReader& fields) {
    if (run.kind == RunKind::identify)
        return require_lines({&run.value_names, &run.parameters, &run.identify().records}, "text of a run", run.place);
    if (run.kind == RunKind::record)
        return check_record(run, fields);
    if (run.value_names.size() != run.values.size())
        fields.fail("value_names", "a name for each value");
    if (run.is_branch()) {
        run.branch().simulation.validate();
        return run.branch().validate(run.kind, run.model);
    }
    const MotionRequest& motion = run.motion();
    if (!(motion.points() <= most_points))
        fields.fail("vary", "something with less than a thousand million points");
    if (run.is_swept() && (motion.axes.empty() || motion.axes.front().values.empty()))
        fields.fail("vary", "something to sweep along");
    if (run.kind == RunKind::atlas)
        check_atlas(run, fields);
    if (!(motion.rows(run.kind) <= most_rows))
        fields.fail("vary", "something with less than twenty million points that begin by themselves");
    for (const Sampling& sampling : motion.samplings) {
        if (sampling.at == Sampling::At::section && !run.model.find_section(sampling.section))
            fields.fail("section", "one of the model's");
        for (const std::size_t event : sampling.events)
            if (event >= run.model.events.size())
                fields.fail("events", "some of the model's");
    }
    check_following_states(run, run.place);
    motion.simulation.validate();
    if (!seeks_attractors(run.kind))
        motion.transient.validate(run.model);
    else
        motion.attractor.validate(run.model);
}

} // namespace

std::string settings_of(const StudyRun& run) {
    SettingsWriter fields;
    describe(fields, run);
    return fields.text();
}

namespace {

/// Whether settings say the same: texts may be the same expressions in another order.
bool say_the_same(const Json& one, const Json& other, const Model& model) {
    if (one.kind != other.kind || one.truth != other.truth || one.names != other.names ||
        one.items.size() != other.items.size())
        return false;
    if (one.text != other.text && !(one.kind == Json::Kind::text && are_same_expression(model, one.text, other.text)))
        return false;
    for (std::size_t i = 0; i < one.items.size(); ++i)
        if (!say_the_same(one.items[i], other.items[i], model))
            return false;
    return true;
}

} // namespace

StudyRun run_of(const AskedRun& asked, Model model) {
    StudyRun run;
    run.name = asked.name;
    run.place = stored_place(asked.file, fmt::format("settings of run '{}'", asked.name));
    run.model = std::move(model);
    const Json json = parse_json(asked.settings, run.place);
    SettingsReader fields(json, &run.model, run.place);
    describe(fields, run);
    if (name_of(run.kind) != asked.kind)
        fields.fail("kind", "that of the run");
    if (run.has_motions())
        complete_stored(run, fields);
    if (run.is_branch())
        run.branch().signature_place = run.place;
    if (run.kind == RunKind::identify)
        run.identify().records_place = run.place;
    if (run.start)
        run.start->place = run.place;
    run.parameters_place = run.place;
    take_units(run, asked.units);
    check_run(run, fields);
    if (const std::string again = settings_of(run);
        again != asked.settings && !say_the_same(parse_json(again, run.place), json, run.model)) {
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
