// Simulation of devices on both sides of their trip value.

#include "graze/design/device_trial.hpp"

#include "graze/base/input_error.hpp"
#include "switches.hpp"

namespace graze::testing {

TEST(DeviceTrial, OfTheMemsSwitchAgreesWithItsClass) {
    const Design design = load_design("mems-switch");
    const TripPoint trip = trip_of(design);
    const DeviceTrial trial = try_device(trip, trip.point.solution.orbit, class_at(trip), design.trip);
    EXPECT_EQ(trial.outcome, TrialOutcome::agreed);
    EXPECT_LT(trial.below, trip.value());
    EXPECT_GT(trial.above, trip.value());
    EXPECT_EQ(trial.trip.ending, "singular");
}

TEST(DeviceTrial, OfAFoldUsesItsStableBranch) {
    const Design design = parse_design(R"(name = "beam"
control = "V"
[approach]
study = "microbeam"
run = "contact"
point = "SN1"
[trip]
until = "penetration=0.009"
[dimensions.k]
range = [50, 200]
)",
                                       "d.toml");
    const TripPoint trip = trip_of(design);
    const DeviceTrial trial = try_device(trip, trip.point.solution.orbit, class_at(trip), design.trip);
    EXPECT_TRUE(trial.rests_below) << trial.seen_below;
    EXPECT_LT(trial.below, trip.value());
    EXPECT_GT(trial.below, 0.99 * trip.value());
    EXPECT_EQ(trial.outcome, TrialOutcome::agreed) << trial.seen_above;
}

TEST(DeviceTrial, ContradictsAWrongClass) {
    const Design design = load_design("mems-switch");
    const TripPoint trip = trip_of(design);
    TripClass wrong = class_at(trip);
    wrong.outcome = GrazingOutcome::persists;
    EXPECT_EQ(try_device(trip, trip.point.solution.orbit, wrong, design.trip).outcome, TrialOutcome::contradicted);
    wrong.outcome = GrazingOutcome::undecided;
    EXPECT_EQ(try_device(trip, trip.point.solution.orbit, wrong, design.trip).outcome, TrialOutcome::undecided);
    EXPECT_THROW(try_device(trip, trip.point.solution.orbit, wrong, design.trip, {2, 200, {}}), InputError);
}

} // namespace graze::testing
