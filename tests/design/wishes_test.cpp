// Dimensions that have what is wanted, checked by devices that are found from scratch.

#include "graze/design/wishes.hpp"

#include "graze/symbolic/input_error.hpp"
#include "switches.hpp"

namespace graze::testing {

TEST(Wishes, OfAnOscillatorAreMetByTheNearestDevice) {
    const Design design = parse_design(oscillator_text("[wanted]\nvalue = 0.2\n"), "d.toml");
    const MetWishes met = meet_wishes(design, trip_of(design));
    ASSERT_EQ(met.found.outcome, WishOutcome::met) << met.found.reason;
    const std::vector<double> values = met.values();
    EXPECT_NEAR(oscillator_value(values[0], values[1]), 0.2, 1e-9);
    // Nearest in widths of the ranges: there the gradient of the distance is along that of the trip value.
    const double sigma = values[0], zeta = values[1], root = oscillator_value(1, zeta);
    const double across = (sigma - 0.2) / (0.3 * 0.3), up = (zeta - 0.1) / (0.25 * 0.25);
    EXPECT_NEAR(across * (sigma * zeta / root), up * root, 1e-6);
    // The device is what it was promised to be.
    EXPECT_NEAR(trip_of(with_values(design, values)).value(), 0.2, 1e-9);
}

TEST(Wishes, ThatCannotBeMetSayWhatBinds) {
    const Design design = parse_design(oscillator_text("[wanted]\nvalue = 0.9\n"), "d.toml");
    const MetWishes met = meet_wishes(design, trip_of(design));
    EXPECT_EQ(met.found.outcome, WishOutcome::unmet);
    ASSERT_EQ(met.found.wants.size(), 1U);
    EXPECT_FALSE(met.found.wants[0].met);
    EXPECT_TRUE(met.found.wants[0].binds);
    // As far as it goes: both at the ends of their ranges.
    EXPECT_NEAR(*met.found.wants[0].value, oscillator_value(0.4, 0.3), 1e-6);
    EXPECT_TRUE(met.found.dimensions[0].at_highest && met.found.dimensions[1].at_highest);
}

TEST(Wishes, ForASensitivityAreMetByTheDerivative) {
    // Relative derivative by zeta: (2 zeta omega)^2 / root^2, which is to be no more than 1 percent.
    const Design design = parse_design(oscillator_text("[wanted]\nsensitivity = { zeta = 0.01 }\n"), "d.toml");
    const MetWishes met = meet_wishes(design, trip_of(design));
    ASSERT_EQ(met.found.outcome, WishOutcome::met) << met.found.reason;
    const double zeta = met.values()[1], root = oscillator_value(1, zeta);
    EXPECT_NEAR(zeta * zeta / (root * root), 0.01, 1e-8);
}

TEST(Wishes, ForAClassAreMetBeyondItsBoundary) {
    // Twice the natural frequency and more damping than critical has real positive multipliers: all persist. Below
    // critical damping some later contact is always hit, and the class is the other one.
    const std::string text = R"(name = "calm"
model = "impact-oscillator"
control = "amplitude"
set = { zeta = 0.5, sigma = 0.2, omega = 2 }
[approach]
range = [0.05, 10]
event = "stop"
[trip]
overshoots = [1e-3]
[dimensions.zeta]
range = [0.3, 1.6]
[wanted]
class = "persists"
)";
    const Design design = parse_design(text, "d.toml");
    const TripPoint first = trip_of(design);
    EXPECT_EQ(class_at(first).outcome, GrazingOutcome::lost);
    const MetWishes met = meet_wishes(design, first);
    ASSERT_EQ(met.found.outcome, WishOutcome::met) << met.found.reason;
    EXPECT_EQ(class_at(trip_of(with_values(design, met.values()))).outcome, GrazingOutcome::persists)
        << met.values().front();
}

TEST(Wishes, ForAWayBackThatIsNotThereAreRefused) {
    Design design = load_design("mems-switch");
    design.wanted.least_reset = 0.1;
    design.wanted.greatest_reset = 0.2;
    EXPECT_THROW(meet_wishes(design, trip_of(design)), InputError);
}

} // namespace graze::testing
