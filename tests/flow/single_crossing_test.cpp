#include "flow/single_crossing.hpp"

#include "graze/flow/roots.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>
#include <vector>

namespace single_crossing_test {

using namespace graze;

TEST(SingleCrossing, AgreesWithAllCrossingsBitForBit) {
    std::mt19937_64 random(5);
    std::uniform_real_distribution<double> coefficient(-1, 1);
    RootFinder finder(20);
    std::vector<Root> all;
    int crossing = 0, never = 0;
    for (int i = 0; i < 20'000; ++i) {
        std::vector<double> c(2 + random() % 19);
        double power = 1;
        for (double& one : c) {
            one = coefficient(random) * power;
            power *= 0.4;
        }
        const auto lone = roots::single_crossing(c, 1);
        if (!lone)
            continue;
        EXPECT_EQ(lone->at_start, c[0] > 0 ? 1 : -1);
        finder.crossings(c, 1, RootStart::as_is, all);
        ASSERT_EQ(all.size(), lone->crosses ? 1u : 0u) << i;
        (lone->crosses ? crossing : never) += 1;
        if (lone->crosses) {
            EXPECT_EQ(all[0].at, lone->place(c, 1));
            EXPECT_EQ(all[0].kind, lone->at_start > 0 ? RootKind::falling : RootKind::rising);
        }
    }
    EXPECT_GT(crossing, 1'000);
    EXPECT_GT(never, 4'000);
}

TEST(SingleCrossing, IsLocatedToRoundOff) {
    // exp(s) - a has the root log(a); the root of its series to order 20 differs by 1 / 21!, and by round-off.
    for (const double a : {1.001, 1.5, 2.0, 2.7}) {
        std::vector<double> c(21);
        double factorial = 1;
        for (std::size_t k = 0; k < c.size(); ++k) {
            factorial *= k > 0 ? static_cast<double>(k) : 1;
            c[k] = 1 / factorial;
        }
        c[0] -= a;
        const auto lone = roots::single_crossing(c, 1);
        ASSERT_TRUE(lone && lone->crosses);
        EXPECT_NEAR(lone->place(c, 1), std::log(a), 8 * std::numeric_limits<double>::epsilon());
    }
}

TEST(SingleCrossing, IsUncertainForOtherPolynomials) {
    const auto is_open = [](const std::vector<double>& c, double length) {
        return !roots::single_crossing(c, length).has_value();
    };
    EXPECT_TRUE(is_open({}, 1));
    EXPECT_TRUE(is_open({0, 1}, 1));
    EXPECT_TRUE(is_open({1, -1}, 1));            // zero at the end
    EXPECT_TRUE(is_open({0.24, -1, 1}, 1));      // two crossings
    EXPECT_TRUE(is_open({0.2, -1.2, 2, -1}, 1)); // three crossings cannot be separated by the cheap test
    EXPECT_TRUE(is_open({1, 1}, 0));
    EXPECT_TRUE(is_open({1, 1}, std::numeric_limits<double>::infinity()));
}

} // namespace single_crossing_test
