#include "study/torus_run.hpp"

#include "branch/bounds.hpp"
#include "graze/branch/torus_branch.hpp"

#include <fmt/format.h>

#include <string>
#include <utility>

namespace graze {

namespace {

/// What is known of a resonance that has no point of its own.
std::string locking_in_words(const PhaseLocking& locking, const std::string& parameter) {
    const auto at = [&] { return fmt::format(" at {} = {:.10g}", parameter, locking.parameter); };
    switch (locking.known) {
    case PhaseLocking::Width::bounded:
        return fmt::format("{} (locking narrower than {:.1e})", at(), locking.width);
    case PhaseLocking::Width::one_end:
        return fmt::format(" (locking{}, of which one end is known: {})", at(), locking.problem);
    case PhaseLocking::Width::unknown:
        return fmt::format(" (whether it locks was not found out: {})", locking.problem);
    case PhaseLocking::Width::located:
        break;
    }
    return "";
}

/// The resonances that a branch has passed since the last torus, in words.
std::string passed_in_words(const TorusPoint& torus, const std::string& parameter) {
    std::string text;
    for (const PhaseLocking& one : torus.passed)
        text += fmt::format("{}{}/{}{}{}", text.empty() ? "passed the rotation numbers " : ", ",
                            one.resonance.numerator, one.resonance.denominator,
                            one.resonance.is_strong() ? " (strong)" : "", locking_in_words(one, parameter));
    return text;
}

/// The point that is stored of a torus: one return on it, with what is known of all.
SpecialPoint point_of(const TorusPoint& torus, bool at_bound, const std::string& parameter) {
    SpecialPoint point;
    point.type = at_bound ? PointType::bound : torus.step == 0 ? PointType::end : PointType::regular;
    point.detail = passed_in_words(torus, parameter);
    if (torus.step == 0)
        point.detail = point.detail.empty() ? "start" : "start; " + point.detail;
    if (at_bound)
        point.detail =
            fmt::format("{} = {:.10g}{}{}", parameter, torus.parameter, point.detail.empty() ? "" : "; ", point.detail);
    OrbitSolution& solution = point.solution;
    solution.orbit = torus.motion;
    solution.outcome = OrbitOutcome::converged;
    solution.residual = torus.facts.defect;
    solution.iterations = torus.iterations;
    solution.certificate.approach_speeds = torus.facts.approach_speeds;
    point.parameter = torus.parameter;
    point.bracket = {not_a_number, not_a_number};
    point.arclength = torus.arclength;
    point.step = torus.step;
    point.monitors = torus.monitors;
    return point;
}

TorusRecord record_of(const TorusPoint& point) {
    const Torus& torus = point.torus;
    TorusRecord record{torus.rotation, torus.harmonics(), point.facts.tail, point.facts.growth, {}};
    for (std::size_t k = 0; k <= torus.harmonics(); ++k)
        for (std::size_t i = 0; i < torus.terms[0].size(); ++i)
            record.circle.push_back({k, i, torus.terms[k == 0 ? 0 : 2 * k - 1][i], k == 0 ? 0 : torus.terms[2 * k][i]});
    return record;
}

/// Adds the ends of the intervals in which tori lock, up to the bounds of the branch.
void add_lockings(const std::vector<PhaseLocking>& lockings, const TorusPoint& torus, const BranchSettings& settings,
                  PointWriter& writer) {
    for (const PhaseLocking& one : lockings)
        for (SpecialPoint end : one.ends) {
            if (is_outside(settings, end.parameter))
                continue;
            end.step = torus.step;
            end.arclength = torus.arclength;
            writer.add("tori", end, false);
        }
}

} // namespace

bool run_torus(const StudyRun& run, const System& system, const OrbitRecord& first, PointWriter& writer,
               const RunnerOptions& options) {
    const BranchRequest& branch = run.branch();
    TorusBranch tori = at_place(run.start->place, run,
                                [&] { return TorusBranch(system, first.point, branch.settings, branch.torus); });
    const std::string parameter = coordinate_name(branch.settings, run.model);
    bool going = tori.start();
    if (!going)
        throw InputError(run.start->place, fmt::format("run '{}': no tori were found: {}", run.name, tori.detail()),
                         "give another first step: step = { first = 1e-3 }, or begin at another torus point");
    while (going) {
        const TorusPoint& torus = tori.point();
        const bool at_bound = tori.outcome() == TorusOutcome::bound;
        add_lockings(torus.passed, torus, branch.settings, writer);
        writer.add("tori", point_of(torus, at_bound, parameter), torus.stable, record_of(torus));
        if (options.interrupted && options.interrupted())
            return false;
        going = tori.step();
    }
    std::string why = tori.outcome() == TorusOutcome::bound ? "" : std::string(name_of(tori.outcome()));
    if (!why.empty() && !tori.detail().empty())
        why += ": " + tori.detail();
    writer.end(why);
    add_lockings(tori.last_locking(), tori.point(), branch.settings, writer);
    writer.flush();
    return true;
}

} // namespace graze
