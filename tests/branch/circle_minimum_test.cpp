#include "branch/circle_minimum.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <vector>

namespace graze::circle_minimum_test {

TEST(CircleMinimum, IsThatOfTheFunctionAndNotOfItsSamples) {
    for (const double where : {0.0, 0.03, 0.31, 0.5, 0.96}) {
        const auto function = [&](double turns) {
            const double angle = 2 * std::numbers::pi * (turns - where);
            return 3 - std::cos(angle) - 0.2 * std::cos(2 * angle) + 0.1 * std::sin(angle) * (1 - std::cos(angle));
        };
        std::vector<double> samples;
        for (int j = 0; j < 11; ++j)
            samples.push_back(function(j / 11.));
        double least = 3;
        for (int k = -2000; k <= 2000; ++k)
            least = std::min(least, function(where + k * 1e-5));
        EXPECT_NEAR(least_around(samples, function), least, 2e-9) << where;
    }
}

/// The minimum of a motion moves beyond the end of its return: the function goes on with another curvature.
TEST(CircleMinimum, IsFoundWhereTheFunctionBendsAbruptly) {
    for (const double where : {0.0, 0.02, 0.07, 0.46})
        for (const double steeper : {3.0, 300.0}) {
            const auto function = [&](double turns) {
                const double off = turns - where - std::round(turns - where);
                return off * off * (off > 0 ? steeper : 1) - 2;
            };
            std::vector<double> samples;
            for (int j = 0; j < 7; ++j)
                samples.push_back(function(j / 7.));
            EXPECT_NEAR(least_around(samples, function), -2, 1e-14) << where << ' ' << steeper;
        }
}

/// The deeper of two wells need not have the lower sample.
TEST(CircleMinimum, IsThatOfTheDeepestWell) {
    const auto function = [](double turns) {
        const double angle = 2 * std::numbers::pi * (turns + 0.5 - 4. / 9);
        return -std::cos(2 * angle) - 0.02 * std::cos(angle);
    };
    std::vector<double> samples;
    for (int j = 0; j < 9; ++j)
        samples.push_back(function(j / 9.));
    ASSERT_LT(samples[4], samples[0]);
    EXPECT_NEAR(least_around(samples, function), -1.02, 1e-14);
}

/// Some motions have no minimum; next to them it is where they begin to have one.
TEST(CircleMinimum, IsFoundWhereOnlySomeAnglesHaveValues) {
    constexpr double infinity = std::numeric_limits<double>::infinity();
    const auto function = [](double turns) {
        const double off = turns - std::floor(turns) - 0.31;
        return off < 0 || off > 0.4 ? infinity : 1 + off * (1 + off);
    };
    std::vector<double> samples;
    for (int j = 0; j < 9; ++j)
        samples.push_back(function(j / 9.));
    EXPECT_NEAR(least_around(samples, function), 1, 1e-8);
    EXPECT_GE(least_around(samples, function), 1);
}

TEST(CircleMinimum, IsTheLeastSampleWhereTheFunctionIsUnknown) {
    const std::vector<double> samples{1, 0.5, 0.4, 0.7};
    EXPECT_EQ(least_around(samples, [](double) { return std::optional<double>(); }), 0.4);
    const std::vector<double> same{2, 2, 2};
    EXPECT_EQ(least_around(same, [](double) { return std::optional(2.0); }), 2);
}

} // namespace graze::circle_minimum_test
