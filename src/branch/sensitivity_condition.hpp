#pragma once

#include "branch/orbit_condition.hpp"
#include "grazing/touch_geometry.hpp"
#include "orbit/shooting.hpp"

#include <memory>
#include <optional>

namespace graze {

/// An impact of vanishing speed at a touch leaves the least value of the next pass as it is: the first projection of
/// the cycle's map is zero. With the touch itself held, this is a point of codimension two, the boundary between the
/// classes of touches.
///
/// The value is exact. Its gradient is by central differences, in the sizes of the unknowns: it only has to lead
/// Newton's method to where the value is zero, and what it is off by slows that by as little.
class SensitivityCondition final : public OrbitCondition {
public:
    /// @param equations by shooting, laid out for the orbit of the touch
    /// @return none where the touch has no square-root map
    static std::unique_ptr<OrbitCondition> of_touch(const OrbitEquations& equations, const OrbitEvaluation& at,
                                                    const SpecialPoint& touch);
    bool evaluate(const OrbitEquations& equations, const OrbitEvaluation& at) override;
    void renew(const OrbitEquations& equations, const OrbitEvaluation& at) override;

private:
    SensitivityCondition(const OrbitEquations& equations, const SpecialPoint& touch);
    std::optional<double> projection(const OrbitEquations& equations, const OrbitEvaluation& at) const;

    Shooting beside_; ///< the same equations, evaluated beside
    OrbitEvaluation tried_;
    std::size_t segment_, event_;
    double share_; ///< of the segment's duration, at which it touches
    TouchFunctions functions_;
};

} // namespace graze
