#include "base/decompositions.hpp"

#include <Eigen/Dense>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

namespace graze::decompositions_test {

constexpr double eps = std::numeric_limits<double>::epsilon();

/// Matrices of full and of lower rank, with entries between -1 and 1.
std::vector<Eigen::MatrixXd> matrices(Eigen::Index rows, Eigen::Index columns) {
    std::vector<Eigen::MatrixXd> result;
    for (int k = 1; k < 6; ++k)
        result.emplace_back(Eigen::MatrixXd::NullaryExpr(rows, columns, [&](Eigen::Index i, Eigen::Index j) {
            return std::sin(static_cast<double>(k * (i + 1)) * 1.7 + static_cast<double>((j + 2) * (j + k)) * 0.9);
        }));
    result.emplace_back(Eigen::MatrixXd::Ones(rows, columns));
    return result;
}

/// A matrix with one column more than rows: its last singular value is `last`, the others are between 1 and 2.
Eigen::MatrixXd nearly_singular(Eigen::Index rows, double last) {
    const auto bent = [](Eigen::Index size) {
        return orthogonal_factors(
                   Eigen::MatrixXd::NullaryExpr(size, size,
                                                [](Eigen::Index i, Eigen::Index j) {
                                                    return std::sin(static_cast<double>((i + 1) * (j + 2)) * 0.7) +
                                                           (i == j ? 2 : 0);
                                                }))
            .orthogonal;
    };
    Eigen::VectorXd values = Eigen::VectorXd::LinSpaced(rows, 2, 1);
    values[rows - 1] = last;
    return bent(rows) * values.asDiagonal() * bent(rows + 1).topRows(rows);
}

TEST(Decompositions, FactorsMultiplyToTheMatrix) {
    for (const auto& [rows, columns] : {std::pair{4, 4}, {6, 3}, {3, 6}, {1, 1}, {70, 70}})
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
            EXPECT_LE((right * right.transpose() - Eigen::MatrixXd::Identity(columns, columns)).norm(),
                      50 * eps * std::sqrt(columns));
            EXPECT_LE((singular_values(Eigen::MatrixXcd(matrix)) - full.values).norm(), 50 * eps * size);
            EXPECT_EQ(full.rank(1e-9), Eigen::FullPivLU<Eigen::MatrixXd>(matrix).setThreshold(1e-9).rank());
        }
    EXPECT_EQ(singular_values(Eigen::MatrixXd(), SingularVectors::none).rank(1e-9), 0);
    EXPECT_EQ(eigenvalues(Eigen::MatrixXd())->size(), 0);
    EXPECT_EQ(eigensystem(Eigen::MatrixXd())->values.size(), 0);
    EXPECT_EQ(singular_values(Eigen::MatrixXd::Zero(2, 2), SingularVectors::none).rank(1e-9), 0);
}

TEST(Decompositions, NearlyNullVectorsAreAsSmallAsSingularValuesSay) {
    for (const Eigen::Index rows : {1, 4, 40})
        for (const double distance : {0.0, 1e-6}) {
            const Eigen::MatrixXd matrix = nearly_singular(rows, distance);
            const NearlyNull near = nearly_null(matrix);
            EXPECT_LE((near.right.transpose() * near.right - Eigen::Matrix2d::Identity()).norm(), 50 * eps);
            EXPECT_NEAR(near.left.norm(), 1, 10 * eps);
            // Pivots may be larger than singular values, but seldom are.
            EXPECT_LE((matrix * near.right).norm(), 10 * distance + 200 * eps);
            EXPECT_LE((near.left.transpose() * matrix).norm(), 10 * distance + 200 * eps);
        }
}

TEST(Decompositions, NullVectorsAreMappedToZero) {
    for (Eigen::MatrixXd matrix : matrices(4, 4)) {
        matrix.row(3) = matrix.row(0) - matrix.row(1);
        const Eigen::MatrixXcd turned = matrix * std::complex<double>(0.6, 0.8);
        const Eigen::VectorXcd vector = null_vector(turned);
        EXPECT_NEAR(vector.norm(), 1, 10 * eps);
        EXPECT_LE((turned * vector).norm(), 50 * eps * matrix.norm());
        const Eigen::VectorXcd real = null_vector(matrix.cast<std::complex<double>>());
        EXPECT_EQ(real.imag().norm(), 0);
        EXPECT_LE((matrix * real).norm(), 50 * eps * matrix.norm());
    }
}

