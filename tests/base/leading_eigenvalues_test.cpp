#include "base/leading_eigenvalues.hpp"

#include "base/decompositions.hpp"

#include <Eigen/Dense>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <random>
#include <utility>

namespace graze::leading_eigenvalues_test {

constexpr Eigen::Index size = 240;

/// A matrix with these eigenvalues first, complex ones as pairs, and pairs of a given magnitude all around a circle.
/// @param departure of the triangle from a normal matrix, relative to the circle
Eigen::MatrixXd matrix_with(const std::vector<std::complex<double>>& first, double circle, double departure = 0) {
    std::mt19937 random(5);
    std::normal_distribution<double> normal;
    Eigen::MatrixXd triangle = Eigen::MatrixXd::NullaryExpr(
        size, size, [&] { return departure * circle * normal(random) / std::sqrt(static_cast<double>(size)); });
    triangle.triangularView<Eigen::Lower>().setZero();
    Eigen::Index i = 0;
    const auto place = [&](std::complex<double> one) {
        triangle(i, i) = one.real();
        if (one.imag() != 0 && i + 1 < size) {
            triangle.block<2, 2>(i, i) << one.real(), one.imag(), -one.imag(), one.real();
            ++i;
        }
        ++i;
    };
    for (const std::complex<double> one : first)
        place(one);
    while (i < size)
        place(std::polar(circle, std::numbers::pi * (static_cast<double>(i) + 0.5) / static_cast<double>(size)));
    const Eigen::MatrixXd basis = Eigen::HouseholderQR<Eigen::MatrixXd>(Eigen::MatrixXd::NullaryExpr(size, size, [&] {
                                      return normal(random);
                                  })).householderQ();
    return basis * triangle * basis.transpose();
}

TEST(LeadingEigenvalues, AreThoseOutsideTheCircleOfTheOthers) {
    const std::vector<std::complex<double>> wanted = {1.3, {0.6, 0.9}, 1.0, -0.99};
    for (const double circle : {0.5, 0.87, 0.9})
        for (const double departure : {0.0, 0.3}) {
            const auto found = leading_eigenvalues(matrix_with(wanted, circle, departure));
            ASSERT_TRUE(found) << circle;
            ASSERT_EQ(found->values.size(), 5U) << circle;
            EXPECT_NEAR(std::abs(found->values[0] - 1.3), 0, 1e-11);
            EXPECT_NEAR(std::abs(std::conj(found->values[1]) - found->values[2]), 0, 1e-11);
            EXPECT_NEAR(std::abs(found->values[1].imag()), 0.9, 1e-11);
            EXPECT_NEAR(std::abs(found->values[3] - 1.0), 0, 1e-11);
            EXPECT_NEAR(std::abs(found->values[4] + 0.99), 0, 1e-11);
            EXPECT_GE(found->others_within, circle);
            EXPECT_LT(found->others_within, 0.99);
        }
}

TEST(LeadingEigenvalues, NoneMayLieOutsideWhereAllAreOnOneCircle) {
    for (const double circle : {0.3, 0.87, 0.97, 0.99}) {
        const auto found = leading_eigenvalues(matrix_with({}, circle, 0.1));
        ASSERT_TRUE(found) << circle;
        EXPECT_TRUE(found->values.empty());
        EXPECT_GE(found->others_within, circle);
        EXPECT_LT(found->others_within, 1);
    }
}

/// All values agree with those of the dense matrix, counted outside the radius.
TEST(LeadingEigenvalues, AgreeWithTheWholeSpectrum) {
    for (int seed = 0; seed < 20; ++seed) {
        std::mt19937 random(static_cast<unsigned>(seed));
        std::normal_distribution<double> normal;
        const double scale = 0.75 + 0.02 * seed;
        Eigen::MatrixXd matrix = Eigen::MatrixXd::NullaryExpr(
            size, size, [&] { return scale * normal(random) / std::sqrt(static_cast<double>(size)); });
        matrix.diagonal().head(3).array() += 2;
        const auto found = leading_eigenvalues(matrix);
        if (!found)
            continue;
        const auto all = eigenvalues(matrix);
        ASSERT_TRUE(all);
        EXPECT_EQ(static_cast<std::size_t>((all->cwiseAbs().array() > found->others_within).count()),
                  found->values.size());
        for (const std::complex<double> one : found->values)
            EXPECT_LT((*all - Eigen::VectorXcd::Constant(size, one)).cwiseAbs().minCoeff(), 1e-10);
    }
}

/// Nothing is claimed where many eigenvalues lie on the unit circle or outside, nor of a double one.
TEST(LeadingEigenvalues, AreNotFoundWhereManyAreNearTheUnitCircle) {
    EXPECT_FALSE(leading_eigenvalues(matrix_with({}, 1)));
    EXPECT_FALSE(leading_eigenvalues(matrix_with({}, 1.2)));
    EXPECT_FALSE(leading_eigenvalues(matrix_with({}, 0.9999)));
    EXPECT_FALSE(leading_eigenvalues(Eigen::MatrixXd::Identity(size, size)));
    EXPECT_FALSE(leading_eigenvalues(Eigen::MatrixXd::Constant(size, size, std::numeric_limits<double>::quiet_NaN())));
    EXPECT_FALSE(leading_eigenvalues(Eigen::MatrixXd::Identity(3, 3) * 0.1));
    const auto twice = leading_eigenvalues(matrix_with({1.1, 1.1}, 0.8));
    EXPECT_TRUE(!twice || twice->values.size() == 2);
}

/// A matrix that is known by its products.
class Products : public LinearMap {
public:
    explicit Products(Eigen::MatrixXd matrix) : matrix_(std::move(matrix)) {}
    Eigen::Index size() const override { return matrix_.rows(); }
    Eigen::VectorXd times(const Eigen::VectorXd& vector) const override { return matrix_ * vector; }
    Eigen::VectorXd transposed_times(const Eigen::VectorXd& vector) const override {
        return matrix_.transpose() * vector;
    }

private:
    Eigen::MatrixXd matrix_;
};

/// Products with vectors give the same, whether low powers are enough or high ones are needed.
TEST(LeadingEigenvalues, OfAMapAreThoseOfItsMatrix) {
    for (const double circle : {0.5, 0.87, 0.97, 0.99}) {
        const Eigen::MatrixXd matrix = matrix_with({1.3, {0.6, 0.9}, -0.999}, circle, 0.1);
        const auto expected = leading_eigenvalues(matrix), found = leading_eigenvalues(Products(matrix));
        ASSERT_EQ(found.has_value(), expected.has_value()) << circle;
        if (!found)
            continue;
        EXPECT_NEAR(found->others_within, expected->others_within, 1e-9) << circle;
        ASSERT_EQ(found->values.size(), expected->values.size()) << circle;
        for (std::size_t i = 0; i < found->values.size(); ++i)
            EXPECT_NEAR(std::abs(found->values[i] - expected->values[i]), 0, 1e-11) << circle;
    }
    EXPECT_TRUE(leading_eigenvalues(Products(matrix_with({1.3}, 0.5))));
    EXPECT_FALSE(leading_eigenvalues(Products(matrix_with({}, 1.2))));
    EXPECT_FALSE(
        leading_eigenvalues(Products(Eigen::MatrixXd::Constant(size, size, std::numeric_limits<double>::infinity()))));
}

TEST(LeadingEigenvalues, ZeroIsAMatrixToo) {
    const auto found = leading_eigenvalues(Eigen::MatrixXd::Zero(size, size));
    ASSERT_TRUE(found);
    EXPECT_TRUE(found->values.empty());
    EXPECT_EQ(found->others_within, 0);
}

} // namespace graze::leading_eigenvalues_test
