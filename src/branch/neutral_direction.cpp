#include "branch/neutral_direction.hpp"

#include "base/decompositions.hpp"
#include "orbit/eigen_index.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

namespace graze {

Eigen::MatrixXd dense_derivatives(const OrbitEquations& equations, const OrbitEvaluation& at) {
    const OrbitLayout& layout = equations.layout();
    const auto n = index(layout.states());
    const std::size_t pieces = layout.pieces();
    Eigen::MatrixXd result = Eigen::MatrixXd::Zero(index(pieces) * (n + 1), index(layout.unknowns()));
    for (std::size_t k = 0; k < pieces; ++k) {
        const CyclicSystem::Block& block = at.system.block(k);
        const Eigen::Index row = index(k) * (n + 1);
        const std::size_t following = k + 1 < pieces ? k + 1 : 0;
        result.block(row, index(layout.start_of(k)), n + 1, n) += block.own.leftCols(n);
        result.block(row, index(layout.duration_of(k)), n + 1, 1) += block.own.rightCols(1);
        result.block(row, index(layout.start_of(following)), n + 1, n) += block.next;
        result.block(row, index(layout.parameter(0)), n + 1, block.parameters.cols()) += block.parameters;
    }
    return result;
}

NeutralDirections::NeutralDirections(const OrbitEquations& equations) {
    unchanged_.push_back(OrbitQuantity::of_monitor(equations, Monitor(), std::nullopt, 0)); // the period
    for (const ConservedQuantity& conserved : equations.model().conserved)
        unchanged_.push_back(
            OrbitQuantity::of_monitor(equations, monitor_of_conserved(equations.model(), conserved.name), 0, 0));
}

Eigen::MatrixXd NeutralDirections::operator()(const OrbitEquations& equations, const OrbitEvaluation& at,
                                              std::size_t most) {
    constexpr double zero = 1e-7; // share of the largest singular value
    Eigen::MatrixXd matrix = dense_derivatives(equations, at);
    for (OrbitQuantity& quantity : unchanged_) {
        if (!quantity.evaluate(equations, at))
            continue;
        const Eigen::RowVectorXd row = quantity.gradient().cwiseProduct(at.scales.transpose());
        if (!(row.norm() > 0))
            continue;
        matrix.conservativeResize(matrix.rows() + 1, matrix.cols());
        matrix.bottomRows(1) = row / row.norm();
    }
    if (!matrix.allFinite())
        return Eigen::MatrixXd(matrix.cols(), 0);
    const SingularValues all = singular_values(matrix, SingularVectors::right);
    const Eigen::Index null = matrix.cols() - all.rank(zero);
    return all.right.rightCols(std::min(null, index(most)));
}

bool NeutralDirection::evaluate(const OrbitEquations& equations, const OrbitEvaluation& at) {
    if (direction_.size() != at.unknowns.size())
        renew(equations, at);
    if (direction_.size() != at.unknowns.size())
        return false;
    gradient_ = direction_.cwiseQuotient(at.scales).transpose();
    value_ = gradient_.dot(at.unknowns - reference_);
    return std::isfinite(value_);
}

void NeutralDirection::renew(const OrbitEquations& equations, const OrbitEvaluation& at) {
    const Eigen::MatrixXd directions = find_(equations, at, count_);
    if (directions.cols() <= index(place_))
        return; // it is kept as it was
    // The nearest to the last one, so that the determinant of the equations keeps its sign.
    const Eigen::VectorXd before = direction_;
    direction_ = directions.col(index(place_));
    if (before.size() == direction_.size())
        if (const Eigen::VectorXd along = directions * (directions.transpose() * before); along.norm() > 0)
            direction_ = along / along.norm();
    reference_ = at.unknowns;
}

} // namespace graze
