#include "graze/record/record_periods.hpp"

#include "graze/base/input_error.hpp"
#include "record/waves.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace graze::testing {

using ::testing::HasSubstr;

TEST(RecordPeriods, CountPeriodsAndAverageTheAmplitude) {
    StoredSamples source(
        named({"V"}), sampled(100, 1050, {[](double t) { return 3 * std::sin(2 * std::numbers::pi * (t - 0.105)); }}));
    std::vector<std::size_t> numbers;
    const RecordPeriods found =
        each_period(source, {}, [&](const Period& period) { numbers.push_back(period.number); });
    ASSERT_EQ(found.count, 10U);
    EXPECT_EQ(numbers.front(), 0U);
    EXPECT_EQ(numbers.back(), 9U);
    // crossings are found by a cubic; the amplitude depends on the square of their error
    EXPECT_NEAR(found.amplitude, 3, 1e-9);
}

TEST(RecordPeriods, NameTheReferenceThatHasNoWholePeriod) {
    PeriodSettings settings;
    settings.level = 5;
    StoredSamples source(named({"V"}), sampled(100, 1050, {[](double t) { return std::sin(t); }}));
    try {
        each_period(source, settings, [](const Period&) {});
        ADD_FAILURE() << "it was accepted";
    } catch (const InputError& error) {
        EXPECT_THAT(error.what(), HasSubstr("'V' does not rise through 5 twice; choose another reference or level"));
    }
}

} // namespace graze::testing
