#include "study/torus_run.hpp"

#include "graze/branch/torus_branch.hpp"

#include <fmt/format.h>

#include <string>
#include <utility>

namespace graze {

namespace {

/// The resonances that a branch has passed since the last torus, in words.
std::string passed_in_words(const TorusPoint& torus) {
    std::string text;
    for (const Resonance& one : torus.passed)
        text += fmt::format("{}{}/{}{}", text.empty() ? "passed the rotation numbers " : ", ", one.numerator,
                            one.denominator, one.is_strong() ? " (strong)" : "");
    return text;
}

/// The point that is stored of a torus: one return on it, with what is known of all.
SpecialPoint point_of(const TorusPoint& torus, bool at_bound, const std::string& parameter) {
    SpecialPoint point;
    point.type = at_bound ? PointType::bound : torus.step == 0 ? PointType::end : PointType::regular;
    point.detail = torus.step == 0 ? "start" : passed_in_words(torus);
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
        writer.add("tori", point_of(torus, at_bound, parameter), torus.stable, record_of(torus));
        if (options.interrupted && options.interrupted())
            return false;
        going = tori.step();
    }
    std::string why = tori.outcome() == TorusOutcome::bound ? "" : std::string(name_of(tori.outcome()));
    if (!why.empty() && !tori.detail().empty())
        why += ": " + tori.detail();
    writer.end(why);
    return true;
}

} // namespace graze
