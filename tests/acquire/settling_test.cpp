#include "graze/acquire/settling.hpp"

#include "graze/base/input_error.hpp"

#include <cmath>
#include <gtest/gtest.h>

namespace graze::settling_test {

std::size_t period_of(const std::function<double(int)>& value, int sections) {
    RepeatWatch watch({1e-3}, 3, 4);
    for (int i = 0; i < sections; ++i)
        watch.add({value(i)});
    return watch.period();
}

TEST(RepeatWatch, FindsTheShortestPeriod) {
    EXPECT_EQ(period_of([](int) { return 1.0; }, 4), 1U);
    EXPECT_EQ(period_of([](int) { return 1.0; }, 3), 0U) << "three repeats need four sections";
    EXPECT_EQ(period_of([](int i) { return i % 2 + 0.0; }, 8), 2U);
    EXPECT_EQ(period_of([](int i) { return i % 3 + 0.0; }, 12), 3U);
    EXPECT_EQ(period_of([](int i) { return i % 5 + 0.0; }, 100), 0U) << "longer than is looked for";
    EXPECT_EQ(period_of([](int i) { return std::cos(i * 1.7); }, 1000), 0U);
    EXPECT_EQ(period_of([](int i) { return std::exp(-0.5 * i); }, 12), 0U);
    EXPECT_EQ(period_of([](int i) { return std::exp(-0.5 * i); }, 17), 1U); // exp(-7)(e^0.5 - 1) < 1e-3
}

TEST(RepeatWatch, RefusesInvalidNumbers) {
    EXPECT_THROW(period_of([](int) { return std::nan(""); }, 20), InputError);
}

} // namespace graze::settling_test
