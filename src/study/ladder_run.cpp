#include "study/ladder_run.hpp"

#include "graze/branch/ladder.hpp"

#include <fmt/format.h>

#include <string>
#include <vector>

namespace graze {

namespace {

std::string name_of_rung(std::size_t number) {
    return fmt::format("rung {}", number);
}

/// The limit in words.
std::string limit_in_words(const ChatterLimit& limit) {
    std::string text;
    if (limit.direct)
        text = fmt::format("+- {:.1e}; e = {:.6g}, ratio {:.6g}", limit.direct->second, limit.contacts.restitution,
                           limit.contacts.ratio);
    if (limit.extrapolated)
        text +=
            fmt::format("; from the grazings {:.12g} +- {:.1e}", limit.extrapolated->first, limit.extrapolated->second);
    return text;
}

/// The limit, as the last point of the ladder.
SpecialPoint point_of(const ChatterLimit& limit, const System& system, const SpecialPoint& last, const StudyRun& run) {
    const auto [value, error] = *limit.direct;
    SpecialPoint point = last;
    point.type = PointType::chatter;
    point.detail = limit_in_words(limit);
    point.parameter = value;
    point.bracket = {value - error, value + error};
    point.solution = {};
    point.solution.orbit = limit.orbit;
    point.solution.outcome = OrbitOutcome::converged;
    point.solution.residual = limit.gap;
    point.solution.certificate.admissible = true;
    point.tangent = {};
    point.monitors = monitors_of(system, limit.orbit, run);
    return point;
}

/// The last point of a ladder whose limit is not known, which says why.
SpecialPoint end_of(const SpecialPoint& last, const std::string& problem, const std::string& why) {
    SpecialPoint point = last;
    point.type = PointType::end;
    point.detail = "no limit: " + problem;
    if (!why.empty() && why != problem)
        point.detail += "; the ladder ends: " + why;
    return point;
}

} // namespace

std::vector<double> monitors_of(const System& system, const Orbit& orbit, const StudyRun& run) {
    const std::vector<Monitor>& monitors = run.branch().settings.monitors;
    try {
        return OrbitMonitors(system, orbit.signature, monitors, run.branch().settings.orbit.tolerance)(orbit);
    } catch (const InputError&) {
        return std::vector<double>(monitors.size(), not_a_number);
    }
}

bool run_ladder(const StudyRun& run, const System& system, const OrbitRecord& first, PointWriter& writer,
                const RunnerOptions& options) {
    Ladder ladder = at_place(run.start->place, run, [&] { return Ladder(system, first.point, run.branch().settings); });
    SpecialPoint begin = ladder.grazings().front();
    begin.monitors.assign(run.branch().settings.monitors.size(), not_a_number);
    writer.add(name_of_rung(1), begin, first.stable);
    writer.end("");
    const auto follow = [&](std::size_t number, const BranchStart& start) -> std::optional<RungEnd> {
        BranchPart part;
        part.name = name_of_rung(number);
        part.again = true; // its first point is none of its ends
        part.onto = start;
        part.orbit = start.orbit;
        const PartEnd end = follow_part(run, ladder.settings(), system, part, writer, options);
        return end.interrupted ? std::nullopt : std::optional(RungEnd{end.last, end.why});
    };
    if (!climb(ladder, run.branch().rungs, follow))
        return false;
    if (ladder.grazings().size() < 2)
        throw InputError(run.start->place, fmt::format("run '{}': no ladder begins there: {}", run.name, ladder.why()),
                         "choose another grazing, or wider bounds");
    const ChatterLimit limit = at_place(run.start->place, run, [&] { return ladder.limit(); });
    const SpecialPoint& last = ladder.grazings().back();
    writer.add("limit", limit.direct ? point_of(limit, system, last, run) : end_of(last, limit.problem, ladder.why()),
               false);
    writer.end("");
    return true;
}

} // namespace graze
