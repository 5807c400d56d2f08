#include "branch/tongue_crossing.hpp"

#include "branch/bounds.hpp"
#include "branch/resonances.hpp"
#include "branch/torus_beyond.hpp"
#include "branch/torus_facts.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace graze {

/// Returns the resonances that the branch may have come to, those of few returns first: their tongues are wide.
std::vector<Resonance> TongueCrossing::ahead(double rotation, double turning) const {
    constexpr double farthest = 0.1; // in turns: a torus near a wide tongue may be that far from its rotation number
    constexpr double beside = 1e-3;  // where the rotation number hardly changes its direction is uncertain
    std::vector<Resonance> found =
        resonances_between(rotation - (turning > 0 ? beside : farthest), rotation + (turning < 0 ? beside : farthest));
    std::ranges::stable_sort(found, [&](const Resonance& one, const Resonance& other) {
        const auto key = [&](const Resonance& r) { return std::pair(r.denominator, std::abs(r.value() - rotation)); };
        return key(one) < key(other);
    });
    return found;
}

std::optional<CrossedTongue> TongueCrossing::cross(const Torus& from, const TorusProblem& equations, double turning,
                                                   double direction, const TorusForecast& forecast) const {
    std::optional<CrossedTongue> in_part; // the nearest tongue of which only the begin was found
    const auto distance = [&](const CrossedTongue& one) {
        return std::abs(one.locking.ends.front().parameter - search_.parameter_of(from));
    };
    for (const Resonance& resonance : ahead(from.rotation, turning)) {
        auto tongue = ahead_of(from, equations, direction, resonance, from);
        if (!tongue)
            if (const auto circle = forecast(resonance))
                tongue = ahead_of(from, equations, direction, resonance, *circle);
        if (tongue && tongue->locking.known == PhaseLocking::Width::located)
            return tongue;
        if (tongue && (!in_part || distance(*tongue) < distance(*in_part)))
            in_part = std::move(tongue);
    }
    return in_part;
}

/// The tongue of a resonance, if it lies ahead. @param circle from which its orbits are looked for
std::optional<CrossedTongue> TongueCrossing::ahead_of(const Torus& from, const TorusProblem& equations,
                                                      double direction, const Resonance& resonance,
                                                      const Torus& circle) const {
    constexpr double slack = 1e-3; // of the width: a torus at the very end
    const double parameter = search_.parameter_of(from), scale = equations.scales()[equations.parameter_place()],
                 range = settings_.least && settings_.greatest ? *settings_.greatest - *settings_.least
                                                               : std::max(scale, std::abs(parameter));
    LockedCurveFinder finder = search_.finder(circle, resonance, search_.parameter_of(circle));
    const LockedCurve curve = finder.follow(range);
    if (curve.extremes.empty())
        return std::nullopt;
    const double least = curve.least(), greatest = curve.greatest(), width = greatest - least,
                 ahead = 0.5 * (least + greatest) - parameter;
    if (std::abs(ahead) < (0.5 - slack) * width || ahead * direction < 0 ||
        is_outside(settings_, ahead < 0 ? greatest : least))
        return std::nullopt;
    CrossedTongue tongue;
    tongue.locking = search_.described(finder, curve, resonance, ahead < 0 ? -1 : 1);
    tongue.problem = tongue.locking.problem;
    if (tongue.locking.known == PhaseLocking::Width::located)
        leave(from, equations, curve, tongue);
    return tongue;
}

/// Looks for a torus beyond, as near to the tongue as the harmonics allow.
void TongueCrossing::leave(const Torus& from, const TorusProblem& equations, const LockedCurve& curve,
                           CrossedTongue& tongue) const {
    constexpr double reserve = 0.9; // share of the harmonics, of which the estimate knows only one wave
    const Resonance& resonance = tongue.locking.resonance;
    const double begin = tongue.locking.ends.front().parameter, end = tongue.locking.ends.back().parameter;
    tongue.problem = "no tori were found beyond";
    if (is_outside(settings_, end)) {
        tongue.problem = "up to the bound";
        return;
    }
    const auto most = static_cast<double>(resolution_.harmonics);
    for (const double share : {0.01, 0.02, 0.05, 0.1, 0.2, 0.35, 0.5, 0.75, 1.0, 1.5, 2.0, 3.0, 5.0, 8.0}) {
        const double parameter = end + share * (end - begin);
        if (is_outside(settings_, parameter))
            break;
        const double needed = harmonics_beyond(curve, resonance, parameter, resolution_.tail);
        if (needed > reserve * most && share < 8)
            continue;
        const std::size_t harmonics = std::max(static_cast<std::size_t>(std::clamp(needed, 3.0, most)),
                                               std::min(equations.harmonics(), resolution_.harmonics));
        for (const double across : {1.0, 0.5, 0.0}) {
            tongue.equations = std::make_shared<TorusProblem>(equations.setting(), harmonics);
            tongue.equations->set_parameter_scale(equations.scales()[equations.parameter_place()]);
            // Beyond the tongue the rotation number is beyond its own.
            if (solve(tongue, curve, parameter, across) &&
                (tongue.beyond.u[tongue.equations->rotation_place()] - resonance.value()) *
                        (from.rotation - resonance.value()) <=
                    0) {
                tongue.problem.clear();
                return;
            }
        }
    }
    tongue.equations = nullptr;
}

bool TongueCrossing::solve(CrossedTongue& tongue, const LockedCurve& curve, double parameter, double across) const {
    auto& equations = tongue.equations;
    auto guess = torus_beyond(*equations, curve, tongue.locking.resonance, parameter, across);
    const int direction = tongue.locking.ends.back().parameter > tongue.locking.ends.front().parameter ? 1 : -1;
    while (guess) {
        Continuation there(equations, settings_.continuation);
        equations->accept(*guess);
        if (!there.start(*guess, equations->parameter_place(), direction))
            return false;
        tongue.beyond = there.point();
        if (is_resolved(*equations, tongue.beyond.u, resolution_))
            return true;
        const std::size_t now = equations->harmonics(), more = std::min(now + now / 2, resolution_.harmonics);
        if (more == now)
            return false;
        auto finer = equations->with_harmonics(more);
        guess = finer->extended(tongue.beyond.u);
        equations = std::move(finer);
    }
    return false;
}

} // namespace graze
