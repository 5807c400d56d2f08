#include "graze/record/record_periods.hpp"

#include "graze/base/input_error.hpp"
#include "record/waves.hpp"

#include <gmock/gmock.h>

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
    const auto refusal = [&](const std::string& asked_as) -> std::string {
        StoredSamples source(named({"V"}), sampled(100, 1050, {[](double t) { return std::sin(t); }}));
        try {
            each_period(
                source, settings, [](const Period&) {}, asked_as);
        } catch (const InputError& error) {
            return error.what();
        }
        return "";
    };
    EXPECT_THAT(refusal(""), HasSubstr("'V' does not rise through 5 twice; choose another reference or level"));
    EXPECT_THAT(refusal("--"), HasSubstr("choose another --reference or --level, or record more periods"));
}

} // namespace graze::testing
