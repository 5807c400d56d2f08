#include "branch/turning_pair.hpp"

#include "base/message_of.hpp"

#include <Eigen/Geometry>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <complex>

namespace graze::turning_pair_test {

TEST(TurningPair, IsTheOneOnTheUnitCircle) {
    const auto turning = [](double modulus, double angle) -> Eigen::Matrix2d {
        return modulus * Eigen::Rotation2Dd(angle).toRotationMatrix();
    };
    Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(5, 5);
    matrix(0, 0) = -1;
    matrix.block(1, 1, 2, 2) = turning(0.7, 2.1);
    matrix.block(3, 3, 2, 2) = turning(1, 0.4);
    const TurningPair pair = turning_pair(matrix);
    EXPECT_NEAR(std::abs(pair.multiplier - std::polar(1.0, 0.4)), 0, 1e-14);
    EXPECT_NEAR((matrix * pair.vector - pair.multiplier * pair.vector).norm(), 0, 1e-14);
    EXPECT_NEAR(pair.vector.norm(), 1, 1e-14);
}

TEST(TurningPair, IsNoneOfRealMultipliersOrBesideTheCircle) {
    for (const double modulus : {0.9, 1.002})
        EXPECT_THAT(
            graze::testing::message_of([&] { turning_pair(modulus * Eigen::Rotation2Dd(1).toRotationMatrix()); }),
            ::testing::HasSubstr("no complex pair"));
    EXPECT_ANY_THROW(turning_pair(Eigen::Matrix2d::Identity()));
}

} // namespace graze::turning_pair_test
