#include "branch/test_zero_search.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <random>

namespace graze::test_zero_search_test {

constexpr double within = 1e-13;
constexpr int most = 200;

struct Found {
    double fraction = std::numeric_limits<double>::quiet_NaN();
    int evaluations = 0;
};

Found zero_of(const std::function<double(double)>& test, bool outside = false) {
    TestZeroSearch search({0, test(0)}, {1, test(1)}, within,
                          outside ? std::optional(TestValue{-1, test(-1)}) : std::nullopt);
    Found found;
    while (const auto next = search.next()) {
        EXPECT_GT(*next, search.low().fraction);
        EXPECT_LT(*next, search.high().fraction);
        found.fraction = *next;
        search.add(test(*next));
        if (++found.evaluations > most)
            break;
    }
    return found;
}

TEST(TestZeroSearch, SmoothTestsTakeFewEvaluations) {
    std::mt19937 random(7);
    std::uniform_real_distribution<double> place(0.01, 0.99), bend(-0.4, 0.4), size(-9, 9);
    int evaluations = 0;
    constexpr int cases = 1000;
    for (int i = 0; i < cases; ++i) {
        const double zero = place(random), a = bend(random), b = bend(random), scale = std::pow(10, size(random));
        const Found found = zero_of(
            [&](double s) {
                const double d = s - zero;
                return scale * (std::exp(a * d) * d + b * d * d * d);
            },
            true);
        EXPECT_NEAR(found.fraction, zero, 2 * within);
        evaluations += found.evaluations;
    }
    EXPECT_LT(evaluations, 5 * cases);
}

TEST(TestZeroSearch, SteepFlatAndMultipleZerosAreFound) {
    EXPECT_NEAR(zero_of([](double s) { return std::atan(1e6 * (s - 0.3)); }).fraction, 0.3, 2 * within);
    EXPECT_NEAR(zero_of([](double s) { return std::cbrt(s - 0.7); }).fraction, 0.7, 2 * within);
    EXPECT_NEAR(zero_of([](double s) { return std::expm1(50 * (s - 0.9)); }).fraction, 0.9, 2 * within);
    EXPECT_NEAR(zero_of([](double s) { return 1e-8 - std::exp(-30 * s); }).fraction, std::log(1e8) / 30, 2 * within);
    // A multiple zero is as uncertain as the values around it.
    EXPECT_NEAR(zero_of([](double s) { return std::pow(s - 0.4, 3); }).fraction, 0.4, 1e-4);
}

TEST(TestZeroSearch, JumpsAreBracketed) {
    const Found jump = zero_of([](double s) { return s < 0.123 ? -1 - s : 2 + s; });
    EXPECT_NEAR(jump.fraction, 0.123, 10 * within);
    EXPECT_LT(jump.evaluations, 100);
    // The test ceases to exist, which counts as a positive value.
    const Found end = zero_of([](double s) { return s < 0.6 ? -1 : std::numeric_limits<double>::quiet_NaN(); });
    EXPECT_NEAR(end.fraction, 0.6, 2 * within);
    const Found begin = zero_of([](double s) { return s < 0.6 ? std::numeric_limits<double>::quiet_NaN() : -1; });
    EXPECT_NEAR(begin.fraction, 0.6, 2 * within);
}

TEST(TestZeroSearch, RoundOffEndsTheSearch) {
    constexpr double noise = 1e-11;
    std::mt19937 random(3);
    std::uniform_real_distribution<double> error(-noise, noise);
    for (int i = 0; i < 100; ++i) {
        const double zero = 0.01 * i + 0.005;
        const Found found = zero_of([&](double s) { return std::sin(s - zero) + error(random); });
        EXPECT_NEAR(found.fraction, zero, 10 * noise);
        EXPECT_LT(found.evaluations, 20);
    }
}

TEST(TestZeroSearch, AnExactZeroEndsTheSearch) {
    EXPECT_EQ(zero_of([](double s) { return s - 0.5; }).evaluations, 1);
}

} // namespace graze::test_zero_search_test
