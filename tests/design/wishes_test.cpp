// Devices that meet requirements, checked by solving for them from scratch.

#include "graze/design/wishes.hpp"

#include "graze/base/input_error.hpp"
#include "switches.hpp"

#include <algorithm>

namespace graze::testing::wishes_test {

TEST(Wishes, AreMetByTheNearestDevice) {
    const Design design = oscillator_design("[wanted]\nvalue = 0.2\n");
    const MetWishes met = meet_wishes(design, trip_of(design));
    ASSERT_EQ(met.found.outcome, WishOutcome::met) << met.found.reason;
    const std::vector<double> values = met.values();
    EXPECT_NEAR(oscillator_value(values[0], values[1]), 0.2, 1e-9);
    // At the nearest device (in widths of the ranges) the gradient of the distance is parallel to that of the trip
    // value.
    const double sigma = values[0], zeta = values[1], root = oscillator_value(1, zeta);
    const double across = (sigma - 0.2) / (0.3 * 0.3), up = (zeta - 0.1) / (0.25 * 0.25);
    EXPECT_NEAR(across * (sigma * zeta / root), up * root, 1e-6);
    // The device has the predicted trip value.
    EXPECT_NEAR(trip_of(with_values(design, values)).value(), 0.2, 1e-9);
}

TEST(Wishes, ThatCannotBeMetNameTheActiveLimits) {
    const Design design = oscillator_design("[wanted]\nvalue = 0.9\n");
    const MetWishes met = meet_wishes(design, trip_of(design));
    EXPECT_EQ(met.found.outcome, WishOutcome::unmet);
    ASSERT_EQ(met.found.wants.size(), 1U);
    EXPECT_FALSE(met.found.wants[0].met);
    EXPECT_TRUE(met.found.wants[0].binds);
    // The closest device: both at the ends of their ranges.
    EXPECT_NEAR(*met.found.wants[0].value, oscillator_value(0.4, 0.3), 1e-6);
    EXPECT_TRUE(met.found.dimensions[0].at_highest && met.found.dimensions[1].at_highest);
}

TEST(Wishes, ForASensitivityAreMetByTheDerivative) {
    // Relative derivative by zeta: (2 zeta omega)^2 / root^2, which must be at most 1 percent.
    const Design design = oscillator_design("[wanted]\nsensitivity = { zeta = 0.01 }\n");
    const MetWishes met = meet_wishes(design, trip_of(design));
    ASSERT_EQ(met.found.outcome, WishOutcome::met) << met.found.reason;
    const double zeta = met.values()[1], root = oscillator_value(1, zeta);
    EXPECT_NEAR(zeta * zeta / (root * root), 0.01, 1e-8);
}

TEST(Wishes, ForAClassAreMetBeyondItsBoundary) {
    // At twice the natural frequency with more than critical damping the multipliers are real and positive: all
    // persist. Below critical damping some later contact is hit, and the class is the other one.
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
    const auto [design, first] = with_trip(parse_design(text, "d.toml"));
    EXPECT_EQ(class_at(first).outcome, GrazingOutcome::lost);
    const MetWishes met = meet_wishes(design, first);
    ASSERT_EQ(met.found.outcome, WishOutcome::met) << met.found.reason;
    EXPECT_EQ(class_at(trip_of(with_values(design, met.values()))).outcome, GrazingOutcome::persists)
        << met.values().front();
}

/// The trip value V is proportional to sigma, made to 1 percent: its deviation is V/100.
double share_within(double least, double greatest, double value) {
    const auto below = [&](double limit) { return 0.5 * std::erfc((value - limit) / (0.01 * value) / std::sqrt(2.0)); };
    return below(greatest) - below(least);
}

TEST(Wishes, ForAYieldAreMetByCountedDevices) {
    Design design = oscillator_design("[wanted]\nvalue = [0.198, 0.206]\nyield = 0.9\n");
    design.yield.devices = 2000;
    const MetWishes met = meet_wishes(design, trip_of(design));
    ASSERT_EQ(met.found.outcome, WishOutcome::met) << met.found.reason;
    ASSERT_EQ(met.list.wants.size(), 2U);
    EXPECT_EQ(met.list.wants[1].name, "yield");
    EXPECT_EQ(met.list.wants[1].least, 0.9);
    EXPECT_GE(*met.found.wants[1].value, 0.9); // by counting
    // The nearest device has no more than is wanted; for 2000 devices the share has a standard error of 0.7 percent.
    EXPECT_NEAR(share_within(0.198, 0.206, *met.trip_value), 0.9, 0.025);

    design.wanted.least_yield = 1; // all devices
    const MetWishes all = meet_wishes(design, trip_of(design));
    EXPECT_NE(all.found.outcome, WishOutcome::met); // 0.206/0.198 is 4 deviations: 95 percent at most
    EXPECT_FALSE(all.found.wants[1].met);
    EXPECT_GT(*all.found.wants[1].value, 0.93);
    EXPECT_NE(all.found.reason.find("the yield"), std::string::npos) << all.found.reason;
}

/// If a search by derivatives misses the yield, the counted devices decide.
TEST(Wishes, ForAYieldAreDecidedByCountedDevicesHoweverTheSearchEnded) {
    for (const std::size_t evaluations : {1, 3, 8})
        for (const double share : {0.85, 0.9, 0.92, 0.94}) {
            Design design = oscillator_design("[wanted]\nvalue = [0.198, 0.206]\nyield = 0.9\n");
            design.wanted.least_yield = share;
            WishesOptions options;
            options.evaluations = evaluations;
            const MetWishes one = meet_wishes(design, trip_of(design), options);
            if (one.found.outcome == WishOutcome::nowhere)
                continue;
            const bool all = std::all_of(one.found.wants.begin(), one.found.wants.end(),
                                         [](const FoundWant& want) { return want.met; });
            EXPECT_EQ(one.found.outcome == WishOutcome::met, all) << one.found.reason;
            EXPECT_EQ(one.found.reason.empty(), all) << one.found.reason;
        }
}

TEST(Wishes, ForAYieldFarFromTheStartAreMet) {
    // No device made like the first is within the limits, nor any near it.
    Design design = oscillator_design("within = [0.29, 0.31]\n[wanted]\nyield = 0.95\n");
    const MetWishes met = meet_wishes(design, trip_of(design));
    ASSERT_EQ(met.found.outcome, WishOutcome::met) << met.found.reason;
    EXPECT_NEAR(share_within(0.29, 0.31, *met.trip_value), 0.95, 0.06); // for 200 devices
    design.yield.least = 0.2999;                                        // a thirtieth of a deviation to either side
    design.yield.greatest = 0.3001;
    const MetWishes narrow = meet_wishes(design, trip_of(design));
    EXPECT_NE(narrow.found.outcome, WishOutcome::met);
    EXPECT_LT(*narrow.found.wants[0].value, 0.2);
    EXPECT_FALSE(narrow.found.wants[0].met);
}

TEST(Wishes, OfADeviceAreEvaluatedWithoutASearch) {
    const Design design =
        oscillator_design("[wanted]\nvalue = [0.15, 0.16]\nclass = \"trips\"\nsensitivity = { zeta = 0.001 }\n");
    const MetWishes at = wishes_at(design, trip_of(design));
    ASSERT_EQ(at.found.wants.size(), 3U);
    EXPECT_EQ(at.values(), (std::vector{0.2, 0.1}));
    EXPECT_NEAR(*at.found.wants[0].value, oscillator_value(0.2, 0.1), 1e-9);
    EXPECT_TRUE(at.found.wants[0].met);
    const double root = oscillator_value(1, 0.1);
    EXPECT_NEAR(*at.found.wants[2].value, 0.01 / (root * root), 1e-8);
    EXPECT_FALSE(at.found.wants[2].met);
    EXPECT_EQ(at.found.outcome, WishOutcome::unmet);
}

TEST(Wishes, ThatTheRangeOfTheApproachPreventsNameIt) {
    std::string text = oscillator_text("[wanted]\nvalue = 0.28\n");
    text.replace(text.find("range = [0.01, 1]"), 17, "range = [0.01, 0.25]");
    const MetWishes met = [&] {
        const Design design = parse_design(text, "d.toml");
        WishesOptions options;
        options.evaluations = 300; // at the end of existing devices it continues in small steps
        return meet_wishes(design, trip_of(design), options);
    }();
    EXPECT_NE(met.found.outcome, WishOutcome::met);
    EXPECT_NEAR(*met.trip_value, 0.25, 0.01); // as near as the range allows
    EXPECT_NE(met.found.reason.find("the trip value (0.28 is wanted)"), std::string::npos) << met.found.reason;
    EXPECT_NE(met.found.reason.find("approach.range, 0.01 to 0.25"), std::string::npos) << met.found.reason;
    EXPECT_NE(met.found.reason.find("widen it"), std::string::npos) << met.found.reason;
}

TEST(Wishes, ForAResetValueThatDoesNotExistAreRefused) {
    Design design = load_design("mems-switch");
    design.wanted.least_reset = 0.1;
    design.wanted.greatest_reset = 0.2;
    EXPECT_THROW(meet_wishes(design, trip_of(design)), InputError);
}

/// Trip times jump from cycle to cycle: value and class were met, and time, but not all together.
TEST(WishesSlow, ForAValueAClassAndATimeAreMetTogetherOrNameWhatIsMissing) {
    Design design = load_design("mems-switch");
    design.wanted = {};
    design.wanted.value = 0.17;
    design.wanted.outcome = GrazingOutcome::lost;
    design.wanted.overshoot = 1e-4;
    design.wanted.longest_time = 30;
    const TripPoint trip = trip_of(design);
    const MetWishes met = meet_wishes(design, trip);
    ASSERT_EQ(met.found.outcome, WishOutcome::met) << met.found.reason;
    ASSERT_EQ(met.found.wants.size(), 3U);
    EXPECT_LE(*met.found.wants[2].value, 30);
    EXPECT_LE(met.found.evaluations, 2000U);
    const TripPoint made = trip_of(with_values(design, met.values()));
    EXPECT_NEAR(made.value(), 0.17, 1e-8);
    EXPECT_EQ(class_at(made).outcome, GrazingOutcome::lost);

    design.wanted.longest_time = 1; // less than a cycle
    const MetWishes closest = meet_wishes(design, trip);
    EXPECT_EQ(closest.found.outcome, WishOutcome::unmet);
    EXPECT_NE(closest.found.reason.find("the shortest was"), std::string::npos) << closest.found.reason;
    EXPECT_TRUE(closest.found.wants[0].met && closest.found.wants[1].met && !closest.found.wants[2].met);
}

} // namespace graze::testing::wishes_test
