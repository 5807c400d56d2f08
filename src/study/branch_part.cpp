#include "study/branch_part.hpp"

#include "study/point_limits.hpp"

#include <algorithm>
#include <cmath>

namespace graze {

void PointWriter::add(const std::string& part, const SpecialPoint& point, bool stable,
                      std::optional<TorusRecord> torus) {
    flush();
    waiting_ = OrbitRecord{0, part, "", stable, point, std::nullopt, std::move(torus)};
}

void PointWriter::end(const std::string& why) {
    if (!waiting_)
        return;
    SpecialPoint& point = waiting_->point;
    if (point.type == PointType::regular)
        point.type = PointType::end;
    if (!why.empty())
        point.detail += point.detail.empty() ? why : "; " + why;
    flush();
}

void PointWriter::flush() {
    if (!waiting_)
        return;
    OrbitRecord& record = *waiting_;
    record.number = report_->points++;
    if (record.point.type != PointType::regular) {
        record.label = point_label(record.point.type, ++counts_[record.point.type]);
        note_image(record);
    }
    if (run_->branch().touches)
        record.touch = findings_at(*run_, record.point);
    file_->with([&](ResultFile& results) {
        results.add_orbit(run_->name, record);
        ++report_->computed;
        if (options_->orbit)
            options_->orbit(run_->name, record);
    });
    waiting_.reset();
}

/// Notes in the detail of a point that it is the symmetric image of a point of an earlier part.
void PointWriter::note_image(OrbitRecord& record) {
    const auto alike = [](double one, double other) {
        return std::abs(one - other) <= same_point * std::max(std::abs(one), std::abs(other));
    };
    for (const OrbitRecord& other : image_of_.empty() ? std::vector<OrbitRecord>() : special_)
        if (other.part == image_of_ && other.point.type == record.point.type &&
            alike(other.point.parameter, record.point.parameter) &&
            alike(other.point.solution.orbit.period(), record.point.solution.orbit.period())) {
            std::string& detail = record.point.detail;
            detail = fmt::format("twin of {}{}{}", other.label, detail.empty() ? "" : "; ", detail);
            return;
        }
    if (image_of_.empty())
        special_.push_back(record);
}

namespace {

/// Returns the value of the parameter that varies; 0 along families, and if there is none.
double parameter_at(const StudyRun& run, const Orbit& orbit) {
    const BranchSettings& settings = run.branch().settings;
    const bool none = orbit.parameters.empty() || (settings.family && run.kind != RunKind::curve);
    return none ? 0 : orbit.parameters[settings.parameter.place()];
}

/// @param again an earlier part of the run has the same first point, which therefore ends neither of them
SpecialPoint regular_point(const BranchPoint& point, bool again) {
    SpecialPoint result;
    result.type = point.step == 0 && !again ? PointType::end : PointType::regular;
    result.detail = point.step == 0 ? "start" : "";
    result.solution = point.solution;
    result.solution.iterations = point.iterations;
    result.parameter = point.parameter;
    result.bracket = {not_a_number, not_a_number};
    result.arclength = point.arclength;
    result.step = point.step;
    result.tangent = point.tangent;
    result.monitors = point.monitors;
    return result;
}

/// The point that is stored where no branch can be begun.
SpecialPoint failed_start(const BranchPart& part, const StudyRun& run, const std::string& why) {
    SpecialPoint point;
    point.type = PointType::end;
    point.located = false;
    point.detail = "no start: " + why;
    point.solution.orbit = part.orbit;
    point.solution.certificate.admissible = false;
    point.solution.certificate.reason = "no orbit was found";
    point.parameter = parameter_at(run, part.orbit);
    point.bracket = {not_a_number, not_a_number};
    return point;
}

/// True when a curve has not left its point: it leads in the other direction, or nowhere.
bool stays_at_start(const BranchPart& part, const OrbitBranch& branch) {
    return part.kept && branch.point().step == 0 && branch.outcome() != BranchOutcome::bound;
}

} // namespace

SpecialPoint point_of_solution(const StudyRun& run, const System& system, OrbitSolution solution) {
    SpecialPoint point;
    point.type = PointType::end;
    point.solution = std::move(solution);
    point.detail = point.solution.detail;
    const Orbit& orbit = point.solution.orbit;
    const bool converged = point.solution.outcome == OrbitOutcome::converged;
    if (converged && !run.branch().settings.monitors.empty())
        point.monitors = at_place(run.place, run, [&] {
            const std::vector<Monitor>& monitors = run.branch().settings.monitors;
            std::vector<double> values =
                OrbitMonitors(system, orbit.signature, monitors, run.branch().settings.orbit.tolerance)(orbit);
            measure_multipliers(monitors, point.solution.multipliers, values);
            return values;
        });
    if (!converged) {
        point.located = false;
        point.solution.certificate.admissible = false;
        point.solution.certificate.reason = "no orbit was found";
    }
    point.parameter = parameter_at(run, orbit);
    point.bracket = {not_a_number, not_a_number};
    return point;
}

PartEnd follow_part(const StudyRun& run, const BranchSettings& of_run, const System& system, const BranchPart& part,
                    PointWriter& writer, const RunnerOptions& options) {
    BranchSettings settings = of_run;
    settings.direction = part.direction;
    settings.kept = part.kept;
    settings.kept_too = part.kept_too;
    OrbitBranch branch = at_place(run.place, run, [&] { return OrbitBranch(system, part.orbit, settings); });
    bool going = part.onto ? branch.start_along(part.onto->direction, part.onto->distance) : branch.start();
    if (!going) {
        if (!part.kept) {
            writer.add(part.name, failed_start(part, run, branch.detail()), false);
            writer.end("");
        }
        return {false, branch.outcome(), false, false, branch.detail(), std::nullopt};
    }
    bool last_is_special = false;
    std::optional<SpecialPoint> last;
    while (going) {
        for (const SpecialPoint& special : branch.found())
            writer.add(part.name, special, is_stable(special.solution));
        last_is_special = ends_at_point(branch.outcome()) && !branch.found().empty();
        last = ends_in_found(branch) ? std::optional(branch.found().back()) : std::nullopt;
        // What lies beyond an end that has been located does not belong to the branch.
        if (!last_is_special)
            writer.add(part.name, regular_point(branch.point(), part.again), branch.point().stable);
        if (options.interrupted && options.interrupted())
            return {true, BranchOutcome::no_start, true, true, "", std::nullopt};
        going = branch.step();
    }
    if (stays_at_start(part, branch)) {
        writer.drop();
        return {false, branch.outcome(), false, false, branch.detail(), std::nullopt};
    }
    const bool told = branch.outcome() != BranchOutcome::unphysical;
    std::string why = told && last_is_special ? "" : std::string(name_of(branch.outcome()));
    if (!why.empty() && !branch.detail().empty())
        why += ": " + branch.detail();
    writer.end(why);
    return {false, branch.outcome(), true, branch.point().step > 0, why, last};
}

} // namespace graze
