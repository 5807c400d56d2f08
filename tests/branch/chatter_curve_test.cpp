// Onsets of chatter in two parameters.

#include "graze/branch/chatter_curve.hpp"

#include "chattering.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace graze::chatter_curve_test {

using namespace graze::testing;

/// The oscillator's onset of chatter, and settings of its curve in the force with the stop free.
struct Onset {
    Onset() : model(chattering_oscillator(0.5, 1, 1)) {
        const BranchSettings along = of_oscillator(model, 1);
        const Ladder ladder = climb(System(model), first_grazing(model, along), along, 7);
        const ChatterLimit limit = chatter_limit(System(model), ladder.grazings(), along.parameter);
        EXPECT_TRUE(limit.direct) << limit.problem;
        first.type = PointType::chatter;
        first.event = ladder.grazings().front().event;
        first.solution.orbit = limit.orbit;
        share = limit.direct->first;
        settings.parameter = model.independent_parameter("force");
        settings.free = {along.parameter};
        settings.least = 0.9;
        settings.greatest = 1.2;
    }
    Model model;
    SpecialPoint first;
    BranchSettings settings;
    double share = 0; ///< ratio of stop to force, constant because all but the contacts is linear
};

TEST(ChatterCurve, OscillatorHasAStraightLineInForceAndStop) {
    const Onset onset;
    ChatterCurve curve(System(onset.model), onset.first, onset.settings);
    for (const int direction : {1, -1}) {
        curve.start(direction);
        EXPECT_EQ(curve.point().detail.substr(0, 5), "start");
        while (curve.step()) {
            const SpecialPoint point = curve.point();
            const std::vector<double>& parameters = point.solution.orbit.parameters;
            const double stop = parameters[onset.settings.free.front().place()];
            EXPECT_NEAR(stop, onset.share * point.parameter, 1e-9);
            EXPECT_EQ(point.step, curve.steps());
        }
        EXPECT_GE(curve.steps(), 3U);
        EXPECT_EQ(curve.ending(), direction > 0 ? "bound: force = 1.2" : "bound: force = 0.9");
    }
}

TEST(ChatterCurve, EndsAfterItsStepsOrWhenInterrupted) {
    Onset onset;
    onset.settings.steps = 2;
    ChatterCurve curve(System(onset.model), onset.first, onset.settings);
    curve.start(1);
    EXPECT_FALSE(curve.step([] { return true; }));
    EXPECT_TRUE(curve.interrupted());
    EXPECT_EQ(curve.ending(), "");
    curve.start(1);
    EXPECT_TRUE(curve.step());
    EXPECT_TRUE(curve.step());
    EXPECT_FALSE(curve.step());
    EXPECT_FALSE(curve.interrupted());
    EXPECT_EQ(curve.ending(), name_of(BranchOutcome::steps));
}

TEST(ChatterCurve, SettingsThatDoNotApplyAreRefused) {
    const Onset onset;
    const auto refused = [&](const auto& change) {
        BranchSettings settings = onset.settings;
        change(settings);
        EXPECT_THROW(ChatterCurve(System(onset.model), onset.first, settings), InputError);
    };
    refused([](BranchSettings& settings) { settings.free.clear(); });
    refused([](BranchSettings& settings) { settings.free.push_back(settings.parameter); });
    refused([](BranchSettings& settings) { settings.stop_at = {PointType::fold}; });
    refused([](BranchSettings& settings) { settings.least = 1.1; });
}

} // namespace graze::chatter_curve_test
