#include "graze/results/regression.hpp"

#include "graze/base/input_error.hpp"

#include <array>
#include <cmath>
#include <gtest/gtest.h>
#include <limits>
#include <span>
#include <vector>

namespace graze::testing::regression_test {

constexpr double eps = std::numeric_limits<double>::epsilon();

TEST(RegressionTest, FindsALineThroughPointsOnIt) {
    const std::array x{-1.0, 0.0, 2.0, 5.0}, y{5.0, 3.0, -1.0, -7.0};
    const Regression line = regression(x, y);
    EXPECT_NEAR(line.slope, -2, 8 * eps);
    EXPECT_NEAR(line.intercept, 3, 16 * eps);
    EXPECT_NEAR(line.slope_error, 0, 16 * eps);
    EXPECT_NEAR(line.intercept_error, 0, 32 * eps);
    EXPECT_EQ(line.points, 4U);
}

// Sums by hand: mean x 2, mean y 7/3; xx = 2, xy = 2, squares of the residuals 2/3 with one degree of freedom.
TEST(RegressionTest, StandardErrorsEqualAHandCalculation) {
    const std::array x{1.0, 2.0, 3.0}, y{1.0, 3.0, 3.0};
    const Regression line = regression(x, y);
    EXPECT_NEAR(line.slope, 1, 8 * eps);
    EXPECT_NEAR(line.intercept, 1.0 / 3, 16 * eps);
    EXPECT_NEAR(line.slope_error, std::sqrt(1.0 / 3), 16 * eps);
    EXPECT_NEAR(line.intercept_error, std::sqrt(2.0 / 3 * (1.0 / 3 + 4.0 / 2)), 32 * eps);
}

// The normal equations: residuals are orthogonal to 1 and to x.
TEST(RegressionTest, ResidualsSatisfyTheNormalEquations) {
    std::vector<double> x, y;
    for (int i = 0; i < 500; ++i) {
        x.push_back(1000 + 0.01 * i);
        y.push_back(3 * x.back() + std::sin(1.7 * i));
    }
    const Regression line = regression(x, y);
    double sum = 0, moment = 0;
    for (std::size_t i = 0; i < x.size(); ++i) {
        const double residual = y[i] - line.intercept - line.slope * x[i];
        sum += residual;
        moment += residual * (x[i] - 1000);
    }
    // Each mean is a sum of 500 values near 3000, rounded 500 times; its error enters all 500 residuals.
    const double bound = 4.0 * 500 * 500 * 3000 * eps;
    EXPECT_NEAR(sum, 0, bound);
    EXPECT_NEAR(moment, 0, 5 * bound);
}

TEST(RegressionTest, TwoPointsGiveALineWithoutErrors) {
    const std::array x{1.0, 3.0}, y{2.0, 6.0};
    const Regression line = regression(x, y);
    EXPECT_NEAR(line.slope, 2, 8 * eps);
    EXPECT_EQ(line.slope_error, 0);
    EXPECT_EQ(line.intercept_error, 0);
    EXPECT_EQ(line.points, 2U);
}

TEST(RegressionTest, NeedsTwoDifferentX) {
    const std::array same{2.0, 2.0, 2.0}, y{1.0, 2.0, 3.0}, shorter{1.0, 2.0, 3.0};
    EXPECT_EQ(regression(same, y).points, 0U);
    EXPECT_EQ(regression({}, {}).points, 0U);
    EXPECT_EQ(regression(std::span(same).first(1), std::span(y).first(1)).points, 0U);
    EXPECT_THROW(regression(std::span(shorter).first(2), y), InputError);
}

} // namespace graze::testing::regression_test
