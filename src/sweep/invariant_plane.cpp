#include "sweep/invariant_plane.hpp"

#include "base/decompositions.hpp"

#include <cmath>

namespace graze {

namespace {

/// Allowed distance of points from a common plane: larger than rounding, smaller than any disturbance.
constexpr double in_plane = 1e-9;

} // namespace

Eigen::MatrixXd normals_of_plane(const Eigen::MatrixXd& points, const Eigen::VectorXd& away) {
    const Eigen::Index count = points.rows(), size = points.cols();
    if (size == 0 || count < 2 * size + 2)
        return Eigen::MatrixXd(size, 0);
    Eigen::MatrixXd rows(count + 1, size);
    rows.topRows(count) = points.rowwise() - points.row(0);
    const double length = away.norm();
    rows.bottomRows(1).setZero();
    if (length > 0)
        rows.bottomRows(1) = away.transpose() / length * std::sqrt(static_cast<double>(count));
    if (!rows.allFinite())
        return Eigen::MatrixXd(size, 0);
    const SingularValues factors = singular_values(rows, SingularVectors::right);
    const double most = in_plane * std::sqrt(static_cast<double>(count));
    Eigen::Index normals = 0;
    while (normals < size && factors.values[size - 1 - normals] <= most)
        ++normals;
    return factors.right.rightCols(normals);
}

} // namespace graze
