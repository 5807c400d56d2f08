#include "branch/sensitivity_condition.hpp"

#include "branch/point_kind.hpp"
#include "grazing/return_map.hpp"
#include "orbit/certify.hpp"
#include "orbit/eigen_index.hpp"

#include <cmath>

namespace graze {

SensitivityCondition::SensitivityCondition(const OrbitEquations& equations, const SpecialPoint& touch)
    : displaced_(equations.simulation(), touch.solution.orbit, equations.free()), tried_(displaced_.evaluation()),
      segment_(touch.segment), event_(touch.event), share_(touch.time / touch.solution.orbit.durations[touch.segment]),
      functions_(equations.system(), equations.signature()[touch.segment].mode, touch.event) {}

std::unique_ptr<OrbitCondition> SensitivityCondition::of_touch(const OrbitEquations& equations,
                                                               const OrbitEvaluation& at, const SpecialPoint& touch) {
    if (touch.at_end)
        return nullptr;
    std::unique_ptr<SensitivityCondition> condition(new SensitivityCondition(equations, touch));
    // False: the equations have another layout.
    const bool alike = condition->displaced_.unknowns() == equations.unknowns();
    return alike && condition->projection(equations, at) ? std::move(condition) : nullptr;
}

/// Returns the first projection. Off the touch it is that of the nearest touching state: any smooth extension of the
/// projection would do.
std::optional<double> SensitivityCondition::projection(const OrbitEquations& equations,
                                                       const OrbitEvaluation& at) const {
    const double duration = equations.orbit_of(at.unknowns).durations[segment_];
    const CycleMap map = cycle_map_of(equations, at, {segment_, event_, share_ * duration, false}, functions_,
                                      std::nullopt, AskedContacts::rigid_beside);
    if (!map.exists() || map.contact.order != MapOrder::square_root)
        return std::nullopt;
    const double value = map.projections(1).front();
    return std::isfinite(value) ? std::optional(value) : std::nullopt;
}

bool SensitivityCondition::evaluate(const OrbitEquations& equations, const OrbitEvaluation& at) {
    constexpr double step = 1e-5; // scaled step: round-off and truncation errors are both about 1e-9
    const auto here = projection(equations, at);
    if (!here)
        return false;
    value_ = *here;
    gradient_.resize(at.unknowns.size());
    for (Eigen::Index i = 0; i < at.unknowns.size(); ++i) {
        double change = 0, apart = 0;
        for (const int side : {-1, 1}) {
            Eigen::VectorXd unknowns = at.unknowns;
            unknowns[i] += side * step * at.scales[i];
            const auto there = displaced_.evaluate(unknowns, tried_) ? projection(displaced_, tried_) : std::nullopt;
            if (!there)
                return false;
            change += side * *there;
            apart += side * unknowns[i];
        }
        gradient_[i] = change / apart;
    }
    return gradient_.allFinite();
}

/// Updates the time of the touch.
void SensitivityCondition::renew(const OrbitEquations& equations, const OrbitEvaluation& at) {
    if (!displaced_.evaluate(at.unknowns, tried_))
        return;
    if (const auto touch = touch_in(certify(displaced_, tried_), segment_, event_))
        share_ = touch->time / equations.orbit_of(at.unknowns).durations[segment_];
}

} // namespace graze
