#pragma once

#include "branch/orbit_problem.hpp"

#include <Eigen/Core>

#include <array>
#include <span>
#include <string>
#include <vector>

namespace graze {

/// Equations of branch points of orbits in two parameters, for models whose symmetry is not declared. At a branch point
/// the derivatives of the equations F(u, p), with respect to the unknowns u and the first parameter p, have two null
/// vectors and a left one, w. Two conditions hold there, one too many for a curve: any small change of a model without
/// symmetry separates the two branches. The equations F + beta w = 0 with an unfolding parameter beta have such points
/// on a curve (W.-J. Beyn, A. Champneys, E. Doedel et al., "Numerical Continuation, and Computation of Normal Forms",
/// 2002), which are branch points of the model where beta is zero. Where beta is not zero, `solve` fails.
///
/// The two conditions are the last two components of the left null vector of the bordered derivatives; their gradients
/// are central differences of the derivatives along the null vectors. The matrices are dense, for orbits of moderate
/// size.
class BranchPointProblem : public OrbitProblem {
public:
    using OrbitProblem::OrbitProblem;

    bool evaluate(std::span<const double> u) override;
    bool solve(std::span<const double> row, double right, bool homogeneous, std::span<double> step,
               double* determinant) override;
    bool has_chords() const override { return false; }
    void accept(std::span<const double> u) override;
    std::string problem() const override { return broken_.empty() ? OrbitProblem::problem() : broken_; }

private:
    Eigen::MatrixXd derivatives(const OrbitEvaluation& at) const;
    bool choose_borders();
    bool solve_null_vectors();
    bool differentiate(std::span<const double> u);

    std::vector<double> at_;         ///< unknowns at which the conditions were evaluated
    Eigen::MatrixXd matrix_, right_; ///< derivatives there; two right border vectors
    Eigen::MatrixXd null_;           ///< two null vectors of the bordered matrix
    Eigen::VectorXd border_, left_;
    std::array<double, 2> values_{}; ///< values of the conditions
    Eigen::MatrixXd gradients_;      ///< gradients of the conditions, 2 x unknowns, scaled
    std::string broken_;             ///< message when no solution with beta = 0 exists; empty otherwise
};

} // namespace graze
