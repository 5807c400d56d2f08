#pragma once

#include "graze/branch/special_point.hpp"
#include "orbit/orbit_equations.hpp"

#include <Eigen/Core>

#include <cstddef>
#include <optional>
#include <vector>

namespace graze {

/// A test function along a curve of special points: it changes its sign where the points are degenerate (codimension
/// two).
struct Degeneracy {
    PointType type = PointType::end;
    double value = 0; ///< NaN where it is not defined
    double noise = 0; ///< magnitude up to which its sign is not significant, since it may vanish on whole curves
};

/// A scalar function of the unknowns of an orbit's equations, with its exact gradient, that is zero where the condition
/// holds. Conditions serve as fixed monitors, prescribed contact speeds, and conditions of special points that are held
/// while another parameter varies (H. Dankowicz and F. Schilder, "Recipes for Continuation", 2013, where they are
/// called monitor functions).
class OrbitCondition {
public:
    virtual ~OrbitCondition() = default;

    /// Evaluates value and gradient. @return false where the function is not defined
    virtual bool evaluate(const OrbitEquations& equations, const OrbitEvaluation& at) = 0;
    /// Called at solutions along a branch: updates auxiliary data, such as borders, from this solution. Neither the
    /// zeros nor the sign of the value change.
    virtual void renew(const OrbitEquations&, const OrbitEvaluation&) {}
    /// Moves the condition to another segment after a change of the signature.
    virtual void set_segment(std::optional<std::size_t>) {}

    /// Returns the degeneracies at the last evaluation, always the same number in the same order.
    /// @param only the single type that is needed: costly values of other types are then NaN
    virtual std::vector<Degeneracy> degeneracies(const OrbitEquations&, const OrbitEvaluation&,
                                                 [[maybe_unused]] std::optional<PointType> only = std::nullopt) {
        return {};
    }

    /// Value of the condition, zero where it holds.
    double value() const { return value_; }
    /// Gradient with respect to all unknowns.
    const Eigen::RowVectorXd& gradient() const { return gradient_; }

protected:
    double value_ = 0;
    Eigen::RowVectorXd gradient_;
};

} // namespace graze
