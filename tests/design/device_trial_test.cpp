// Simulation of devices on both sides of their trip value.

#include "graze/design/device_trial.hpp"

#include "graze/base/input_error.hpp"
#include "switches.hpp"

namespace graze::testing::device_trial_test {

TEST(DeviceTrial, OfTheMemsSwitchAgreesWithItsClass) {
    const auto [design, trip] = with_trip(load_design("mems-switch"));
    const DeviceTrial trial = try_device(trip, trip.point.solution.orbit, class_at(trip), design.trip);
    EXPECT_EQ(trial.outcome, TrialOutcome::agreed);
    EXPECT_LT(trial.below, trip.value());
    EXPECT_GT(trial.above, trip.value());
    EXPECT_EQ(trial.trip.ending, "singular");
}

TEST(DeviceTrial, OfAFoldUsesItsStableBranch) {
    const auto [design, trip] = with_trip(beam_design("[trip]\nuntil = 'penetration=0.009'\n"));
    const DeviceTrial trial = try_device(trip, trip.point.solution.orbit, class_at(trip), design.trip);
    EXPECT_TRUE(trial.rests_below) << trial.seen_below;
    EXPECT_LT(trial.below, trip.value());
    EXPECT_GT(trial.below, 0.99 * trip.value());
    EXPECT_EQ(trial.outcome, TrialOutcome::agreed) << trial.seen_above;
}

TEST(DeviceTrial, ContradictsAWrongClass) {
    const auto [design, trip] = with_trip(load_design("mems-switch"));
    TripClass wrong = class_at(trip);
    wrong.outcome = GrazingOutcome::persists;
    EXPECT_EQ(try_device(trip, trip.point.solution.orbit, wrong, design.trip).outcome, TrialOutcome::contradicted);
    wrong.outcome = GrazingOutcome::undecided;
    EXPECT_EQ(try_device(trip, trip.point.solution.orbit, wrong, design.trip).outcome, TrialOutcome::undecided);
    EXPECT_THROW(try_device(trip, trip.point.solution.orbit, wrong, design.trip, {2, 200, {}}), InputError);
}

} // namespace graze::testing::device_trial_test
