#pragma once

#include "branch/orbit_problem.hpp"

#include <Eigen/Core>

#include <array>
#include <span>
#include <string>
#include <vector>

namespace graze {

/// Branch points of orbits in two parameters, whose symmetry is not declared. At such a point the derivatives of the
/// equations F(u, p), with respect to the unknowns u and the first parameter p, have two null vectors and a left one,
/// w. Two conditions hold there, one too many for a curve: as any small change of a model without symmetry parts the
/// two branches. The equations F + beta w = 0 with an unfolding parameter beta have such points on a curve (W.-J. Beyn,
/// A. Champneys, E. Doedel et al., "Numerical Continuation, and Computation of Normal Forms", 2002), which are branch
/// points of the model where beta is zero. Elsewhere nothing is solved.
///
/// The two conditions are the two numbers that complete (w, the derivatives) in a bordered matrix; their gradients are
/// central differences of derivatives along the null vectors. Dense matrices: for orbits of moderate size.
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
    bool complete();
    bool differentiate(std::span<const double> u);

    std::vector<double> at_;         ///< where the conditions have been evaluated
    Eigen::MatrixXd matrix_, right_; ///< derivatives there; columns that border them, and null vectors
    Eigen::MatrixXd null_;           ///< both null vectors
    Eigen::VectorXd border_, left_;
    std::array<double, 2> values_{}; ///< of the conditions
    Eigen::MatrixXd gradients_;      ///< 2 x unknowns, in units of the scales
    std::string broken_;             ///< that nothing is solved with beta = 0
};

} // namespace graze
