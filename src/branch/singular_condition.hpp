#pragma once

#include "branch/orbit_condition.hpp"
#include "orbit/cyclic_matrix.hpp"
#include "orbit/second_variation.hpp"

#include <Eigen/Core>

#include <complex>
#include <memory>

namespace graze {

/// Conditions on multipliers of an orbit, whose gradients have second derivatives of the flow in them.
///
/// They are made from the matrix of the equations by starts and durations, never from a product of saltation matrices:
/// the speed of a contact is not divided by, and nothing is singular where one is lost.
class MultiplierCondition : public OrbitCondition {
protected:
    /// Keeps the units of the equations there, so that the value is a smooth function.
    MultiplierCondition(const OrbitEquations& equations, const OrbitEvaluation& at);
    /// The matrix in these units. @param factor of its closing
    CyclicMatrix matrix(const OrbitEquations& equations, const OrbitEvaluation& at, double factor) const;
    /// What starts and durations gain along a vector in these units.
    Eigen::VectorXd in_units(const Eigen::VectorXd& right) const { return right.cwiseProduct(columns_); }
    /// Takes the units of the equations here from now on. @param right, left vectors in the old units, then in the new
    void renew_units(const OrbitEquations& equations, const OrbitEvaluation& at, Eigen::VectorXd& right,
                     Eigen::VectorXd& left);
    /// Derivatives of left^T A right for vectors in these units: one row for each left vector, by all unknowns.
    bool contract(const OrbitEquations& equations, const OrbitEvaluation& at, const Eigen::MatrixXd& left,
                  const Eigen::VectorXd& right, Eigen::MatrixXd& gradients);
    SecondVariation& variation() { return variation_; }

private:
    SecondVariation variation_;
    Eigen::VectorXd columns_, rows_; ///< units of starts and durations, and of the equations
};

/// A real multiplier is 1 or -1, as at a fold, at a flip, and where a symmetric orbit loses its symmetry: the matrix
/// with that closing is singular, and so is the number zero that borders it (Govaerts 2000).
class SingularCondition final : public MultiplierCondition {
public:
    /// @param at evaluation at an orbit near which the condition is to be used; @param multiplier 1 or -1
    /// @return none where the matrix is not finite
    static std::unique_ptr<OrbitCondition> of_multiplier(const OrbitEquations& equations, const OrbitEvaluation& at,
                                                         double multiplier);
    bool evaluate(const OrbitEquations& equations, const OrbitEvaluation& at) override;
    /// The null vectors here become the borders, which stay far from singular however long the branch is.
    void renew(const OrbitEquations& equations, const OrbitEvaluation& at) override;
    /// Of folds a cusp and the 1:1 resonance, of flips the generalised one and the 1:2 resonance.
    std::vector<Degeneracy> degeneracies(const OrbitEquations& equations, const OrbitEvaluation& at) override;

private:
    SingularCondition(const OrbitEquations& equations, const OrbitEvaluation& at, double multiplier);

    double multiplier_;
    Eigen::VectorXd right_, left_; ///< the borders
    /// Where it has been evaluated last: how the value changes along the null vector, zero where not even the second
    /// derivatives part the orbits; and with the multiplier, zero where that is not simple.
    double along_ = 0, simplicity_ = 0;
};

/// A pair of complex multipliers has the modulus 1, as where a torus leaves the orbit: the value is their product less
/// one. So it goes on smoothly where the pair becomes real at 1 or -1, beyond which nothing leaves the orbit.
class TorusCondition final : public MultiplierCondition {
public:
    /// Of the complex pair that is nearest to the unit circle, or of two multipliers that meet there, at 1 or at -1.
    /// @return none when there is none
    static std::unique_ptr<OrbitCondition> of_pair(const OrbitEquations& equations, const OrbitEvaluation& at);
    bool evaluate(const OrbitEquations& equations, const OrbitEvaluation& at) override;
    /// The pair is the one nearest to where it was here, not at a trial that has led nowhere.
    void renew(const OrbitEquations& equations, const OrbitEvaluation& at) override;
    /// Resonances 1:1 to 1:4, and the generalised torus.
    std::vector<Degeneracy> degeneracies(const OrbitEquations& equations, const OrbitEvaluation& at) override;

private:
    TorusCondition(const OrbitEquations& equations, const OrbitEvaluation& at, double sum, double product);

    double sum_, product_;           ///< of the pair where it has been evaluated last
    double kept_sum_, kept_product_; ///< and at the last solution
};

} // namespace graze