TEST(Decompositions, EigenvaluesAreZerosOfTheCharacteristicPolynomial) {
    for (const Eigen::MatrixXd& matrix : matrices(2, 2)) {
        const std::complex<double> half = matrix.trace() / 2, root = std::sqrt(half * half - matrix.determinant());
        const auto found = eigensystem(matrix);
        ASSERT_TRUE(found);
        EXPECT_LE((found->values - *eigenvalues(matrix)).norm(), 50 * eps);
        for (const std::complex<double> known : {half + root, half - root})
            EXPECT_LE((found->values.array() - known).abs().minCoeff(), 1e-7)
                << "double eigenvalues have errors of the order of the square root of round-off";
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

TEST(Decompositions, SymmetricEigenvaluesRiseAndAreSquaresOfSingularValues) {
    for (const Eigen::MatrixXd& matrix : matrices(6, 3)) {
        const auto found = symmetric_eigenvalues(matrix.transpose() * matrix);
        ASSERT_TRUE(found);
        const Eigen::VectorXd sizes = singular_values(matrix, SingularVectors::none).values;
        EXPECT_LE((found->reverse() - sizes.cwiseAbs2()).norm(), 50 * eps * matrix.squaredNorm());
    }
}

TEST(Decompositions, GeneralizedEigenvaluesMayBeInfinite) {
    const Eigen::Matrix2d a{{3, 0}, {0, 1}}, b{{1, 0}, {0, 0}};
    const auto found = generalized_eigenvalues(a, b);
    ASSERT_TRUE(found);
    const Eigen::Index finite = found->denominators[0] != 0 ? 0 : 1;
    EXPECT_EQ(found->numerators[finite] / found->denominators[finite], 3.0);
    EXPECT_EQ(found->denominators[1 - finite], 0);
}

TEST(Decompositions, GeneralizedEigenvaluesMakeTheirPencilSingular) {
    const auto some = matrices(6, 6);
    for (std::size_t k = 0; k + 1 < some.size(); ++k) {
        const Eigen::MatrixXd a = some[k] + Eigen::MatrixXd::Identity(6, 6);
        const Eigen::MatrixXd b = some[k + 1] + 5 * Eigen::MatrixXd::Identity(6, 6);
        const auto found = generalized_eigenvalues(a, b);
        ASSERT_TRUE(found);
        std::complex<double> numerators = 1;
        double denominators = 1;
        for (Eigen::Index i = 0; i < a.rows(); ++i) {
            const std::complex<double> top = found->numerators[i];
            const double bottom = found->denominators[i];
            const Eigen::VectorXd sizes = singular_values(bottom * a.cast<std::complex<double>>() - top * b);
            EXPECT_LE(sizes[5], 200 * eps * sizes[0]) << "number " << i << " of pencil " << k;
            numerators *= top;
            denominators *= bottom;
        }
        // Their product is that of the determinants.
        EXPECT_LE(std::abs(numerators * b.determinant() - denominators * a.determinant()),
                  1e4 * eps * std::abs(denominators * a.determinant()));
    }
}

TEST(Decompositions, SchurAndOrthogonalFactorsMultiplyToTheMatrix) {
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

TEST(Decompositions, OrthogonalComplementsAreOrthonormal) {
    for (const Eigen::Index size : {1, 2, 5}) {
        const Eigen::VectorXd vector = matrices(size, 1).front();
        const Eigen::MatrixXd found = orthogonal_complement(vector);
        ASSERT_EQ(found.cols(), size - 1);
        EXPECT_LE((found.transpose() * found - Eigen::MatrixXd::Identity(size - 1, size - 1)).norm(), 50 * eps);
        EXPECT_LE((found.transpose() * vector).norm(), 50 * eps);
    }
}

TEST(Decompositions, MatricesWithNaNHaveNoEigenvalues) {
    const double nan = std::numeric_limits<double>::quiet_NaN();
    EXPECT_FALSE(eigenvalues(Eigen::Matrix2d::Constant(nan)));
    EXPECT_FALSE(eigensystem(Eigen::Matrix2d::Constant(nan)));
    EXPECT_TRUE(eigenvalues_or_nan(Eigen::Matrix2d::Constant(nan)).hasNaN());
}

} // namespace graze::decompositions_test
