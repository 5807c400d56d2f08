#include "graze/base/time_left.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

namespace graze::time_left_test {

/// Feeds the durations of points and calls `look` with each estimate.
template <class Look>
void follow(const std::vector<double>& durations, const Look& look) {
    TimeLeft left;
    double now = 0, all = 0;
    for (const double duration : durations)
        all += duration;
    for (std::size_t i = 0; i < durations.size(); ++i) {
        now += durations[i];
        left.note(i + 1, now);
        look(left.of(durations.size() - i - 1), all - now, i + 1);
    }
}

TEST(TimeLeft, IsExactForEqualPoints) {
    follow(std::vector<double>(1000, 0.05), [](const auto& shown, double truth, std::size_t done) {
        ASSERT_EQ(shown.has_value(), done >= 10);
        if (!shown)
            return;
        EXPECT_NEAR(shown->seconds, truth, 1e-6 + 1e-9 * truth);
        EXPECT_FALSE(shown->at_least);
    });
}

/// Points that become ten times slower in the second half, or ever slower: the first ones suggest too little time.
TEST(TimeLeft, NeverRisesAndIsMarkedAsABoundWherePointsBecomeSlower) {
    std::vector<std::vector<double>> all(3, std::vector<double>(800));
    std::mt19937 random(11);
    for (std::size_t i = 0; i < 800; ++i) {
        all[0][i] = i < 400 ? 0.02 : 0.2;
        all[1][i] = 0.001 * static_cast<double>(i + 1);
        all[2][i] = 0.1 * -std::log((static_cast<double>(random() % 1000) + 0.5) / 1000); // at random
    }
    for (const auto& durations : all) {
        double before = 1e300;
        follow(durations, [&](const auto& shown, double truth, std::size_t) {
            if (!shown)
                return;
            EXPECT_LE(shown->seconds, before);
            before = shown->seconds;
            // An estimate that is marked as a lower bound is one.
            if (shown->at_least) {
                EXPECT_LE(shown->seconds, 1.2 * truth);
            }
        });
    }
    // For points that become ever faster the estimate is never too small.
    std::vector<double> faster = all[1];
    std::reverse(faster.begin(), faster.end());
    follow(faster, [](const auto& shown, double truth, std::size_t) {
        if (shown) {
            EXPECT_GE(shown->seconds, 0.99 * truth);
        }
    });
}

} // namespace graze::time_left_test
