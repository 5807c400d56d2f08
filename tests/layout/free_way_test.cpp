#include "graze/layout/fabrication_rules.hpp"

#include "base/message_of.hpp"

#include <gmock/gmock.h>

namespace graze::testing::free_way_test {

using ::testing::HasSubstr;

/// The worst place on the way to the stops, and on that to the electrode.
std::vector<RuleFinding> ways(const GivenLengths& given) {
    const DeviceFile file = load_device_file("mems-switch-device", given);
    std::vector<RuleFinding> found;
    for (const RuleFinding& one : rule_findings(file, draw_device_layout(file)))
        if (one.rule == "free_way" && (found.empty() || found.back().limit != one.limit))
            found.push_back(one);
    return found;
}

std::string refusal(const GivenLengths& given) {
    const DeviceFile file = load_device_file("mems-switch-device", given);
    return message_of([&] { require_rules(file, rule_findings(file, draw_device_layout(file))); });
}

constexpr double rounding = 1e-9; // of sums in micrometres

TEST(FreeWay, OfTheShippedDeviceIsLimitedByItsLugs) {
    const std::vector<RuleFinding> found = ways({});
    ASSERT_EQ(found.size(), 2U);
    // 0.3 um of each face is etched away at the top, where trenches are narrowest.
    for (const RuleFinding& one : found) {
        EXPECT_NEAR(one.value, 30 + 0.6, rounding);
        EXPECT_TRUE(one.holds());
    }
    EXPECT_NEAR(found[0].limit, 8.4 + 0.6, rounding);
    EXPECT_NEAR(found[1].limit, 14.185 + 0.6, rounding);
}

TEST(FreeWay, MustExceedTheWayToTheStops) {
    EXPECT_THAT(
        refusal({{"flexure_spacing", 8}}),
        HasSubstr("given flexure_spacing: rule free_way is 8.6 um for the mass on its way to the stops, until a "
                  "lug of the mass meets the frame's finger, at ("));
    EXPECT_THAT(refusal({{"flexure_spacing", 8}}), HasSubstr("where more than 9 um is needed; give a greater "
                                                             "flexure_spacing, or a smaller stop_gap"));
    // With a clearance equal to the gap the lug arrives together with the electrode.
    EXPECT_THAT(refusal({{"flexure_spacing", 14.185}}), HasSubstr("on its way to the fixed electrode"));
    EXPECT_EQ(refusal({{"flexure_spacing", 14.186}}), "");
}

TEST(FreeWay, MustExceedTheWayToTheElectrode) {
    EXPECT_THAT(refusal({{"clearance", 13}}),
                HasSubstr("given clearance: rule free_way is 13.6 um for the mass on its way to the fixed electrode, "
                          "until the frame meets the mass, at ("));
    EXPECT_THAT(refusal({{"clearance", 14.185}}), HasSubstr("more than 14.785 um is needed"));
    EXPECT_THAT(refusal({{"clearance", 14.186}}), ::testing::Not(HasSubstr("free_way")));
}

/// With n folds neighbouring trusses, and finger and truss, move relative to each other by 1/n of the mass's travel.
TEST(FreeWay, IsDividedByTheNumberOfFolds) {
    for (const double folds : {2.0, 3.0, 7.0}) {
        const std::vector<RuleFinding> found =
            ways({{"folds", folds}, {"flexure_spacing", 8}, {"flexure_length", 900}});
        ASSERT_EQ(found.size(), 2U) << folds;
        EXPECT_NEAR(found[0].value, folds * 8.6 < 40.6 ? folds * 8.6 : 40.6, rounding) << folds;
        EXPECT_NEAR(found[1].value, folds * 8.6 < 40.6 ? folds * 8.6 : 40.6, rounding) << folds;
        EXPECT_TRUE(found[0].holds());
    }
}

/// Independent method: the mass is moved by slightly less and slightly more, until it overlaps the frame.
TEST(FreeWay, IsWhereTheMovedMassOverlapsTheFrame) {
    const DeviceFile file = load_device_file("mems-switch-device", {{"flexure_spacing", 20}, {"clearance", 17}});
    const Layout layout = draw_device_layout(file);
    const DeviceDrawing& drawing = layout.devices[0].drawing;
    const GridBox finger = drawing.in_device(drawing.flexure.finger, false);
    const auto covers = [&](std::int64_t moved) {
        bool any = false;
        for (const GridBox& lug : drawing.flexure.lugs) {
            const GridBox at = drawing.in_device(lug, false).moved({moved, 0});
            any = any || (at.left < finger.right && finger.left < at.right);
        }
        return any;
    };
    EXPECT_FALSE(covers(20'000));
    EXPECT_TRUE(covers(20'001));
    EXPECT_FALSE(covers(-20'000));
    EXPECT_TRUE(covers(-20'001));
    // Its clearance to the frame's side walls is smaller here.
    for (const RuleFinding& one : ways({{"flexure_spacing", 20}, {"clearance", 17}}))
        EXPECT_NEAR(one.value, 17 + 0.6, rounding);
    for (const RuleFinding& one : ways({{"flexure_spacing", 20}, {"clearance", 21}}))
        EXPECT_NEAR(one.value, 20 + 0.6, rounding);
}

} // namespace graze::testing::free_way_test
