// Tests whose values are known functions of the arclength.

#include "branch/test_forecast.hpp"

#include "base/special_numbers.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <vector>

namespace graze::test_forecast_test {

using TestFunction = std::function<double(double)>;

std::vector<BranchTest> tests_at(double arclength, const std::vector<TestFunction>& functions) {
    std::vector<BranchTest> tests;
    for (const TestFunction& one : functions)
        tests.push_back({.type = PointType::flip, .value = one(arclength)});
    return tests;
}

/// Points at 0, 0.1, 0.2 and 0.3.
TestForecast forecast_of(const std::vector<TestFunction>& functions) {
    TestForecast forecast;
    for (int i = 0; i < 4; ++i)
        forecast.add(0.1 * i, tests_at(0.1 * i, functions));
    return forecast;
}

constexpr double usual = 0.05, longest = 0.4;

TEST(TestForecast, AllowsLongStepsWhereTestsAreFarFromZero) {
    const std::vector<TestFunction> functions{[](double s) { return 2 + s; }, [](double s) { return -std::exp(s); }};
    const TestForecast forecast = forecast_of(functions);
    EXPECT_EQ(forecast.length(usual, longest), longest);
    EXPECT_TRUE(forecast.foresees(0.7, tests_at(0.7, functions)));
}

/// Four usual steps are left between the end of a long one and the zero.
TEST(TestForecast, EndsStepsBeforeZeros) {
    for (const auto& [zero, length] : {std::pair(1.0, longest), {0.8, 0.2}, {0.65, 0.1}, {0.5, usual}})
        EXPECT_EQ(forecast_of({[zero = zero](double s) { return s - zero; }}).length(usual, longest), length) << zero;
}

/// The test is positive everywhere, or has two zeros at a distance of 2e-3.
TEST(TestForecast, EndsStepsBeforeDips) {
    for (const double least : {1e-6, -1e-6}) {
        const std::vector<TestFunction> functions{[&](double s) { return (s - 0.5) * (s - 0.5) + least; }};
        EXPECT_LT(forecast_of(functions).length(usual, longest), 0.2);
    }
}

TEST(TestForecast, TellsTestsThatHaveChangedTheirShape) {
    const TestForecast forecast = forecast_of({[](double s) { return 2 + s; }});
    EXPECT_TRUE(forecast.foresees(0.7, tests_at(0.7, {[](double) { return 2.6; }})));
    EXPECT_FALSE(forecast.foresees(0.7, tests_at(0.7, {[](double) { return 2.0; }})));
    EXPECT_FALSE(forecast.foresees(0.7, tests_at(0.7, {[](double) { return -2.7; }})));
    EXPECT_FALSE(forecast.foresees(0.7, tests_at(0.7, {[](double) { return not_a_number; }})));
}

TEST(TestForecast, KnowsNothingFromFewPointsOrTestsThatAppear) {
    TestForecast forecast;
    const std::vector<TestFunction> one{[](double) { return 1.0; }},
        appears{[](double s) { return s < 0.15 ? not_a_number : 1.0; }}, never{[](double) { return not_a_number; }};
    for (int i = 0; i < 3; ++i)
        forecast.add(0.1 * i, tests_at(0.1 * i, one));
    EXPECT_EQ(forecast.length(usual, longest), usual);
    EXPECT_FALSE(forecast.foresees(0.4, tests_at(0.4, one)));
    EXPECT_EQ(forecast_of(appears).length(usual, longest), usual);
    EXPECT_EQ(forecast_of(never).length(usual, longest), longest);
    forecast = forecast_of(one);
    forecast.forget();
    EXPECT_EQ(forecast.length(usual, longest), usual);
}

/// Bounds of parameters, and values below their noise, do not shorten steps.
TEST(TestForecast, IgnoresWhatSaysNothing) {
    TestForecast forecast;
    for (int i = 0; i < 4; ++i)
        forecast.add(0.1 * i, {{.type = PointType::bound, .value = 0.35 - 0.1 * i},
                               {.type = PointType::fold, .value = i % 2 == 0 ? 1e-9 : -1e-9, .noise = 1e-8}});
    EXPECT_EQ(forecast.length(usual, longest), longest);
}

/// In units half as large lengths are twice as long, and the test has three times its value.
TEST(TestForecast, ChangesToNewUnits) {
    TestForecast forecast = forecast_of({[](double s) { return 1 + s; }});
    const TestFunction in_units = [](double s) { return 3 * (1 + 0.3 + (s - 0.3) / 2); };
    forecast.rescale(2, tests_at(0.3, {in_units}));
    EXPECT_TRUE(forecast.foresees(0.7, tests_at(0.7, {in_units})));
    EXPECT_FALSE(forecast.foresees(0.7, tests_at(0.7, {[](double s) { return 3 * (1 + s); }})));
    EXPECT_EQ(forecast.length(usual, longest), longest);
}

} // namespace graze::test_forecast_test
