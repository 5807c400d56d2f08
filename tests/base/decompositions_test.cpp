#include "base/decompositions.hpp"

#include <Eigen/Dense>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

namespace graze {
namespace {

constexpr double eps = std::numeric_limits<double>::epsilon();

/// Rows and columns of every shape, full and of lower rank, with entries between -1 and 1.
std::vector<Eigen::MatrixXd> matrices(Eigen::Index rows, Eigen::Index columns) {
    std::vector<Eigen::MatrixXd> result;
    for (int k = 1; k < 6; ++k)
        result.emplace_back(Eigen::MatrixXd::NullaryExpr(rows, columns, [&](Eigen::Index i, Eigen::Index j) {
            return std::sin(static_cast<double>(k * (i + 1)) * 1.7 + static_cast<double>((j + 2) * (j + k)) * 0.9);
        }));
    result.emplace_back(Eigen::MatrixXd::Ones(rows, columns));
    return result;
}

TEST(Decompositions, singular_values_put_the_matrix_together_again) {
    for (const auto& [rows, columns] : {std::pair{4, 4}, {6, 3}, {3, 6}, {1, 1}})
        for (const Eigen::MatrixXd& matrix : matrices(rows, columns)) {
            const SingularValues thin = singular_values(matrix, SingularVectors::thin);
            const double size = matrix.norm();
            EXPECT_LE((thin.left * thin.values.asDiagonal() * thin.right.transpose() - matrix).norm(), 50 * eps * size);
            const SingularValues full = singular_values(matrix, SingularVectors::full);
            EXPECT_EQ(full.left.cols(), rows);
            EXPECT_EQ(full.right.cols(), columns);
            const Eigen::VectorXd values = singular_values(matrix, SingularVectors::none).values;
            EXPECT_LE((full.values - values).norm(), 50 * eps * size);
            const Eigen::MatrixXd right = singular_values(matrix, SingularVectors::right).right;
            EXPECT_EQ(right.cols(), columns);
            EXPECT_LE((right * right.transpose() - Eigen::MatrixXd::Identity(columns, columns)).norm(), 50 * eps);
            EXPECT_LE((singular_values(Eigen::MatrixXcd(matrix)) - full.values).norm(), 50 * eps * size);
            EXPECT_EQ(full.rank(1e-9), Eigen::FullPivLU<Eigen::MatrixXd>(matrix).setThreshold(1e-9).rank());
        }
    EXPECT_EQ(singular_values(Eigen::MatrixXd(), SingularVectors::none).rank(1e-9), 0);
    EXPECT_EQ(eigenvalues(Eigen::MatrixXd())->size(), 0);
    EXPECT_EQ(eigensystem(Eigen::MatrixXd())->values.size(), 0);
    EXPECT_EQ(singular_values(Eigen::MatrixXd::Zero(2, 2), SingularVectors::none).rank(1e-9), 0);
}

TEST(Decompositions, large_matrices_are_divided) {
    for (const Eigen::MatrixXd& matrix : matrices(40, 41)) {
        const SingularValues divided = singular_values_of_large(matrix);
        const Eigen::MatrixXd together =
            divided.left * divided.values.asDiagonal() * divided.right.leftCols(40).transpose();
        EXPECT_LE((together - matrix).norm(), 200 * eps * matrix.norm());
        EXPECT_LE((matrix * divided.right.rightCols(1)).norm(), 200 * eps * matrix.norm());
        EXPECT_LE((divided.values - singular_values(matrix, SingularVectors::none).values).norm(),
                  200 * eps * matrix.norm());
    }
}

TEST(Decompositions, null_vectors_are_taken_to_zero) {
    for (Eigen::MatrixXd matrix : matrices(4, 4)) {
        matrix.row(3) = matrix.row(0) - matrix.row(1);
        const Eigen::MatrixXcd turned = matrix * std::complex<double>(0.6, 0.8);
        const Eigen::VectorXcd vector = null_vector(turned);
        EXPECT_NEAR(vector.norm(), 1, 10 * eps);
        EXPECT_LE((turned * vector).norm(), 50 * eps * matrix.norm());
    }
}

TEST(Decompositions, eigenvalues_are_zeros_of_the_characteristic_polynomial) {
    for (const Eigen::MatrixXd& matrix : matrices(2, 2)) {
        const std::complex<double> half = matrix.trace() / 2, root = std::sqrt(half * half - matrix.determinant());
        const auto found = eigensystem(matrix);
        ASSERT_TRUE(found);
        EXPECT_LE((found->values - *eigenvalues(matrix)).norm(), 50 * eps);
        for (const std::complex<double> known : {half + root, half - root})
            EXPECT_LE((found->values.array() - known).abs().minCoeff(), 1e-7)
                << "square roots of round-off, where equal";
        EXPECT_LE((matrix * found->vectors - found->vectors * found->values.asDiagonal()).norm(), 50 * eps);
        // The same numbers as solutions of a shifted problem: det(a - mu b) with a = A B and the eigenvalues of A.
        const Eigen::Matrix2d other{{2, 1}, {0.5, 3}};
        const auto general = generalized_eigenvalues(matrix * other, other);
        ASSERT_TRUE(general);
        for (Eigen::Index i = 0; i < 2; ++i)
            EXPECT_LE((found->values.array() - general->numerators[i] / general->denominators[i]).abs().minCoeff(),
                      1e-7);
    }
}

TEST(Decompositions, eigenvalues_of_symmetric_matrices_rise_and_are_squares_of_singular_values) {
    for (const Eigen::MatrixXd& matrix : matrices(6, 3)) {
        const auto found = symmetric_eigenvalues(matrix.transpose() * matrix);
        ASSERT_TRUE(found);
        const Eigen::VectorXd sizes = singular_values(matrix, SingularVectors::none).values;
        EXPECT_LE((found->reverse() - sizes.cwiseAbs2()).norm(), 50 * eps * matrix.squaredNorm());
    }
}

TEST(Decompositions, generalized_eigenvalues_may_be_infinite) {
    const Eigen::Matrix2d a{{3, 0}, {0, 1}}, b{{1, 0}, {0, 0}};
    const auto found = generalized_eigenvalues(a, b);
    ASSERT_TRUE(found);
    const Eigen::Index finite = found->denominators[0] != 0 ? 0 : 1;
    EXPECT_EQ(found->numerators[finite] / found->denominators[finite], 3.0);
    EXPECT_EQ(found->denominators[1 - finite], 0);
}

TEST(Decompositions, schur_and_orthogonal_factors_put_the_matrix_together_again) {
    for (const Eigen::MatrixXd& matrix : matrices(5, 5)) {
        const auto schur = schur_form(matrix);
        ASSERT_TRUE(schur);
        const double size = matrix.norm();
        EXPECT_LE((schur->unitary * schur->triangle * schur->unitary.adjoint() - matrix).norm(), 100 * eps * size);
        EXPECT_LE((schur->unitary.adjoint() * schur->unitary - Eigen::MatrixXcd::Identity(5, 5)).norm(), 100 * eps);
    }
    for (const auto& [rows, columns] : {std::pair{5, 5}, {6, 2}})
        for (const Eigen::MatrixXd& matrix : matrices(rows, columns)) {
            const OrthogonalFactors factors = orthogonal_factors(matrix);
            EXPECT_LE((factors.orthogonal * factors.triangle - matrix).norm(), 50 * eps * matrix.norm());
            EXPECT_LE(
                (factors.orthogonal.transpose() * factors.orthogonal - Eigen::MatrixXd::Identity(columns, columns))
                    .norm(),
                50 * eps);
            EXPECT_TRUE(factors.triangle.isUpperTriangular(0));
        }
}

TEST(Decompositions, what_does_not_converge_has_none) {
    const double nan = std::numeric_limits<double>::quiet_NaN();
    EXPECT_FALSE(eigenvalues(Eigen::Matrix2d::Constant(nan)));
    EXPECT_FALSE(eigensystem(Eigen::Matrix2d::Constant(nan)));
}

} // namespace
} // namespace graze
