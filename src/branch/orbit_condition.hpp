#pragma once

#include "graze/branch/special_point.hpp"
#include "orbit/orbit_equations.hpp"

#include <Eigen/Core>

#include <cstddef>
#include <optional>
#include <vector>

namespace graze {

/// A number that is zero where points at which a condition holds are of a more special kind, and changes its sign
/// there.
struct Degeneracy {
    PointType type = PointType::end;
    double value = 0; ///< NaN where it has no meaning
    double noise = 0; ///< up to which its sign says nothing, as it may be zero on whole curves
};

/// A number of an orbit as a function of the unknowns of its equations, with its exact gradient, that is zero where the
/// condition holds. One thing in many roles: a monitor that is held, the speed at which an event is to be met, what
/// vanishes at a special point and can be kept zero while another parameter varies (H. Dankowicz and F. Schilder,
/// "Recipes for Continuation", 2013, where monitor functions have this part).
class OrbitCondition {
public:
    virtual ~OrbitCondition() = default;

    /// Evaluates value and gradient. @return false where the number is not defined
    virtual bool evaluate(const OrbitEquations& equations, const OrbitEvaluation& at) = 0;
    /// Called at solutions on the way along a branch: what it was made from near an earlier one is taken from here,
    /// which changes neither where it is zero nor the sign of its value.
    virtual void renew(const OrbitEquations&, const OrbitEvaluation&) {}
    /// Moves it to another segment, as where the signature has changed: the same quantity there.
    virtual void set_segment(std::optional<std::size_t>) {}

    /// Of the points at which it holds, where it has been evaluated last: always as many, in the same order.
    virtual std::vector<Degeneracy> degeneracies(const OrbitEquations&, const OrbitEvaluation&) { return {}; }

    /// What there is too much; zero where the condition holds.
    double value() const { return value_; }
    /// With respect to all unknowns.
    const Eigen::RowVectorXd& gradient() const { return gradient_; }

protected:
    double value_ = 0;
    Eigen::RowVectorXd gradient_;
};

} // namespace graze
