#include "graze/study/run_summary.hpp"

#include "graze/branch/special_point.hpp"
#include "graze/results/stored_run.hpp"
#include "graze/study/escape_rates.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>

namespace graze {

namespace {

/// How many points have which label, such as "periodic", or of branches of which type special points are, such as "GR".
LabelCounts label_counts(const StoredRun& run) {
    if (!run.record.is_branch())
        return run.label_counts();
    std::map<std::string, std::size_t> of_types;
    auto rows = run.rows({.columns = {"type", "located"}});
    while (rows.next())
        // An end that was not located is an orbit that was not found.
        if (const std::string type = rows.text(0); type == "EP" && rows.integer(1) == 0)
            ++of_types["not found"];
        else if (type != "RG" && type != "EP")
            ++of_types[type];
    return {of_types.begin(), of_types.end()};
}

/// What the first point says that ended as nobody wants, with what to do.
std::string first_remedy(const StoredRun& run, const LabelCounts& counts) {
    for (const Label label : {Label::failed, Label::chattering, Label::unsettled}) {
        const std::string name(name_of(label));
        if (std::none_of(counts.begin(), counts.end(), [&](const auto& one) { return one.first == name; }))
            continue;
        auto rows = run.rows({.columns = {"number", "label", "detail"}});
        while (rows.next())
            if (rows.text(1) == name && !rows.text(2).empty())
                return fmt::format("point {}: {}", rows.integer(0), rows.text(2));
        if (label == Label::unsettled)
            return "what has not settled may do so after more returns: raise `cycles`";
    }
    return "";
}

/// How the parts of a branch ended: what the last point of each says.
std::vector<std::pair<std::string, std::string>> ends_of(const StoredRun& run) {
    std::vector<std::pair<std::string, std::string>> ends; // parts in the order in which they ended
    if (!run.record.is_followed() && run.record.kind != name_of(RunKind::equilibrium))
        return ends;
    auto rows = run.rows({.columns = {"part", "detail", "label", "type"}});
    while (rows.next()) {
        std::erase_if(ends, [part = rows.text(0)](const auto& end) { return end.first == part; });
        if (run.record.kind == name_of(RunKind::ladder))
            ends.clear(); // each rung ends where the next begins
        const bool is_resonance = rows.text(3) == short_name(PointType::resonance_1) ||
                                  rows.text(3) == short_name(PointType::resonance_2); // beyond, a curve does not exist
        ends.emplace_back(rows.text(0), rows.text(1).empty() && is_resonance ? rows.text(2) : rows.text(1));
    }
    if (!run.record.is_followed()) // a single equilibrium has no end
        std::erase_if(ends, [](const auto& end) { return end.second.empty(); });
    const bool unfinished = run.record.status == RunStatus::unfinished; // of which only the last part can be
    for (std::size_t p = 0; p < ends.size(); ++p)
        if (ends[p].second.empty())
            ends[p].second = unfinished && p + 1 == ends.size() ? "interrupted; the same command begins the run again"
                                                                : "a point that was asked for";
    return ends;
}

/// "0.00051 +- 0.00007 per return after 400", of parameters at which a run has a law of escape.
std::string escapes_of(const StoredRun& run) {
    std::string text;
    const std::vector<EscapeRate> rates = escape_rates(run);
    for (const EscapeRate& rate : rates)
        text += fmt::format("{}{:.3g} +- {:.1g} per return after {}", text.empty() ? "" : ", ", rate.law.rate,
                            rate.law.error, rate.law.from);
    constexpr std::size_t most = 3; ///< that fit into a line
    return rates.size() > most ? "" : text;
}

} // namespace

RunSummary summary_of(const RunReport& report, const ResultFile& file) {
    if (report.outcome == RunOutcome::partial && !file.find_run(report.name))
        return {}; // it has not begun, since it needs all points of others
    const StoredRun run(file, report.name, {});
    RunSummary result{label_counts(run), report.problem, {}, ""};
    if (!report.problem.empty())
        return result;
    result.ends = ends_of(run);
    if (!run.record.is_branch()) {
        result.remedy = first_remedy(run, result.labels);
        result.escapes = escapes_of(run);
    }
    return result;
}

} // namespace graze
