#include "graze/study/run_length.hpp"

#include "graze/model/catalogue.hpp"

#include "study_fixture.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <numbers>

namespace graze::run_length_test {

using ::testing::HasSubstr;

TEST(RunLength, HasTwentyPeriodsUnlessSomethingElseIsAsked) {
    Model model = load_model("impact-oscillator");
    model.set_parameter("omega", 2);
    const RunLength length = run_length(model, {});
    EXPECT_EQ(length.shown.periods, 20U);
    EXPECT_NEAR(*length.shown.expected, 20 * std::numbers::pi, 1e-12);
    EXPECT_TRUE(length.transient.empty());
    ASSERT_TRUE(length.period);
}

TEST(RunLength, OfATimeCountsNoPeriods) {
    const RunLength length = run_length(load_model("impact-oscillator"), {.time = 3.5, .after = 1});
    EXPECT_EQ(length.shown.duration, 3.5);
    EXPECT_EQ(length.transient.duration, 1);
    EXPECT_FALSE(length.period);
}

TEST(RunLength, RefusesContradictions) {
    const Model model = load_model("impact-oscillator");
    const auto refusal = [&](const RunLengthRequest& request) {
        return testing::message_of([&] { run_length(model, request); });
    };
    EXPECT_THAT(refusal({.time = 1, .periods = 2}), HasSubstr("time and periods cannot be given together"));
    EXPECT_THAT(refusal({.periods = 0}), HasSubstr("periods: 0 is not a positive number"));
    EXPECT_THAT(refusal({.periods = 1, .phase = "x"}), HasSubstr("'x' is no cyclic state"));
    EXPECT_THAT(refusal({.time = 1, .phase = "theta"}), HasSubstr("no periods are counted"));
}

} // namespace graze::run_length_test
