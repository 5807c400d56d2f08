#include "orbit/cyclic_system.hpp"

#include <Eigen/Dense>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

namespace graze::cyclic_system_test {

/// A factored system of one segment whose duration is fixed by its end condition, so that x_1 = map x_0.
CyclicSystem cycle_of(const Eigen::MatrixXd& map) {
    const Eigen::Index n = map.rows();
    CyclicSystem system(static_cast<std::size_t>(n), 0);
    system.resize(1);
    CyclicSystem::Block& block = system.block(0);
    block.own.setZero();
    block.own(0, n) = 1;
    block.own.bottomLeftCorner(n, n) = map;
    block.next.bottomRows(n) = -Eigen::MatrixXd::Identity(n, n);
    EXPECT_TRUE(system.factor());
    return system;
}

/// The determinant is zero up to its noise where a multiplier is one or minus one up to 1e-10, and not where it is one
/// of them up to 1e-7, for any number of states and other multipliers of any size.
TEST(CyclicSystem, KnowsTheNoiseOfItsDeterminants) {
    std::mt19937 random(11);
    std::normal_distribution<double> normal;
    std::uniform_real_distribution<double> share(0, 1);
    for (const Eigen::Index n : {2, 5, 20, 60})
        for (int trial = 0; trial < 10; ++trial)
            for (const double critical : {1.0, -1.0}) {
                Eigen::VectorXd multipliers =
                    Eigen::VectorXd::NullaryExpr(n, [&] { return std::pow(10.0, 2 * share(random) - 1.5); });
                const Eigen::MatrixXd basis =
                    Eigen::HouseholderQR<Eigen::MatrixXd>(Eigen::MatrixXd::NullaryExpr(n, n, [&] {
                        return normal(random);
                    })).householderQ();
                const auto determinant_at = [&](double off) {
                    multipliers[0] = critical * (1 + off);
                    const CyclicSystem system = cycle_of(basis * multipliers.asDiagonal() * basis.transpose());
                    return critical > 0 ? system.periodic_determinant() : system.antiperiodic_determinant();
                };
                const auto inside = determinant_at(1e-11), below = determinant_at(-1e-5), above = determinant_at(1e-5);
                EXPECT_LT(std::abs(inside.value), inside.noise) << n;
                EXPECT_GT(std::abs(below.value), below.noise) << n;
                EXPECT_GT(std::abs(above.value), above.noise) << n;
                EXPECT_LT(below.value * above.value, 0) << n;
            }
}

/// Two states keep their values: other determinants of the matrix vanish too.
TEST(CyclicSystem, HasANoiseWhereTheMatrixIsSingularTwice) {
    const CyclicSystem::Determinant zero = cycle_of(Eigen::Vector3d(1, 1, 0.5).asDiagonal()).periodic_determinant();
    EXPECT_NEAR(zero.value, 0, 1e-30);
    EXPECT_TRUE(std::isfinite(zero.noise));
}

TEST(CyclicSystem, HasASignedDeterminantWithoutStates) {
    CyclicSystem system(0, 0);
    system.resize(1);
    system.block(0).own(0, 0) = 2;
    ASSERT_TRUE(system.factor());
    EXPECT_GT(system.periodic_determinant().value, 0);
    EXPECT_EQ(system.periodic_determinant().noise, 0);
}

/// With many states the first start is not eliminated, and work is done in blocks: solutions, determinants and null
/// vectors are those of the whole matrix.
TEST(CyclicSystem, WithManyStatesAgreesWithTheWholeMatrix) {
    constexpr Eigen::Index n = 260, q = 1;
    std::mt19937 random(3);
    std::normal_distribution<double> normal;
    const auto any = [&](Eigen::Index rows, Eigen::Index columns) {
        return Eigen::MatrixXd(Eigen::MatrixXd::NullaryExpr(rows, columns, [&] { return normal(random); }));
    };
    for (const Eigen::Index segments : {1, 3}) {
        CyclicSystem system(n, q);
        system.resize(static_cast<std::size_t>(segments));
        const Eigen::Index all = segments * (n + 1) + q;
        Eigen::MatrixXd whole = Eigen::MatrixXd::Zero(all, all);
        Eigen::VectorXd right = any(all, 1);
        for (Eigen::Index k = 0; k < segments; ++k) {
            CyclicSystem::Block& block = system.block(static_cast<std::size_t>(k));
            block.own = any(n + 1, n + 1) / std::sqrt(n);
            block.own.row(0) *= std::sqrt(n);
            block.next.setZero();
            block.next.bottomRows(n).setIdentity();
            block.parameters = any(n + 1, q);
            block.right = right.segment(k * (n + 1), n + 1);
            whole.block(k * (n + 1), k * (n + 1), n + 1, n + 1) += block.own;
            whole.block(k * (n + 1), (k + 1) % segments * (n + 1), n + 1, n) += block.next;
            whole.block(k * (n + 1), all - q, n + 1, q) = block.parameters;
        }
        const Eigen::MatrixXd borders = any(q, all);
        whole.bottomRows(q) = borders;
        ASSERT_TRUE(system.factor());
        const auto closed = system.close(borders);
        ASSERT_TRUE(closed.is_regular());
        const Eigen::VectorXd blocks = system.right_hand_sides();
        Eigen::VectorXd solution;
        ASSERT_TRUE(system.solve(closed, &blocks, right.tail(q), solution));
        EXPECT_LT((whole * solution - right).norm(), 1e-9 * right.norm()) << segments;
        // Exchanging rows of one block changes the signs of all determinants.
        const double before = closed.determinant(), periodic = system.periodic_determinant().value,
                     antiperiodic = system.antiperiodic_determinant().value;
        CyclicSystem::Block& last = system.block(static_cast<std::size_t>(segments - 1));
        last.own.row(1).swap(last.own.row(2));
        last.next.row(1).swap(last.next.row(2));
        last.parameters.row(1).swap(last.parameters.row(2));
        ASSERT_TRUE(system.factor());
        EXPECT_LT(system.close(borders).determinant() * before, 0);
        EXPECT_LT(system.periodic_determinant().value * periodic, 0);
        EXPECT_LT(system.antiperiodic_determinant().value * antiperiodic, 0);
        EXPECT_EQ(system.undetermined(), 0U);
    }
}

} // namespace graze::cyclic_system_test
