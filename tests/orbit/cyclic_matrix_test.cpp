// CyclicMatrix against dense matrices with the same blocks.

#include "orbit/cyclic_matrix.hpp"

#include "base/decompositions.hpp"

#include <Eigen/Dense>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

namespace graze::cyclic_matrix_test {

struct Case {
    Eigen::Index n, m;
    CyclicSystem system;
    Eigen::VectorXd rows, columns;

    Case(std::size_t states, std::size_t segments, unsigned seed)
        : n(Eigen::Index(states)), m(Eigen::Index(segments)), system(states, 2), rows(size()), columns(size()) {
        std::mt19937 random(seed);
        std::normal_distribution<double> normal;
        const auto chance = [&] { return normal(random); };
        system.resize(segments);
        for (std::size_t k = 0; k < segments; ++k) {
            CyclicSystem::Block& block = system.block(k);
            block.own = Eigen::MatrixXd::NullaryExpr(n + 1, n + 1, chance);
            block.next.setZero();
            block.next.bottomRows(n).setIdentity();
            block.parameters = Eigen::MatrixXd::NullaryExpr(n + 1, 2, chance);
            block.right = Eigen::VectorXd::NullaryExpr(n + 1, chance);
        }
        rows = Eigen::VectorXd::NullaryExpr(size(), [&] { return std::exp(chance()); });
        columns = Eigen::VectorXd::NullaryExpr(size(), [&] { return std::exp(chance()); });
    }
    Eigen::Index size() const { return m * (n + 1); }
    CyclicMatrix matrix(double factor) const { return {system, factor, rows, columns}; }
    Eigen::MatrixXcd dense(std::complex<double> factor) const {
        Eigen::MatrixXcd result = Eigen::MatrixXcd::Zero(size(), size());
        for (Eigen::Index k = 0; k < m; ++k) {
            const CyclicSystem::Block& block = system.block(std::size_t(k));
            const Eigen::Index at = k * (n + 1), next = (k + 1) % m * (n + 1);
            result.block(at, at, n + 1, n + 1) += block.own;
            result.block(at, next, n + 1, n) += (k + 1 == m ? factor : 1.0) * block.next.cast<std::complex<double>>();
        }
        return rows.asDiagonal() * result * columns.asDiagonal();
    }
};

TEST(CyclicMatrix, BorderedSolutionsEqualThoseOfTheDenseMatrix) {
    for (const std::size_t n : {1, 2, 5})
        for (const std::size_t m : {1, 2, 7})
            for (const double factor : {1.0, -1.0}) {
                const Case one(n, m, unsigned(10 * n + m));
                const Eigen::MatrixXd matrix = one.dense(factor).real();
                const Eigen::VectorXd b = Eigen::VectorXd::Random(one.size()), c = Eigen::VectorXd::Random(one.size());
                Eigen::MatrixXd whole = Eigen::MatrixXd::Zero(one.size() + 1, one.size() + 1);
                whole.topLeftCorner(one.size(), one.size()) = matrix;
                whole.topRightCorner(one.size(), 1) = b;
                whole.bottomLeftCorner(1, one.size()) = c.transpose();
                const Eigen::VectorXd unit = Eigen::VectorXd::Unit(one.size() + 1, one.size());
                const Eigen::VectorXd expected = whole.fullPivLu().solve(unit),
                                      other = whole.transpose().fullPivLu().solve(unit);
                Eigen::VectorXd right, left;
                double value = 0;
                ASSERT_TRUE(one.matrix(factor).bordered(b, c, right, left, value));
                const double allowed = 1e-11 * (expected.norm() + other.norm());
                EXPECT_LT((right - expected.head(one.size())).norm(), allowed);
                EXPECT_LT((left - other.head(one.size())).norm(), allowed);
                EXPECT_NEAR(value, expected[one.size()], allowed);
            }
}

TEST(CyclicMatrix, MultipliersMakeTheMatrixSingular) {
    for (const std::size_t n : {2, 4})
        for (const std::size_t m : {1, 3}) {
            const Case one(n, m, unsigned(100 * n + m));
            const auto all = one.matrix(1).multipliers();
            EXPECT_EQ(all.size(), n);
            for (const std::complex<double> multiplier : all) {
                const Eigen::VectorXd values = singular_values(one.dense(multiplier));
                EXPECT_LT(values[values.size() - 1], 1e-11 * values[0]) << multiplier;
            }
        }
}

/// Checks that the left and right planes of two multipliers are invariant under their map, and compares the documented
/// derivative of the map with differences of its trace and determinant.
void expect_plane(const Case& one, std::complex<double> first, std::complex<double> second) {
    CyclicMatrix::Plane plane;
    ASSERT_TRUE(one.matrix(1).plane_near(first, second, plane));
    EXPECT_NEAR(plane.map.trace(), (first + second).real(), 1e-6 * (std::abs(first) + std::abs(second)));
    EXPECT_NEAR(plane.map.determinant(), (first * second).real(), 1e-6 * std::abs(first * second));
    const Eigen::MatrixXd open = one.dense(0).real(), closing = one.dense(1).real() - open;
    const double size = open.norm() * plane.right.norm();
    EXPECT_LT((open * plane.right + closing * plane.right * plane.map).norm(), 1e-10 * size);
    EXPECT_LT((plane.left.transpose() * closing * plane.right - Eigen::Matrix2d::Identity()).norm(),
              1e-10 * plane.left.norm() * closing.norm() * plane.right.norm());
    Case changed = one;
    const Eigen::MatrixXd change = Eigen::MatrixXd::Random(one.n + 1, one.n + 1);
    constexpr double step = 1e-6;
    double of_trace = 0, of_determinant = 0;
    for (const double sign : {1.0, -1.0}) {
        changed.system.block(0).own = one.system.block(0).own + sign * step * change;
        CyclicMatrix::Plane moved;
        ASSERT_TRUE(changed.matrix(1).plane_near(first, second, moved));
        of_trace += sign * moved.map.trace() / (2 * step);
        of_determinant += sign * moved.map.determinant() / (2 * step);
    }
    const Eigen::MatrixXd scaled =
        one.rows.head(one.n + 1).asDiagonal() * change * one.columns.head(one.n + 1).asDiagonal();
    const Eigen::Matrix2d by = -plane.left.topRows(one.n + 1).transpose() * scaled * plane.right.topRows(one.n + 1);
    const double expected = (by(0, 0) * plane.map(1, 1) + by(1, 1) * plane.map(0, 0) - by(0, 1) * plane.map(1, 0) -
                             by(1, 0) * plane.map(0, 1));
    EXPECT_NEAR(of_trace, by.trace(), 1e-6 * (1 + by.norm()));
    EXPECT_NEAR(of_determinant, expected, 1e-6 * (1 + by.norm()) * (1 + plane.map.norm()));
}

TEST(CyclicMatrix, PlanesOfTwoMultipliersAreInvariantAndDifferentiable) {
    std::size_t complex = 0, real = 0;
    for (const std::size_t n : {2, 3, 4, 6})
        for (const std::size_t m : {1, 3}) {
            const Case one(n, m, unsigned(100 * n + m));
            const auto all = one.matrix(1).multipliers();
            for (std::size_t i = 0; i < all.size(); ++i) {
                if (all[i].imag() > 0) {
                    expect_plane(one, all[i], std::conj(all[i]));
                    ++complex;
                }
                for (std::size_t j = i + 1; j < all.size(); ++j)
                    if (all[i].imag() == 0 && all[j].imag() == 0) {
                        expect_plane(one, all[i], all[j]);
                        ++real;
                    }
            }
        }
    EXPECT_GT(complex, 2U);
    EXPECT_GT(real, 2U);
}

TEST(CyclicMatrix, PlanesAreSmoothWhereADoubleMultiplierHasOneEigenvector) {
    // One segment with next = identity: x_1 = -G x_0 for own = (1, 0; 0, G) up to order; here G has a Jordan block.
    Case one(3, 1, 7);
    CyclicSystem::Block& block = one.system.block(0);
    Eigen::Matrix3d basis, jordan;
    basis << 1, 0.3, -0.2, 0.1, 1, 0.4, -0.3, 0.2, 1;
    jordan << 1, 1, 0, 0, 1, 0, 0, 0, -0.4;
    block.own.setZero();
    block.own(0, 3) = 1; // the condition gives the duration
    block.own.block(1, 0, 3, 3) = -basis * jordan * basis.inverse();
    expect_plane(one, 1, 1);
}

TEST(CyclicMatrix, NullVectorsOfASingularMatrixAreFound) {
    for (const double factor : {1.0, -1.0}) {
        Case one(3, 4, 5);
        // The blocks are changed so that a random vector is in the null space.
        const Eigen::VectorXd vector = Eigen::VectorXd::Random(one.size());
        one.rows.setOnes();
        one.columns.setOnes();
        for (std::size_t k = 0; k < 4; ++k) {
            CyclicSystem::Block& block = one.system.block(k);
            const Eigen::Index at = Eigen::Index(k) * 4, next = (Eigen::Index(k) + 1) % 4 * 4;
            const Eigen::VectorXd own = vector.segment(at, 4),
                                  rest = block.own * own + (k == 3 ? factor : 1) * block.next * vector.segment(next, 3);
            block.own -= rest * own.transpose() / own.squaredNorm();
        }
        Eigen::VectorXd right, left;
        ASSERT_TRUE(one.matrix(factor).null_vectors(right, left));
        EXPECT_NEAR(std::abs(right.dot(vector.normalized())), 1, 1e-11);
        const Eigen::MatrixXd matrix = one.dense(factor).real();
        EXPECT_LT((matrix.transpose() * left).norm(), 1e-11 * matrix.norm());
    }
}

} // namespace graze::cyclic_matrix_test
