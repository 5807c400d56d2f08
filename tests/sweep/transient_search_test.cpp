#include "settle.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

namespace graze::transient_search_test {

/// x'' + x = 0 from x = 0.5 at rest, and a wall at x = `wall`.
Model before_wall(double wall, double time = 1) {
    return testing::OneMode{.parameters = fmt::format("T = {:.17g}", time),
                            .states = "x = 0.5\nv = 0",
                            .rates = "x = 'v/T', v = '-x/T'",
                            .clock = "1/T",
                            .stops = {{"wall", fmt::format("x + {}", wall), "v = '-v'"}},
                            .more = testing::section("rest", "v", "falling") + testing::at_phase(0, "turn") +
                                    "[sections.never]\nfunction = 'x - 9'"}
        .model();
}

PointResult simulated(const Model& model, const TransientOptions& options) {
    return result_of(*transient_searches(System(model), options, {}, {}, {}), model, model.initial_state());
}

TEST(TransientSearch, EndsAfterTheRequestedContacts) {
    // The wall at the middle is met after pi/2, then every pi.
    const PointResult result = simulated(before_wall(0), {.contacts = 3, .counted = {0}});
    EXPECT_EQ(result.label, Label::ended);
    EXPECT_NEAR(result.time, 2.5 * std::acos(-1.0), 1e-10);
}

/// In any unit of time: the limit is a number of steps.
TEST(TransientSearchSlow, GivesUpEventsThatDoNotHappen) {
    for (const double time : {1.0, 1e-9, 1e9}) {
        const PointResult result = simulated(before_wall(1, time), {.contacts = 3, .counted = {0}});
        EXPECT_EQ(result.label, Label::failed);
        EXPECT_EQ(result.outcome.ending, Ending::step_limit);
        EXPECT_GT(result.time, 1e5 * time);
        EXPECT_THAT(result.outcome.detail, ::testing::HasSubstr("no contact that ends the motion"));
        EXPECT_THAT(result.outcome.detail, ::testing::HasSubstr("give a time too"));
    }
    // A motion at rest takes a single step, in which only the phase passes the section.
    Model rest = before_wall(1);
    rest.set_initial("x", 0);
    EXPECT_EQ(simulated(rest, {.section = "turn", .contacts = 3, .counted = {0}}).outcome.ending, Ending::step_limit);
    // There are contacts, but too slow ones.
    const PointResult slow = simulated(before_wall(0), {.counted = {0}, .greatest_speed = 2});
    EXPECT_EQ(slow.outcome.ending, Ending::step_limit);
    const PointResult skipped =
        simulated(before_wall(0), {.section = "never", .time = 1, .skip_periods = 1, .counted = {0}});
    EXPECT_EQ(skipped.label, Label::failed);
    EXPECT_THAT(skipped.outcome.detail, ::testing::HasSubstr("skip a time instead of periods"));
}

TEST(TransientSearchSlow, WaitsForTheRequestedTime) {
    const PointResult result = simulated(before_wall(1), {.time = 4e6, .contacts = 3, .counted = {0}});
    EXPECT_EQ(result.label, Label::ended);
    EXPECT_EQ(result.time, 4e6);
}

} // namespace graze::transient_search_test
