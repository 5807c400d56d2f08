#include "study/equilibrium_run.hpp"

#include "orbit/all_equilibria.hpp"
#include "orbit/solve_equilibrium.hpp"
#include "study/run_record.hpp"
#include "study/start_point.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <utility>

namespace graze {

namespace {

/// What a search has found in one mode, in words: whether there may be others.
std::string search_in_words(const EquilibriumSearch& search) {
    std::vector<std::string> words;
    const std::size_t count = search.found.size();
    if (!search.problem.empty())
        words.push_back(search.problem);
    else if (search.complete)
        words.push_back(fmt::format("in the box {}{}, by proof",
                                    count == 1 ? "is one equilibrium" : fmt::format("are {} equilibria", count),
                                    search.condition));
    if (search.complete && !search.undecided.empty())
        words.push_back(
            fmt::format("how many there are in {} further small boxes is not decided", search.undecided.size()));
    return fmt::format("{}", fmt::join(words, "; "));
}

/// Searches a mode and writes what is found. @return the search
EquilibriumSearch search_mode(const StudyRun& run, const System& system, std::size_t mode, const RunnerOptions& options,
                              PointWriter& writer) {
    const BranchRequest& branch = run.branch();
    EquilibriumSearch search = at_place(run.place, run, [&] {
        return all_equilibria(system, mode, branch.within, run.model.initial_state(), run.model.parameter_values(),
                              branch.settings.orbit, options.interrupted);
    });
    if (search.interrupted)
        return search;
    const std::string& name = run.model.modes[mode].name;
    for (const OrbitSolution& one : search.found)
        writer.add(name, point_of_solution(run, system, one), is_stable(one));
    for (const OrbitSolution& one : search.undecided) {
        if (one.outcome != OrbitOutcome::converged)
            continue; // perhaps there is none
        SpecialPoint point = point_of_solution(run, system, one);
        point.detail += std::string(point.detail.empty() ? "" : "; ") + "not proven to be the only one there";
        writer.add(name, point, is_stable(one));
    }
    writer.end(search_in_words(search));
    return search;
}

/// Searches the box in the modes that are asked for.
bool search_box(const StudyRun& run, const System& system, const RunnerOptions& options, RunReport& report,
                PointWriter& writer) {
    std::vector<std::string> problems;
    for (std::size_t mode = 0; mode < run.model.modes.size(); ++mode) {
        if (!run.branch().every_mode && mode != run.model.initial_mode)
            continue;
        const EquilibriumSearch search = search_mode(run, system, mode, options, writer);
        if (search.interrupted)
            return false;
        if (!search.problem.empty())
            problems.push_back(search.problem);
    }
    if (report.points > 0)
        return true;
    report.problem = problems.empty() ? "it is proven that there is no equilibrium in the box"
                                      : fmt::format("no equilibrium was found: {}", fmt::join(problems, "; "));
    report.remedy = "widen the box, or set other parameters";
    return true;
}

/// The state near which a run looks for an equilibrium: that of another run, or the initial one.
Orbit guess_of(const Study& study, const StudyRun& run, SharedFile& file) {
    if (!run.start)
        return orbit_of_rest(run.model.initial_mode, run.model.initial_state(), run.model.parameter_values());
    StartPoint start = file.with([&](const ResultFile& results) { return point_to_start_from(run, study, results); });
    return orbit_of_rest(start.point.result.mode, std::move(start.point.result.state), std::move(start.parameters));
}

} // namespace

bool run_equilibrium(const Study& study, const StudyRun& run, const System& system, SharedFile& file,
                     const RunnerOptions& options, RunReport& report, PointWriter& writer) {
    if (!run.branch().within.empty())
        return search_box(run, system, options, report, writer);
    const Orbit guess = guess_of(study, run, file);
    const OrbitSolution solution =
        at_place(run.place, run, [&] { return solve_orbit(system, guess, run.branch().settings.orbit); });
    writer.add(run.model.modes[guess.signature.front().mode].name, point_of_solution(run, system, solution),
               is_stable(solution));
    writer.end("");
    return true;
}

} // namespace graze
