#include "branch/resonances.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <string>

namespace graze::resonances_test {

std::string between(double from, double to) {
    std::string text;
    for (const Resonance& one : resonances_between(from, to))
        text += fmt::format("{}/{} ", one.numerator, one.denominator);
    return text;
}

TEST(Resonances, AreToldInTheOrderInWhichTheyArePassed) {
    EXPECT_EQ(between(0.3, 0.19), "2/7 3/11 1/4 2/9 1/5 ");
    EXPECT_EQ(between(0.19, 0.3), "1/5 2/9 1/4 3/11 2/7 3/10 ");
    EXPECT_EQ(between(0.46, 0.54), "1/2 ");
    EXPECT_EQ(between(0.26, 0.27), "");
    EXPECT_EQ(between(-0.01, 0.01), "0/1 ");
    EXPECT_EQ(between(-0.19, -0.21), "-1/5 ");
    EXPECT_EQ(between(0.99, 1.01), "1/1 ");
}

// So that none is passed twice.
TEST(Resonances, ThoseAtTheEndCountAndThoseAtTheBeginningDoNot) {
    EXPECT_EQ(between(0.2, 0.25), "2/9 1/4 ");
    EXPECT_EQ(between(0.25, 0.2), "2/9 1/5 ");
    EXPECT_EQ(between(0.25, 0.25), "");
}

TEST(Resonances, TheNearestHasTheSmallestDenominator) {
    const auto third = resonance_near(0.334, 1e-3);
    ASSERT_TRUE(third);
    EXPECT_EQ(third->numerator, 1);
    EXPECT_EQ(third->denominator, 3U);
    EXPECT_TRUE(third->is_strong());
    EXPECT_FALSE(resonance_near(0.19, 1e-3));
    const auto fifth = resonance_near(0.4, 0.001);
    ASSERT_TRUE(fifth);
    EXPECT_EQ(fifth->denominator, 5U);
    EXPECT_FALSE(fifth->is_strong());
}

} // namespace graze::resonances_test
