#include "branch/phase_locking.hpp"

#include "base/special_numbers.hpp"
#include "branch/resonances.hpp"
#include "orbit/newton.hpp"
#include "orbit/shooting.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace graze {

namespace {

/// Returns a torus between two of the same branch, whose angles 0 correspond to each other.
Torus interpolated(const Torus& from, const Torus& to, double share) {
    Torus torus = from;
    torus.rotation += share * (to.rotation - from.rotation);
    torus.terms.resize(std::max(from.terms.size(), to.terms.size()),
                       std::vector<double>(from.terms.front().size(), 0.0));
    for (std::size_t term = 0; term < torus.terms.size(); ++term)
        for (std::size_t i = 0; i < torus.terms[term].size(); ++i) {
            const double before = torus.terms[term][i], after = term < to.terms.size() ? to.terms[term][i] : 0;
            torus.terms[term][i] = before + share * (after - before);
        }
    return torus;
}

/// True for the torus of radius zero, with which a branch begins.
bool is_orbit(const Torus& torus) {
    return std::all_of(torus.terms.begin() + 1, torus.terms.end(), [](const std::vector<double>& term) {
        return std::ranges::all_of(term, [](double one) { return one == 0; });
    });
}

} // namespace

LockedCurveFinder LockingSearch::finder(const Torus& circle, const Resonance& resonance, double parameter) const {
    return {setting_, circle, resonance, parameter, settings_.continuation, settings_.orbit.tolerance};
}

std::vector<PhaseLocking> LockingSearch::between(const Torus& from, const Torus& to) const {
    constexpr double round_off = 1e-10; // of the rotation number at the torus point
    std::vector<PhaseLocking> found;
    const double first = parameter_of(from), last = parameter_of(to);
    for (const Resonance& one : resonances_between(from.rotation, to.rotation)) {
        // A resonance of the orbit itself is not passed by its tori.
        if (is_orbit(from) && std::abs(one.value() - from.rotation) < round_off)
            continue;
        const double share = (one.value() - from.rotation) / (to.rotation - from.rotation);
        found.push_back(examined(interpolated(from, to, share), one, first + share * (last - first), last - first));
    }
    return found;
}

/// @param step from one torus to the next, in the parameter
PhaseLocking LockingSearch::examined(const Torus& circle, const Resonance& resonance, double parameter,
                                     double step) const {
    constexpr double certain = 20;  // times the error of a parameter: wider intervals are found
    constexpr double farthest = 10; // steps
    LockedCurveFinder search = finder(circle, resonance, parameter);
    if (const auto spread = search.spread()) {
        const double width = spread->greatest - spread->least;
        if (width < certain * spread->error) {
            PhaseLocking narrow;
            narrow.resonance = resonance;
            narrow.known = PhaseLocking::Width::bounded;
            narrow.parameter = 0.5 * (spread->least + spread->greatest);
            // Five angles show four fifths of the width, or more.
            narrow.width = std::max(2 * width, certain * spread->round_off);
            return narrow;
        }
    }
    return described(search, search.follow(farthest * std::abs(step)), resonance, step < 0 ? -1 : 1);
}

PhaseLocking LockingSearch::described(LockedCurveFinder& finder, const LockedCurve& curve, const Resonance& resonance,
                                      int direction) const {
    PhaseLocking locking;
    locking.resonance = resonance;
    locking.problem = curve.problem;
    if (curve.points.empty())
        return locking;
    locking.parameter = curve.points.front().parameter;
    if (curve.extremes.empty())
        return locking;
    const auto [least, greatest] = std::ranges::minmax_element(curve.extremes, {}, &LockedPoint::parameter);
    // A curve that does not close has been seen in part, of which the extremes are folds, but may not be all.
    locking.known = curve.closed && least != greatest ? PhaseLocking::Width::located : PhaseLocking::Width::one_end;
    const bool located = locking.known == PhaseLocking::Width::located;
    locking.ends.push_back(end_of(finder, direction < 0 ? *greatest : *least));
    if (located) {
        locking.ends.push_back(end_of(finder, direction < 0 ? *least : *greatest));
        locking.width = greatest->parameter - least->parameter;
        locking.parameter = least->parameter + 0.5 * locking.width;
    }
    for (SpecialPoint& end : locking.ends) {
        if (located)
            end.bracket = {least->parameter, greatest->parameter};
        const std::string what =
            fmt::format("locking {}/{} {}, {}", resonance.numerator, resonance.denominator,
                        &end == &locking.ends.front() ? "begins" : "ends",
                        located ? fmt::format("from {:.10g} to {:.10g}, width {:.6g}", locking.ends.front().parameter,
                                              locking.ends.back().parameter, locking.width)
                                : "the other end was not found: " + locking.problem);
        end.detail = end.detail.empty() ? what : what + "; " + end.detail;
    }
    return locking;
}

/// The orbit at an end of an interval, as a point of a branch.
SpecialPoint LockingSearch::end_of(LockedCurveFinder& finder, const LockedPoint& fold) const {
    SpecialPoint point;
    point.type = PointType::locking;
    point.parameter = fold.parameter;
    point.bracket = {not_a_number, not_a_number};
    OrbitSolution& solution = point.solution;
    if (!finder.problem().evaluate(fold.u))
        return point;
    solution.orbit = finder.problem().orbit();
    join_drifts(simulation_, solution.orbit);
    Shooting shooting(simulation_, solution.orbit, {settings_.parameter});
    OrbitEvaluation at = shooting.evaluation();
    if (shooting.evaluate(shooting.unknowns_of(solution.orbit), at)) {
        solution.outcome = OrbitOutcome::converged;
        describe_orbit(shooting, at, solution, std::nullopt);
    }
    if (!solution.certificate.admissible)
        point.detail = "the model would not follow this orbit: " + solution.certificate.reason;
    OrbitMonitors monitors(simulation_.system(), solution.orbit.signature, settings_.monitors,
                           settings_.orbit.tolerance);
    point.monitors = monitors(solution.orbit);
    return point;
}

} // namespace graze
