#pragma once

#include "branch/orbit_condition.hpp"
#include "grazing/touch_geometry.hpp"
#include "orbit/shooting.hpp"

#include <memory>
#include <optional>

namespace graze {

/// The condition that an impact of vanishing speed at a touch does not change the minimum of the next pass: the first
/// projection of the map of the cycle is zero. Together with the touch it is of codimension two, and bounds the classes
/// of touches.
///
/// The value is exact; the gradient is a central difference in scaled unknowns, which only affects the speed of
/// Newton's method.
class SensitivityCondition final : public OrbitCondition {
public:
    /// @param equations by shooting, laid out for the orbit of the touch
    /// @return null where the touch has no square-root map
    static std::unique_ptr<OrbitCondition> of_touch(const OrbitEquations& equations, const OrbitEvaluation& at,
                                                    const SpecialPoint& touch);
    bool evaluate(const OrbitEquations& equations, const OrbitEvaluation& at) override;
    void renew(const OrbitEquations& equations, const OrbitEvaluation& at) override;

private:
    SensitivityCondition(const OrbitEquations& equations, const SpecialPoint& touch);
    std::optional<double> projection(const OrbitEquations& equations, const OrbitEvaluation& at) const;

    Shooting displaced_; ///< the same equations, for evaluations at displaced unknowns
    OrbitEvaluation tried_;
    std::size_t segment_, event_;
    double share_; ///< time of the touch, as a share of the segment's duration
    TouchFunctions functions_;
};

} // namespace graze
