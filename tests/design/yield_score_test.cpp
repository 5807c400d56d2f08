#include "design/yield_score.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace graze::yield_score_test {

constexpr double infinite = std::numeric_limits<double>::infinity();

double share_below(double score) {
    return 0.5 * std::erfc(-score / std::sqrt(2.0));
}

TEST(YieldScore, OfOneLimitIsTheDistanceInDeviations) {
    for (const double way : {-1000.0, -40.0, -30.0, -5.0, -1.0, 0.0, 0.5, 3.0, 8.0, 30.0, 1000.0}) {
        EXPECT_NEAR(yield_score(2, infinite, 2 + 0.1 * way, 0.1), way, 1e-9 * (1 + std::abs(way))) << way;
        EXPECT_NEAR(yield_score(-infinite, 2, 2 - 0.1 * way, 0.1), way, 1e-9 * (1 + std::abs(way))) << way;
    }
}

TEST(YieldScore, OfTwoLimitsEqualsTheScoreOfTheShareBetween) {
    for (const double value : {-3.0, -1.0, 0.0, 0.3, 1.0, 1.5, 4.0})
        for (const double deviation : {0.1, 0.5, 2.0}) {
            const double share = share_below((1 - value) / deviation) - share_below((0 - value) / deviation);
            if (share < 1e-12 || share > 1 - 1e-9) // beyond the resolution of a difference of shares
                continue;
            EXPECT_NEAR(share_below(yield_score(0, 1, value, deviation)), share, 1e-11) << value << ' ' << deviation;
        }
}

TEST(YieldScore, HasAGradientFarOutsideTheLimits) {
    double last = -infinite;
    for (double value = -1e4; value <= 0.5; value += 13.7) {
        const double score = yield_score(0, 1, value, 0.25);
        EXPECT_TRUE(std::isfinite(score)) << value;
        EXPECT_GT(score, last) << value;
        last = score;
    }
    EXPECT_NEAR(yield_score(0, 1, 0.25, 0.25), yield_score(0, 1, 0.75, 0.25), 1e-12);
    EXPECT_TRUE(std::isfinite(yield_score(0, 1, 0.5, 1e-12)));
    EXPECT_TRUE(std::isfinite(yield_score(0, 1e-9, 0.5, 1)));
}

TEST(YieldScore, OfAShareIsTheNormalQuantile) {
    EXPECT_NEAR(score_of_share(0.5), 0, 1e-15);
    EXPECT_NEAR(score_of_share(0.975), 1.959963984540054, 1e-12); // tabulated
    EXPECT_NEAR(score_of_share(0.025), -1.959963984540054, 1e-12);
    EXPECT_NEAR(score_of_share(0.9999), 3.719016485455709, 1e-11);
    for (const double share : {1e-6, 0.1, 0.6, 1 - 1e-6})
        EXPECT_NEAR(share_below(score_of_share(share)), share, 1e-13);
}

} // namespace graze::yield_score_test
