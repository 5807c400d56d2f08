#include "branch/branch_point_problem.hpp"

#include "base/decompositions.hpp"
#include "base/linear_systems.hpp"
#include "branch/neutral_direction.hpp"
#include "orbit/eigen_index.hpp"

#include <Eigen/Core>

#include <algorithm>
#include <cmath>

namespace graze {

namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

} // namespace

/// Returns the scaled derivatives as a dense matrix. Rows of events keep the units of the current point.
MatrixXd BranchPointProblem::derivatives(const OrbitEvaluation& at) const {
    MatrixXd result = dense_derivatives(equations(), at);
    const Eigen::Index n = index(equations().layout().states());
    for (std::size_t k = 0; k < at.pieces.size(); ++k)
        result.row(index(k) * (n + 1)) *= at.pieces[k].condition_unit / evaluation().pieces[k].condition_unit;
    return result;
}

bool BranchPointProblem::evaluate(std::span<const double> u) {
    if (!OrbitProblem::evaluate(u)) {
        at_.clear();
        return false;
    }
    if (std::equal(u.begin(), u.end(), at_.begin(), at_.end()))
        return true;
    at_.clear();
    matrix_ = derivatives(evaluation());
    if (!matrix_.allFinite() || (border_.size() == 0 && !choose_borders()) || !solve_null_vectors() ||
        !differentiate(u))
        return false;
    at_.assign(u.begin(), u.end());
    return true;
}

/// Chooses borders from the nearly null left and right vectors of the matrix.
bool BranchPointProblem::choose_borders() {
    const NearlyNull near = nearly_null(matrix_.leftCols(matrix_.cols() - 1));
    right_ = near.right;
    border_ = near.left;
    return right_.allFinite() && border_.allFinite();
}

/// Computes the bordered null vectors and the two values that vanish at a branch point.
bool BranchPointProblem::solve_null_vectors() {
    const Eigen::Index rows = matrix_.rows(), columns = rows + 1;
    MatrixXd bordered = MatrixXd::Zero(rows + 2, rows + 2);
    bordered.topLeftCorner(rows, columns) = matrix_.leftCols(columns);
    bordered.topRightCorner(rows, 1) = border_;
    bordered.bottomLeftCorner(2, columns) = right_.transpose();
    const PartialLU lu(bordered);
    MatrixXd sides = MatrixXd::Zero(rows + 2, 2);
    sides.bottomRows(2).setIdentity();
    null_ = lu.solve_columns(sides).topRows(columns);
    VectorXd side = VectorXd::Zero(rows + 2);
    side[rows + 1] = 1;
    const VectorXd whole = lu.solve_transposed(side);
    left_ = whole.head(rows);
    values_ = {whole[rows], whole[rows + 1]};
    return null_.allFinite() && whole.allFinite();
}

bool BranchPointProblem::differentiate(std::span<const double> u) {
    constexpr double length = 1e-5; // scaled step of the differences: truncation and round-off errors of about 1e-10
    OrbitEvaluation there = equations().evaluation();
    const auto at = vector_of(u);
    const VectorXd units = evaluation().scales;
    gradients_.resize(2, matrix_.cols());
    for (Eigen::Index i = 0; i < 2; ++i) {
        const double step = length / null_.col(i).norm();
        VectorXd move = VectorXd::Zero(at.size());
        move.head(null_.rows()) = step * null_.col(i).cwiseProduct(units.head(null_.rows()));
        MatrixXd change = MatrixXd::Zero(matrix_.rows(), matrix_.cols());
        for (const double side : {1.0, -1.0}) {
            if (!equations().evaluate(at + side * move, there))
                return false;
            change += side * derivatives(there);
        }
        gradients_.row(i) = -left_.transpose() * change / (2 * step);
    }
    return gradients_.allFinite();
}

bool BranchPointProblem::solve(std::span<const double> row, double right, bool homogeneous, std::span<double> step,
                               double* determinant) {
    constexpr double converged = 1e-8, zero = 1e-8; // in units of the scales
    const Eigen::Index rows = matrix_.rows(), columns = matrix_.cols();
    const VectorXd units = evaluation().scales;
    MatrixXd whole = MatrixXd::Zero(rows + 3, rows + 3);
    whole.topLeftCorner(rows, columns) = matrix_;
    whole.topRightCorner(rows, 1) = border_;
    whole.block(rows, 0, 2, columns) = gradients_;
    whole.block(rows + 2, 0, 1, columns) = vector_of(row).cwiseProduct(units).transpose();
    VectorXd sides = VectorXd::Zero(rows + 3);
    if (!homogeneous) {
        sides.head(rows) = evaluation().system.right_hand_sides();
        sides[rows] = -values_[0];
        sides[rows + 1] = -values_[1];
    }
    sides[rows + 2] = right;
    const FullLU<double> lu(whole);
    if (!lu.is_invertible())
        return false;
    const VectorXd solution = lu.solve(sides);
    if (!solution.allFinite())
        return false;
    if (determinant)
        *determinant = 1; // not used as a test function on this curve
    const double beta = std::abs(solution[rows + 2]);
    broken_.clear();
    if (!homogeneous && beta > zero && solution.head(columns).cwiseAbs().maxCoeff() < converged) {
        broken_ = "the two branches separate there: no property of the model keeps them together";
        return false;
    }
    entries_of(step) = solution.head(columns).cwiseProduct(units);
    return true;
}

void BranchPointProblem::accept(std::span<const double> u) {
    OrbitProblem::accept(u);
    border_.resize(0);
    at_.clear();
}

} // namespace graze
