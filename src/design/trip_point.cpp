#include "graze/design/trip_point.hpp"

#include "base/json_text.hpp"
#include "graze/base/input_errors.hpp"
#include "graze/base/with_place.hpp"
#include "graze/results/stored_orbit.hpp"
#include "graze/study/study_catalogue.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

namespace graze {

namespace {

constexpr const char *settled_run = "settled", *approach_run = "approach";

/// Generates a study of two runs: the orbit on which a motion settles, and its branch.
std::string own_study_text(const Design& design) {
    const Approach& approach = design.approach;
    const auto list = [](const ParameterValues& values) {
        std::string text;
        for (const auto& [name, value] : values)
            text += fmt::format("{}{} = {:.17g}", text.empty() ? "" : ", ", name, value);
        return "{ " + text + " }";
    };
    std::error_code error; // without a current folder the path stays relative
    const std::filesystem::path absolute = std::filesystem::absolute(design.model_path, error);
    const std::string path = design.model_path.ends_with(".toml") && !error ? absolute.string() : design.model_path;
    std::string text =
        fmt::format("name = {}\nmodel = {}\nset = {}\n", json_text(design.name), json_text(path), list(design.set));
    text += fmt::format("[runs.{}]\nkind = \"orbit\"\nset = {{ {} = {:.17g} }}\n", settled_run, design.control,
                        approach.least);
    if (!approach.from.empty())
        text += fmt::format("from = {}\n", list(approach.from));
    if (approach.cycles > 0)
        text += fmt::format("cycles = {}\n", approach.cycles);
    text += fmt::format("[runs.{}]\nkind = \"continue\"\nstart = {{ run = \"{}\" }}\n"
                        "along = {{ {} = [{:.17g}, {:.17g}] }}\n",
                        approach_run, settled_run, design.control, approach.least, approach.greatest);
    return text;
}

/// Names of a run and of those from which it starts, in order.
std::vector<std::string> way_to(const Study& study, const std::string& name) {
    std::vector<std::string> way;
    for (const StudyRun* run = study.find_run(name); run; run = run->start ? study.find_run(run->start->run) : nullptr)
        way.insert(way.begin(), run->name);
    return way;
}

/// Loads the study of the approach, with the parameters that the design sets.
Study named_study(const Design& design) {
    return with_place(design.approach.place, [&] { return load_study(design.approach.study, design.set); });
}

/// Whether a point is the trip point: the named one, or the first touch of the event (or of any).
bool is_wanted(const Design& design, const Model& model, const SpecialPoint& point, const std::string& label) {
    const Approach& approach = design.approach;
    if (!approach.point.empty())
        return label == approach.point;
    return point.type == PointType::grazing &&
           (approach.event.empty() || model.events[point.event].name == approach.event);
}

EarlierPoint earlier_of(const OrbitRecord& record, const std::string& run, ParameterId control) {
    const SpecialPoint& point = record.point;
    return {run,
            record.label,
            point.detail,
            point.type,
            point.solution.orbit.parameters[control.place()],
            kind_of(point.type).changes,
            point};
}

const SpecialPoint& with_condition(const SpecialPoint& point, const Place& place, const std::string& label) {
    if (!kind_of(point.type).may_be_kept)
        throw InputError(place,
                         fmt::format("nothing that could be held happens at {}, of type {} ({})", label,
                                     short_name(point.type), name_of(point.type)),
                         "choose a grazing (GR), a fold (SN), or another point whose curve could be followed");
    return point;
}

/// Checks the first device against all dimensions.
void require_first(const Design& design, const Orbit& orbit) {
    Mistakes mistakes;
    for (const DesignDimension& one : design.dimensions)
        mistakes.attempt([&] { one.require_first(orbit.parameters[one.parameter.place()]); });
    mistakes.throw_noted();
}

/// Side of a fold without orbits; its bracket lies on the other side.
int fold_side(const SpecialPoint& point) {
    const double middle = 0.5 * (point.bracket.first + point.bracket.second);
    return middle > point.parameter ? -1 : 1;
}

/// Reports a failed run. The text of a generated study is not a file, so its places are removed.
[[noreturn]] void refuse_run(const Design& design, const std::string& name, std::string failure) {
    const Approach& approach = design.approach;
    if (!approach.study.empty())
        throw InputError(approach.place, fmt::format("run '{}' failed: {}", name, failure), "look at the study's run");
    for (const std::string& start : {design.file + ":", fmt::format("run '{}'", name)})
        if (const std::size_t end = failure.find(": "); failure.starts_with(start) && end != std::string::npos)
            failure.erase(0, end + 2);
    throw InputError(approach.range_place,
                     name == settled_run ? fmt::format("at {} = {:g}, where the range begins, there is no orbit: {}",
                                                       design.control, approach.least, failure)
                                         : fmt::format("the branch of the approach cannot be followed: {}", failure),
                     "begin elsewhere, by `range` or `from`");
}

/// Contacts must begin at the touch as the control parameter rises; a motion that comes from beyond another touch may
/// have contacts that end there.
void require_onset(const Design& design, const TripPoint& trip) {
    if (!trip.is_touch() || class_at(trip).verdict.side >= 0)
        return;
    throw InputError(design.approach.range_place,
                     fmt::format("at {} = {:g}, where the range begins, the motion has contacts that end at {:.9g}, "
                                 "instead of beginning there",
                                 design.control, design.approach.least, trip.value()),
                     "begin the range where the motion touches nothing");
}

} // namespace

Study approach_study(const Design& design) {
    const bool own = design.approach.study.empty();
    Study study = own ? parse_study(own_study_text(design), design.file) : named_study(design);
    const std::vector<std::string> way = way_to(study, own ? approach_run : design.approach.run);
    std::erase_if(study.runs, [&](const StudyRun& run) { return std::ranges::find(way, run.name) == way.end(); });
    study.name = design.name;
    study.pictures.clear();
    study.tables.clear();
    return study;
}

TripPoint find_trip_point(const Design& design, const Study& study, const ResultFile& file) {
    const Approach& approach = design.approach;
    const std::string last = approach.run.empty() ? approach_run : approach.run;
    std::vector<EarlierPoint> earlier;
    for (const std::string& name : way_to(study, last)) {
        const StudyRun& planned = *study.find_run(name);
        const StoredRun run(file, name, approach.place);
        if (run.record.status == RunStatus::failed)
            refuse_run(design, name, run.record.failure);
        if (planned.kind != RunKind::follow && name != last)
            continue;
        // In a run from which the next one starts, only points before that start are passed.
        const auto next =
            std::ranges::find_if(study.runs, [&](const StudyRun& one) { return one.start && one.start->run == name; });
        const std::string leaves = name != last && next != study.runs.end() ? next->start->point : "";
        for (const std::string& label : run.special_labels()) {
            const OrbitRecord record = orbit_of_run(file, run.record, label, approach.place);
            if (name == last && is_wanted(design, run.model, record.point, label)) {
                require_first(design, record.point.solution.orbit);
                TripPoint trip{System(run.model),
                               with_condition(record.point, approach.place, label),
                               design.control_parameter,
                               name,
                               label,
                               std::move(earlier),
                               fold_side(record.point)};
                if (approach.study.empty())
                    require_onset(design, trip);
                return trip;
            }
            if (record.point.type != PointType::end)
                earlier.push_back(earlier_of(record, name, design.control_parameter));
            if (label == leaves)
                break;
        }
    }
    std::string passed;
    for (const EarlierPoint& one : earlier)
        passed += fmt::format("{}{} at {:.6g}", passed.empty() ? "" : ", ", one.label, one.value);
    throw InputError(approach.place,
                     fmt::format("the branch ended without {}; points before: {}",
                                 !approach.point.empty()  ? approach.point
                                 : approach.event.empty() ? "a touch"
                                                          : fmt::format("a touch of '{}'", approach.event),
                                 passed.empty() ? "nothing" : passed),
                     "widen the range, or choose another event or point");
}

std::string_view class_name(GrazingOutcome outcome) {
    return outcome == GrazingOutcome::lost ? "trips" : name_of(outcome);
}

TripPoint moved_to(const TripPoint& trip, const Orbit& orbit) {
    TripPoint moved = trip;
    moved.earlier.clear();
    moved.point.solution.orbit = orbit;
    moved.point.parameter = orbit.parameters[trip.control.place()];
    if (!trip.is_touch() || trip.point.at_end)
        return moved;
    // In the same segment, unless it has moved to another one.
    std::optional<OrbitTouch> touch;
    for (const OrbitTouch& one : touches_of(trip.system, orbit))
        if (one.event == trip.point.event && (!touch || one.segment == trip.point.segment))
            touch = one;
    if (touch) {
        moved.point.segment = touch->segment;
        moved.point.time = touch->time;
        moved.point.at_end = touch->at_end;
    }
    return moved;
}

TripClass class_at(const TripPoint& trip) {
    TripClass result;
    const SpecialPoint& point = trip.point;
    if (!trip.is_touch()) {
        const bool fold = point.type == PointType::fold;
        result.verdict.side = trip.fold_side;
        result.outcome = fold ? GrazingOutcome::folds : GrazingOutcome::undecided;
        result.reason = fold ? "the branch of orbits turns: nothing remains beyond"
                             : fmt::format("the motion beyond a {} is not determined", name_of(point.type));
        return result;
    }
    CycleMapOptions options;
    options.parameter = trip.control;
    result.map =
        cycle_map(trip.system, point.solution.orbit, {point.segment, point.event, point.time, point.at_end}, options);
    result.verdict = verdict_of(*result.map);
    result.outcome = result.verdict.outcome;
    result.reason = result.verdict.reason;
    return result;
}

} // namespace graze
