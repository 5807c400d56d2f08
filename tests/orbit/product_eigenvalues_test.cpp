#include "orbit/certify.hpp"

#include <Eigen/Dense>
#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace graze::product_eigenvalues_test {

/// Factors whose product has the given real eigenvalues: random changes of basis between diagonal factors.
std::vector<Eigen::MatrixXd> factors_with(const std::vector<double>& eigenvalues, std::size_t count) {
    std::mt19937 random(7);
    std::normal_distribution<double> normal;
    const auto n = static_cast<Eigen::Index>(eigenvalues.size());
    std::vector<Eigen::MatrixXd> bases, factors;
    for (std::size_t k = 0; k < count; ++k)
        bases.push_back(Eigen::HouseholderQR<Eigen::MatrixXd>(Eigen::MatrixXd::NullaryExpr(n, n, [&] {
                            return normal(random);
                        })).householderQ());
    for (std::size_t k = 0; k < count; ++k) {
        Eigen::VectorXd roots(n);
        for (Eigen::Index i = 0; i < n; ++i) {
            const double value = eigenvalues[static_cast<std::size_t>(i)];
            roots[i] = std::pow(std::abs(value), 1.0 / static_cast<double>(count)) * (k == 0 && value < 0 ? -1 : 1);
        }
        factors.push_back(bases[(k + 1) % count] * roots.asDiagonal() * bases[k].transpose());
    }
    return factors;
}

TEST(ProductEigenvalues, ResolveEighteenPowersOfTen) {
    const std::vector<double> known{1e6, -3.0, 0.5, 2e-7, -1e-12};
    for (const std::size_t count : {5u, 20u, 100u}) {
        const auto found = product_eigenvalues(factors_with(known, count));
        ASSERT_EQ(found.size(), known.size());
        for (std::size_t i = 0; i < known.size(); ++i) {
            EXPECT_NEAR(found[i].real() / known[i], 1, 1e-11) << count << " " << i;
            EXPECT_EQ(found[i].imag(), 0);
        }
    }
}

TEST(ProductEigenvalues, EqualThoseOfAWellConditionedProduct) {
    std::mt19937 random(3);
    std::normal_distribution<double> normal;
    for (int trial = 0; trial < 50; ++trial) {
        std::vector<Eigen::MatrixXd> factors;
        Eigen::MatrixXd product = Eigen::MatrixXd::Identity(4, 4);
        for (int k = 0; k < 3; ++k) {
            factors.push_back(Eigen::MatrixXd::NullaryExpr(4, 4, [&] { return normal(random); }));
            product = factors.back() * product;
        }
        const auto found = product_eigenvalues(factors);
        std::complex<double> sum = 0, prod = 1;
        for (const auto value : found) {
            sum += value;
            prod *= value;
        }
        EXPECT_NEAR(sum.real(), product.trace(), 1e-12 * product.norm());
        EXPECT_NEAR(sum.imag(), 0, 1e-12 * product.norm());
        EXPECT_NEAR(prod.real(), product.determinant(), 1e-10 * std::pow(product.norm(), 4));
    }
}

/// Similar ones, up to just where they are no longer taken from the product itself, have nearly all digits.
TEST(ProductEigenvalues, OfSimilarSizesHaveNearlyAllDigits) {
    for (const double smallest : {0.9, 0.5, 0.2, 0.15, 0.1, 0.05, 0.01}) {
        const std::vector<double> known{1.1, 0.95, -0.92, smallest, -0.9 * smallest};
        for (const std::size_t count : {1u, 2u, 8u, 9u}) {
            const auto found = product_eigenvalues(factors_with(known, count));
            ASSERT_EQ(found.size(), known.size());
            for (std::size_t i = 0; i < known.size(); ++i)
                EXPECT_NEAR(found[i].real() / known[i], 1, 3e-14) << smallest << ' ' << count << ' ' << i;
        }
    }
}

TEST(ProductEigenvalues, IncludeComplexPairsAndZeros) {
    std::vector<Eigen::MatrixXd> factors(2, Eigen::MatrixXd::Zero(3, 3));
    factors[0] << 0.6, -0.8, 0, 0.8, 0.6, 0, 0, 0, 1; // a rotation
    factors[1] << 2, 0, 0, 0, 2, 0, 0, 0, 0;
    const auto found = product_eigenvalues(factors);
    EXPECT_NEAR(std::abs(found[0]), 2, 1e-14);
    EXPECT_NEAR(std::abs(found[0].imag()), 1.6, 1e-14);
    EXPECT_NEAR(std::abs(found[2]), 0, 1e-300);
    EXPECT_TRUE(product_eigenvalues({}).empty());
}

} // namespace graze::product_eigenvalues_test
