#include "base/linear_systems.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace graze::linear_systems_test {

constexpr double round_off = 1000 * std::numeric_limits<double>::epsilon();

/// A matrix that is well conditioned where it is square.
Eigen::MatrixXd wave_matrix(Eigen::Index rows, Eigen::Index columns) {
    return Eigen::MatrixXd::NullaryExpr(rows, columns, [](Eigen::Index i, Eigen::Index j) {
        return std::sin(static_cast<double>((i + 1) * (j + 2)) * 1.3) + (i == j ? 4 : 0);
    });
}

TEST(LinearSystems, RegularMatricesAreSolvedFromBothSides) {
    const Eigen::MatrixXd matrix = wave_matrix(5, 5), sides = wave_matrix(5, 2);
    const Eigen::VectorXd side = sides.col(0);
    const PartialLU partial(matrix);
    EXPECT_LE((matrix * partial.solve(side) - side).norm(), round_off);
    EXPECT_LE((matrix * partial.solve_columns(sides) - sides).norm(), round_off);
    EXPECT_LE((matrix.transpose() * partial.solve_transposed(side) - side).norm(), round_off);
    EXPECT_LE((matrix * partial.inverse() - Eigen::MatrixXd::Identity(5, 5)).norm(), round_off);
    const FullLU<double> full(matrix);
    EXPECT_LE((matrix * full.solve(side) - side).norm(), round_off);
    EXPECT_NEAR(full.determinant(), determinant(matrix), round_off * std::abs(determinant(matrix)));
    const Eigen::MatrixXcd turned = matrix * std::complex<double>(0.6, 0.8);
    EXPECT_LE((turned.transpose() * ComplexLU(turned).solve_transposed(side) - side).norm(), round_off);
    EXPECT_LE((turned * ComplexLU(turned).solve(side) - side).norm(), round_off);
    EXPECT_LE((turned * FullLU<std::complex<double>>(turned).solve(side) - side).norm(), round_off);
    EXPECT_EQ(determinant(Eigen::MatrixXd()), 1);
}

TEST(LinearSystems, SingularMatricesAreRecognised) {
    Eigen::MatrixXd matrix = wave_matrix(4, 4);
    EXPECT_TRUE(FullLU<double>(matrix).is_invertible());
    EXPECT_GT(FullLU<double>(matrix).reciprocal_condition(), 1e-3);
    matrix.row(3) = matrix.row(0) - matrix.row(1);
    FullLU<double> factors;
    factors.compute(matrix);
    EXPECT_FALSE(factors.is_invertible());
    EXPECT_EQ(factors.rank(), 3);
    const Eigen::Matrix2d nearly{{1, 0}, {0, 1e-9}};
    EXPECT_NEAR(FullLU<double>(nearly).reciprocal_condition(), 1e-9, 1e-20);
}

TEST(LinearSystems, LargeMatricesAreSolvedAndCheckedToo) {
    for (const Eigen::Index size : {6, 300}) {
        Eigen::MatrixXd matrix = wave_matrix(size, size);
        matrix.diagonal().array() += 100;
        const Eigen::VectorXd side = wave_matrix(size, 1);
        CheckedLU factors(matrix);
        EXPECT_TRUE(factors.is_invertible());
        EXPECT_LE((matrix * factors.solve(side) - side).norm(), round_off);
        matrix /= 100; // the determinant stays in range
        factors.compute(matrix);
        EXPECT_NEAR(factors.determinant() / determinant(matrix), 1, round_off);
        matrix.row(3) = matrix.row(0) - matrix.row(1);
        factors.compute(matrix);
        EXPECT_FALSE(factors.is_invertible());
    }
    EXPECT_NEAR(PartialLU(Eigen::Matrix2d{{1, 0}, {0, 1e-9}}).reciprocal_condition(), 1e-9, 1e-20);
}

TEST(LinearSystems, LeastSquaresResidualsAreOrthogonalToTheColumns) {
    const Eigen::MatrixXd matrix = wave_matrix(7, 3);
    const Eigen::VectorXd side = wave_matrix(7, 1);
    const PivotedQR pivoted(matrix);
    EXPECT_EQ(pivoted.rank(), 3);
    EXPECT_GE(std::abs(pivoted.pivot(0)), std::abs(pivoted.pivot(1)));
    const LeastSquares least = least_squares(matrix, side);
    for (const Eigen::VectorXd& solution : {pivoted.solve(side), Eigen::VectorXd(pivoted.solve_columns(side)),
                                            least.solution, shortest_solution(matrix, side)})
        EXPECT_LE((matrix.transpose() * (matrix * solution - side)).norm(), round_off * side.norm());
    const Eigen::MatrixXd squares = matrix.transpose() * matrix;
    EXPECT_LE((least.triangle.transpose() * least.triangle - squares).norm(), round_off * squares.norm());
    EXPECT_TRUE(least.triangle.isUpperTriangular(0));
    Eigen::MatrixXd changed = matrix;
    make_triangular(changed);
    const Eigen::MatrixXd triangle = changed.topRows(3).triangularView<Eigen::Upper>();
    EXPECT_LE((triangle - least.triangle).norm(), round_off * triangle.norm());
}

TEST(LinearSystems, ShortestSolutionLiesInTheRowSpace) {
    const Eigen::MatrixXd wide = wave_matrix(2, 4);
    const Eigen::VectorXd side = Eigen::Vector2d(1, -2), solution = shortest_solution(wide, side);
    EXPECT_LE((wide * solution - side).norm(), round_off);
    // The shortest solution is a combination of the rows.
    EXPECT_LE((wide.transpose() * PivotedQR(wide.transpose()).solve(solution) - solution).norm(), round_off);
    // Singular values below the threshold are not inverted.
    const Eigen::Matrix2d small{{1, 0}, {0, 1e-6}};
    EXPECT_NEAR(shortest_solution(small, Eigen::Vector2d(1, 1))[1], 1e6, 1);
    EXPECT_EQ(shortest_solution(small, Eigen::Vector2d(1, 1), 1e-3)[1], 0);
    EXPECT_EQ(PivotedQR(small, 1e-3).rank(), 1);
}

} // namespace graze::linear_systems_test
