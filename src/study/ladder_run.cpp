#include "study/ladder_run.hpp"

#include "graze/branch/chatter_limit.hpp"

#include <fmt/format.h>

#include <vector>

namespace graze {

namespace {

std::string name_of_rung(std::size_t number) {
    return fmt::format("rung {}", number);
}

void require_grazing(const StudyRun& run, const SpecialPoint& point) {
    if (point.type != PointType::grazing || point.at_end)
        throw InputError(run.start->place,
                         point.at_end ? "a ladder cannot begin where a contact loses its speed"
                                      : fmt::format("a ladder begins at a grazing, and the point is of type {} ({})",
                                                    short_name(point.type), name_of(point.type)),
                         "start from a point of type GR at which an arc touches an event's surface");
    const BranchSettings& settings = run.branch.settings;
    if ((settings.least && point.parameter < *settings.least) ||
        (settings.greatest && point.parameter > *settings.greatest))
        throw InputError(run.start->place,
                         fmt::format("the grazing from which the ladder starts, at {:.9g}, lies outside of its bounds",
                                     point.parameter),
                         "give wider bounds in `along`");
}

/// What is known of the limit, in words.
std::string told(const ChatterLimit& limit) {
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
SpecialPoint point_of(const ChatterLimit& limit, const SpecialPoint& last, const StudyRun& run) {
    const auto [value, error] = *limit.direct;
    SpecialPoint point = last;
    point.type = PointType::chatter;
    point.detail = told(limit);
    point.parameter = value;
    point.bracket = {value - error, value + error};
    point.solution = {};
    point.solution.orbit = limit.orbit;
    point.solution.outcome = OrbitOutcome::converged;
    point.solution.residual = limit.gap;
    point.solution.certificate.admissible = true;
    point.tangent = {};
    point.monitors.assign(run.branch.settings.monitors.size(), unknown_value);
    return point;
}

/// Why nothing is known of it.
SpecialPoint end_of(const SpecialPoint& last, const std::string& problem, const std::string& why) {
    SpecialPoint point = last;
    point.type = PointType::end;
    point.detail = "no limit: " + problem;
    if (!why.empty() && why != problem)
        point.detail += "; the ladder ends: " + why;
    return point;
}

} // namespace

bool run_ladder(const StudyRun& run, const System& system, const OrbitRecord& first, PointWriter& writer,
                const RunnerOptions& options) {
    require_grazing(run, first.point);
    BranchSettings settings = run.branch.settings;
    settings.stop_at = {PointType::grazing};
    std::vector<SpecialPoint> grazings{first.point};
    SpecialPoint begin = first.point;
    begin.monitors.resize(settings.monitors.size(), unknown_value);
    writer.add(name_of_rung(1), begin, first.stable);
    writer.end("");
    std::string why;
    while (grazings.size() < run.branch.rungs && why.empty()) {
        BranchPart part;
        part.name = name_of_rung(grazings.size() + 1);
        part.again = true; // its first point is none of its ends
        try {
            part.onto = branches_at(system, grazings.back(), settings).front();
        } catch (const InputError& error) {
            if (grazings.size() == 1)
                throw InputError(run.start->place, fmt::format("run '{}': {}", run.name, error.problem()),
                                 error.remedy());
            why = error.problem();
            break;
        }
        part.orbit = part.onto->orbit;
        const PartEnd end = follow_part(run, settings, system, part, writer, options);
        if (end.interrupted)
            return false;
        const bool next = end.last && end.last->type == PointType::grazing && !end.last->at_end &&
                          end.last->event == grazings.back().event;
        if (next)
            grazings.push_back(*end.last);
        else
            why = end.last ? std::string(name_of(end.last->type)) : end.why;
    }
    ChatterLimit limit;
    if (grazings.size() > 1)
        limit = at_place(run.start->place, run,
                         [&] { return chatter_limit(system, grazings, settings.parameter, settings.orbit.tolerance); });
    if (limit.direct)
        writer.add("limit", point_of(limit, grazings.back(), run), false);
    else if (!limit.problem.empty() || !why.empty())
        writer.add("limit", end_of(grazings.back(), limit.problem.empty() ? why : limit.problem, why), false);
    writer.end("");
    return true;
}

} // namespace graze
