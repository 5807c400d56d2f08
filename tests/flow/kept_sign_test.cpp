#include "flow/kept_sign.hpp"

#include "graze/flow/roots.hpp"

#include <gtest/gtest.h>

#include <random>
#include <vector>

namespace kept_sign_test {

using namespace graze;

std::vector<double> derivative_of(const std::vector<double>& c) {
    std::vector<double> rate;
    for (std::size_t k = 1; k < c.size(); ++k)
        rate.push_back(static_cast<double>(k) * c[k]);
    return rate;
}

/// Returns the least value of sign * p at many points of [0, length], in higher precision.
long double least_sample(const std::vector<double>& c, double length, int sign) {
    long double least = std::numeric_limits<long double>::infinity();
    constexpr int samples = 200;
    for (int i = 0; i <= samples; ++i) {
        const long double s = static_cast<long double>(length) * i / samples;
        long double sum = 0;
        for (std::size_t k = c.size(); k-- > 0;)
            sum = sum * s + c[k];
        least = std::min(least, sign * sum);
    }
    return least;
}

TEST(ClearSign, HoldsOnTheWholeIntervalForAllDegreesAndScales) {
    std::mt19937_64 random(11);
    std::uniform_real_distribution<double> coefficient(-1, 1), exponent(-12, 12);
    int clear = 0, clear_rates = 0;
    for (int i = 0; i < 20'000; ++i) {
        const std::size_t size = 1 + random() % 42;
        const double length = std::exp2(exponent(random)), scale = std::exp2(20 * exponent(random));
        std::vector<double> c(size);
        double power = scale;
        for (double& one : c) {
            one = coefficient(random) * power;
            power /= length * (1 + std::abs(coefficient(random)) * 4);
        }
        const roots::ClearSign value = roots::clear_sign<false>(c, length), rate = roots::clear_sign<true>(c, length);
        if (value.sign != 0) {
            ++clear;
            EXPECT_GT(least_sample(c, length, value.sign), 0) << i;
            double sizes = 0;
            for (std::size_t k = size; k-- > 0;)
                sizes = sizes * length + std::abs(c[k]);
            EXPECT_NEAR(value.size, sizes, 1e-13 * sizes); // 2 * 42 roundings
        }
        if (rate.sign != 0) {
            ++clear_rates;
            EXPECT_GT(least_sample(derivative_of(c), length, rate.sign), 0) << i;
        }
    }
    EXPECT_GT(clear, 4'000);
    EXPECT_GT(clear_rates, 2'000);
}

TEST(ClearSign, IsUncertainNearZero) {
    // 1 - s is zero at 1; at 1 + 2^-50 it is within a hundred round-offs of zero.
    const std::vector<double> falling{1, -1, 0, 0};
    EXPECT_EQ(roots::clear_sign<false>(falling, 0.999).sign, 1);
    EXPECT_EQ(roots::clear_sign<false>(falling, 1).sign, 0);
    EXPECT_EQ(roots::clear_sign<false>(falling, 1 - 0x1p-50).sign, 0);
    // (s - 1/2)^2 + h touches zero for h = 0 and is negative for smaller h. Its derivative changes sign.
    for (const double height : {0.0, -1e-3, 1e-17}) {
        const std::vector<double> dip{0.25 + height, -1, 1, 0};
        EXPECT_EQ(roots::clear_sign<false>(dip, 1).sign, 0);
        EXPECT_EQ(roots::clear_sign<true>(dip, 1).sign, 0);
    }
    // The same in the later terms, whose signs are not used.
    std::vector<double> late(18, 0.0);
    late[0] = 1;
    late[15] = -4;
    late[16] = 4;
    EXPECT_EQ(roots::clear_sign<false>(late, 1).sign, 0);
    EXPECT_EQ(roots::clear_sign<false>(late, 0.5).sign, 1);
}

TEST(ClearSign, IsUncertainForNaNAndEmptyIntervals) {
    constexpr double infinity = std::numeric_limits<double>::infinity();
    for (const double bad : {infinity, -infinity, std::numeric_limits<double>::quiet_NaN()})
        for (std::size_t at = 0; at < 18; ++at) {
            std::vector<double> c(18, 0.0);
            c[0] = 1;
            c[1] = 1;
            c[at] = bad;
            EXPECT_EQ(roots::clear_sign<false>(c, 0.5).sign, 0) << at;
            if (at > 0) {
                EXPECT_EQ(roots::clear_sign<true>(c, 0.5).sign, 0) << at;
            }
        }
    const std::vector<double> one{1, 1, 0, 0};
    EXPECT_EQ(roots::clear_sign<false>(one, 0).sign, 0);
    EXPECT_EQ(roots::clear_sign<false>(one, -1).sign, 0);
    EXPECT_EQ(roots::clear_sign<false>(one, std::numeric_limits<double>::quiet_NaN()).sign, 0);
    EXPECT_EQ(roots::clear_sign<false>(std::vector<double>{}, 1).sign, 0);
    EXPECT_EQ(roots::clear_sign<true>(std::vector<double>{1}, 1).sign, 0);
}

} // namespace kept_sign_test
