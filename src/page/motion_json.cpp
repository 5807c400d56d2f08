#include "page/motion_json.hpp"

#include "graze/orbit/signature.hpp"
#include "graze/picture/motion_recorder.hpp"
#include "graze/results/name_advice.hpp"
#include "graze/results/orbit_motion.hpp"
#include "graze/results/quantity_evaluator.hpp"
#include "graze/results/stored_orbit.hpp"
#include "page/motion_rows.hpp"
#include "page/stored_point.hpp"
#include "page/time_limit.hpp"
#include "picture/picture_kinds.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace graze {

namespace {

constexpr std::size_t samples_of_orbit = 2000;
constexpr double most_seconds = 10; ///< a file may ask for a motion of any duration

/// The motion along the segments of an orbit. Contacts are the ends of segments at the events that pictures mark, and
/// the beginnings after them.
nlohmann::json orbit_motion_json(const StoredRun& run, const OrbitRecord& record,
                                 const std::vector<std::string>& names) {
    const Orbit orbit = whole_orbit(System(run.model), record.point.solution.orbit);
    const Model model = model_at(run.model, orbit);
    std::vector<NamedValue> columns = motion_columns(model, names);
    QuantityEvaluator evaluate(model, {columns.begin() + 1, columns.end()});
    DenseMotion motion;
    motion.values.resize(columns.size());
    motion.periods = {0};
    const std::vector<double> periods = model.periods();
    for (auto column = columns.begin() + 1; column != columns.end(); ++column) {
        const auto state = model.find_state(column->name);
        motion.periods.push_back(state ? periods[*state] : 0);
    }
    motion.outcome.ending = Ending::end_time;
    bool complete = true;
    const std::vector<bool> marked = usual_marks(model);
    const auto ends_at_contact = [&](const Segment& segment) {
        return ends_by_transition(segment) && marked.at(model.transitions.at(segment.index).event);
    };
    const std::vector<SegmentMotion> segments = orbit_motion(run.model, orbit, samples_of_orbit);
    for (std::size_t s = 0; s < segments.size(); ++s) {
        const std::size_t before = s > 0 ? s - 1 : segments.size() - 1, row = motion.values.front().size();
        if (s > 0)
            motion.begins.push_back(row);
        if (ends_at_contact(orbit.signature[before]))
            motion.impacts.push_back(row);
        motion.modes.push_back(segments[s].mode);
        for (std::size_t i = 0; i < segments[s].times.size(); ++i) {
            motion.values.front().push_back(segments[s].times[i]);
            const std::span<const double> values = evaluate(segments[s].states[i]);
            for (std::size_t v = 0; v < values.size(); ++v)
                motion.values[v + 1].push_back(values[v]);
        }
        if (ends_at_contact(orbit.signature[s]))
            motion.impacts.push_back(motion.values.front().size() - 1);
        motion.outcome.time = segments[s].times.empty() ? 0 : segments[s].times.back();
        if (complete && !segments[s].problem.empty()) {
            complete = false;
            motion.outcome.detail = fmt::format("segment {} ends early: {}", s + 1, segments[s].problem);
        }
    }
    nlohmann::json one = motion_rows_json(model, columns, std::move(motion), {.complete = complete});
    one["at_rest"] = is_rest(orbit.signature);
    return one;
}

/// The rows of a record, or what an estimate was found from: values of samples.
nlohmann::json record_motion_json(const StoredRun& run, const PointRecord& point, std::vector<std::string> names) {
    const std::vector<std::string> known = run.value_names(), rows = row_samplings(run);
    if (names.empty())
        names = known;
    std::vector<NamedValue> columns{{"t", run.model.time_unit, "time", {}}};
    std::vector<std::size_t> places;
    for (const std::string& name : names) {
        const auto found = std::find(known.begin(), known.end(), name);
        if (found == known.end())
            throw InputError({"names", 0, 0}, fmt::format("run '{}' has no value '{}'", run.record.name, name),
                             name_advice(name, known, "it has none"));
        columns.push_back({name, run.unit(name), words_of(run, name), {}});
        places.push_back(static_cast<std::size_t>(found - known.begin()));
    }
    DenseMotion motion;
    motion.values.resize(columns.size());
    motion.outcome.ending = Ending::end_time;
    const SampleSet& samples = point.result.samples;
    for (std::size_t s = 0; s < samples.size(); ++s) {
        const std::string sampling = name_at(run.record.samplings, samples.samplings[s]);
        if (!rows.empty() && std::find(rows.begin(), rows.end(), sampling) == rows.end())
            continue;
        motion.values[0].push_back(samples.times[s]);
        for (std::size_t v = 0; v < places.size(); ++v)
            motion.values[v + 1].push_back(samples.values.at(s * samples.width + places[v]));
    }
    motion.outcome.time = motion.values[0].empty() ? 0 : motion.values[0].back();
    return motion_rows_json(run.model, columns, std::move(motion), {});
}

nlohmann::json dense_motion_json(const StoredRun& run, const PointRecord& point, const std::vector<std::string>& names,
                                 const std::function<bool()>& interrupted) {
    const std::vector<NamedValue> columns = motion_columns(run.model, names, &run);
    DenseMotion motion = dense_motion(run, point, names_of(columns), {"names", 0, 0}, WhenLong::coarser,
                                      time_limit(most_seconds, interrupted));
    const bool complete = motion.outcome.ending != Ending::stopped && motion.start == 0;
    return motion_rows_json(run.model, columns, std::move(motion), {.complete = complete});
}

} // namespace

nlohmann::json motion_json(const StoredRun& run, std::size_t number, const std::vector<std::string>& names,
                           const std::function<bool()>& interrupted) {
    nlohmann::json one = run.record.is_branch() ? orbit_motion_json(run, orbit_numbered(run, number), names)
                         : is_measured_run(run.record)
                             ? record_motion_json(run, point_numbered(run, number), names)
                             : dense_motion_json(run, point_numbered(run, number), names, interrupted);
    one["run"] = run.record.name;
    one["number"] = number;
    return one;
}

nlohmann::json motion_json(const ResultFile& file, const std::string& run, std::size_t number,
                           const std::vector<std::string>& names, const std::function<bool()>& interrupted) {
    return motion_json(StoredRun(file, run, {}), number, names, interrupted);
}

} // namespace graze
