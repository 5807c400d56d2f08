#pragma once

#include "branch/orbit_condition.hpp"
#include "orbit/cyclic_matrix.hpp"
#include "orbit/second_variation.hpp"

#include <Eigen/Core>

#include <complex>
#include <memory>
#include <optional>

namespace graze {

/// Conditions on multipliers of an orbit; their gradients involve second derivatives of the flow.
///
/// They use the matrix of derivatives of the equations with respect to starts and durations instead of a product of
/// saltation matrices. There is no division by the speed of a contact, and nothing is singular where the speed
/// vanishes.
class MultiplierCondition : public OrbitCondition {
protected:
    /// Stores the current units of the equations, so that the value is a smooth function of the orbit.
    MultiplierCondition(const OrbitEquations& equations, const OrbitEvaluation& at);
    /// Returns the matrix in these units. @param factor closing factor
    CyclicMatrix matrix(const OrbitEquations& equations, const OrbitEvaluation& at, double factor) const;
    /// Returns the starts and durations of a vector in these units.
    Eigen::VectorXd in_units(const Eigen::VectorXd& right) const { return right.cwiseProduct(columns_); }
    /// Changes to the current units of the equations. @param right, left vectors, converted to the new units
    void renew_units(const OrbitEquations& equations, const OrbitEvaluation& at, Eigen::VectorXd& right,
                     Eigen::VectorXd& left);
    /// Computes the derivatives of left^T A right for vectors in these units, with respect to all unknowns: one row for
    /// each left vector.
    bool contract(const OrbitEquations& equations, const OrbitEvaluation& at, const Eigen::MatrixXd& left,
                  const Eigen::VectorXd& right, Eigen::MatrixXd& gradients);
    SecondVariation& variation() { return variation_; }

private:
    SecondVariation variation_;
    Eigen::VectorXd columns_, rows_; ///< units of starts and durations, and of the equations
};

/// The condition that a real multiplier is 1 or -1, as at folds, flips and symmetry breakings: the matrix closed by it
/// is singular. The value is the bordering scalar, which then vanishes (Govaerts 2000).
class SingularCondition final : public MultiplierCondition {
public:
    /// @param at evaluation at a nearby orbit; @param multiplier 1 or -1
    /// @return null where the matrix is not finite
    static std::unique_ptr<OrbitCondition> of_multiplier(const OrbitEquations& equations, const OrbitEvaluation& at,
                                                         double multiplier);
    bool evaluate(const OrbitEquations& equations, const OrbitEvaluation& at) override;
    /// Takes the current null vectors as borders, so that the bordered matrix stays well-conditioned along the branch.
    void renew(const OrbitEquations& equations, const OrbitEvaluation& at) override;
    /// For folds, cusp and 1:1 resonance; for flips, generalised flip and 1:2 resonance.
    std::vector<Degeneracy> degeneracies(const OrbitEquations& equations, const OrbitEvaluation& at,
                                         std::optional<PointType> only = std::nullopt) override;

private:
    SingularCondition(const OrbitEquations& equations, const OrbitEvaluation& at, double multiplier);

    double multiplier_;
    Eigen::VectorXd right_, left_; ///< the borders
    /// At the last evaluation: derivative of the value along the null vector, zero at a cusp; and with respect to the
    /// multiplier, zero where the multiplier is not simple.
    double along_ = 0, simplicity_ = 0;
};

/// The condition that a complex pair of multipliers has modulus 1, as at a torus bifurcation. The value is their
/// product minus one, which is smooth also where the pair becomes real at 1 or -1 and the torus bifurcation ends.
class TorusCondition final : public MultiplierCondition {
public:
    /// Makes the condition for the complex pair nearest to the unit circle, or for two multipliers that meet at 1 or
    /// -1. @return null when there is no such pair
    static std::unique_ptr<OrbitCondition> of_pair(const OrbitEquations& equations, const OrbitEvaluation& at);
    bool evaluate(const OrbitEquations& equations, const OrbitEvaluation& at) override;
    /// From now on the pair is identified by its values at this solution, not at rejected trial points.
    void renew(const OrbitEquations& equations, const OrbitEvaluation& at) override;
    /// The resonances 1:1 to 1:4 and the generalised torus point.
    std::vector<Degeneracy> degeneracies(const OrbitEquations& equations, const OrbitEvaluation& at,
                                         std::optional<PointType> only = std::nullopt) override;

private:
    TorusCondition(const OrbitEquations& equations, const OrbitEvaluation& at, double sum, double product);

    double sum_, product_;           ///< sum and product of the pair at the last evaluation
    double kept_sum_, kept_product_; ///< the same at the last solution
};

} // namespace graze
