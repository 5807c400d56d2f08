#include "graze/branch/ladder.hpp"

#include "chattering.hpp"

#include <gtest/gtest.h>

#include <fmt/format.h>

#include <string>
#include <vector>

namespace graze::ladder_test {

using namespace graze::testing;

TEST(Ladder, EndsWithTheReason) {
    const Model model = chattering_oscillator(0.5, 1, 1);
    BranchSettings settings = of_oscillator(model, 1);
    const SpecialPoint first = first_grazing(model, settings);
    // With two contacts it grazes at 0.9122...
    settings.least = 0.93;
    std::vector<std::string> seen;
    const Ladder ladder = climb(System(model), first, settings, 6, [&](std::size_t rung, const Branch& branch) {
        seen.push_back(fmt::format("{} {}", rung, names(branch)));
        return true;
    });
    ASSERT_EQ(ladder.grazings().size(), 2U) << ladder.why();
    EXPECT_EQ(seen.size(), 2U);
    EXPECT_EQ(seen[0].substr(0, 1), "2");
    EXPECT_EQ(ladder.why(), "bound: s = 0.93");
    EXPECT_EQ(climb(System(model), first, settings, 2).grazings().size(), 2U);
    // The visitor may stop it.
    EXPECT_EQ(
        climb(System(model), first, settings, 6, [](std::size_t, const Branch&) { return false; }).grazings().size(),
        2U);

    settings.greatest = 1;
    EXPECT_THROW(climb(System(model), first, settings, 3), InputError); // outside of the bounds
    SpecialPoint nothing = first;
    nothing.type = PointType::fold;
    nothing.solution.orbit = settled(model, "start").orbit;
    EXPECT_THROW(Ladder(System(model), nothing, of_oscillator(model, 1)), InputError);
}

TEST(Ladder, MayBeginAtAnyPointOfACurveOfTouches) {
    const Model model = chattering_oscillator(0.5, 1, 1);
    const BranchSettings settings = of_oscillator(model, 1);
    SpecialPoint point = first_grazing(model, settings);
    const Ladder known = climb(System(model), point, settings, 3);
    point.type = PointType::regular;
    point.segment = point.event = 0;
    point.time = 0;
    const Ladder ladder = climb(System(model), point, settings, 3);
    ASSERT_EQ(ladder.grazings().size(), 3U) << ladder.why();
    EXPECT_NEAR(ladder.grazings()[2].parameter, known.grazings()[2].parameter, 1e-12);
}

} // namespace graze::ladder_test
