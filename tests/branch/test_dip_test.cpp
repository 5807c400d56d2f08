// Two zeros of functions with closed forms, far closer to each other than to the ends between which they are searched.

#include "branch/test_dip.hpp"

#include "base/special_numbers.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace graze::test_dip_test {

/// Zero at `at` and at a distance behind it, and not symmetric.
struct Function {
    double at, apart;
    double operator()(double s) const { return (s - at) * (s - at - apart) * (1 + 0.3 * std::sin(s)); }
    TestValue value(double s) const { return {s, (*this)(s)}; }
};

TEST(TestDip, IsFoundHoweverCloseItsZerosAre) {
    for (const double apart : {1e-1, 1e-3, 1e-5})
        for (const double at : {0.02, 0.37, 0.8}) {
            const Function function{at, apart};
            const auto place =
                possible_dip(function.value(-2), function.value(-1), function.value(0), function.value(1));
            ASSERT_TRUE(place) << at << ' ' << apart;
            const auto dip = dip_between(function.value(0), function.value(1), *place, 1e-3 * apart * apart, function);
            ASSERT_TRUE(dip) << at << ' ' << apart;
            EXPECT_GT(dip->before.value, 0);
            EXPECT_LT(dip->within.value, 0);
            EXPECT_GT(dip->behind.value, 0);
            EXPECT_LT(dip->before.fraction, at);
            EXPECT_GT(dip->within.fraction, at);
            EXPECT_LT(dip->within.fraction, at + apart);
            EXPECT_GT(dip->behind.fraction, at + apart);
        }
}

TEST(TestDip, IsNoneWhereTheMinimumIsPositiveOrRoundOff) {
    const auto above = [](double s) { return 1e-6 + (s - 0.4) * (s - 0.4); };
    const auto touching = [](double s) { return (s - 0.4) * (s - 0.4) - 1e-15; };
    const auto value = [](const auto& function, double s) { return TestValue{s, function(s)}; };
    EXPECT_FALSE(dip_between(value(above, 0), value(above, 1), 0.4, 0, above));
    EXPECT_FALSE(dip_between(value(touching, 0), value(touching, 1), 0.4, 1e-13, touching));
    const auto far = [](double s) { return 1 + (s - 0.4) * (s - 0.4); };
    EXPECT_FALSE(possible_dip({not_a_number, not_a_number}, value(far, -1), value(far, 0), value(far, 1)));
    const auto monotonic = [](double s) { return std::exp(s); };
    EXPECT_FALSE(possible_dip(value(monotonic, -2), value(monotonic, -1), value(monotonic, 0), value(monotonic, 1)));
}

TEST(TestDip, NeedsNoFourthPoint) {
    const Function function{0.3, 1e-2};
    const auto place =
        possible_dip({not_a_number, not_a_number}, function.value(-1), function.value(0), function.value(1));
    ASSERT_TRUE(place);
    EXPECT_TRUE(dip_between(function.value(0), function.value(1), *place, 0, function));
}

} // namespace graze::test_dip_test
