#include "branch/circle_minimum.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
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

TEST(CircleMinimum, IsTheLeastSampleWhereTheFunctionIsUnknown) {
    const std::vector<double> samples{1, 0.5, 0.4, 0.7};
    EXPECT_EQ(least_around(samples, [](double) { return std::optional<double>(); }), 0.4);
    const std::vector<double> same{2, 2, 2};
    EXPECT_EQ(least_around(same, [](double) { return std::optional(2.0); }), 2);
}

} // namespace graze::circle_minimum_test
