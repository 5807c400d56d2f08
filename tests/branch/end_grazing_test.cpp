// Curves of contacts of zero speed, followed by segments of zero duration. The same orbits, with one contact fewer, are
// followed as touches by different equations.

#include "follow.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace graze::end_grazing_test {

using namespace graze::testing;

/// The impact microactuator, whose frame slips after a contact (J1) until it sticks (J8).
struct Microactuator {
    Model model = shipped_with("impact-microactuator", {{"V", 0.1}, {"omega", 0.9189}});
    BranchSettings settings = in_parameter(model, "V", 0, 3);

    /// Follows the orbits with one more contact, from the touch or back from their next grazing.
    Branch beyond(const SpecialPoint& touch, bool back) const {
        const Branch branch = follow(model, branches_at(System(model), touch, settings).at(0), settings);
        if (!back || branch.special.empty())
            return branch;
        return follow_branch(System(model), branch.special.back().solution.orbit, settings);
    }

    /// Returns the curve of a grazing over the frequency.
    Branch curve(const SpecialPoint& grazing) const {
        BranchSettings along = settings;
        along.parameter = model.independent_parameter("omega");
        along.free = {settings.parameter};
        along.greatest = 3;
        along.kept = grazing;
        return follow_branch(System(model), grazing.solution.orbit, along);
    }
};

/// Checks that two curves which end at the same value of the first parameter have the same second one there.
void expect_same_end(const Microactuator& one, const Branch& stops, const Branch& touches) {
    ASSERT_EQ(names(stops), "BD");
    ASSERT_EQ(names(touches), "BD");
    const auto end = [&](const Branch& branch) {
        return branch.points.back().solution.orbit.parameters[one.settings.parameter.place()];
    };
    // The equations differ; each has integration errors of 1e-13.
    EXPECT_NEAR(end(stops), end(touches), 1e-12);
    EXPECT_GT(stops.points.size(), 10U);
}

TEST(EndGrazing, ContactOfZeroSpeedEqualsTheTouchOfTheOrbitWithoutIt) {
    const Microactuator one;
    const Branch without = follow_branch(System(one.model), settled(one.model, "longest", 4000).orbit, one.settings);
    const SpecialPoint first = without.special.back();
    const Branch back = one.beyond(first, true);
    ASSERT_EQ(back.special.back().type, PointType::grazing) << names(back);
    const SpecialPoint stop = back.special.back();
    ASSERT_TRUE(stop.at_end);
    EXPECT_NEAR(stop.parameter, 0.5876212422746997, 1e-12); // G-1
    EXPECT_NEAR(stop.solution.orbit.durations[0], 0, 1e-12);
    expect_same_end(one, one.curve(stop), one.curve(first));

    // The same for orbits with another contact.
    const SpecialPoint second = one.beyond(first, false).special.back();
    const Branch back_again = one.beyond(second, true);
    const SpecialPoint second_stop = back_again.special.back();
    ASSERT_TRUE(second_stop.at_end);
    EXPECT_EQ(to_string(one.model, second_stop.solution.orbit.signature), "(J8 J1)^2");
    EXPECT_NEAR(second_stop.parameter, 0.7304755333366196, 1e-12); // G-2
    expect_same_end(one, one.curve(second_stop), one.curve(second));
}

TEST(EndGrazing, OrbitsOnTheOtherSideAreInadmissible) {
    Microactuator one;
    const Branch without = follow_branch(System(one.model), settled(one.model, "longest", 4000).orbit, one.settings);
    one.settings.stop_when_unphysical = false;
    const Branch all = one.beyond(without.special.back(), false);
    const auto grazings = of_type(all, PointType::grazing);
    const auto beyond = std::find_if(grazings.begin(), grazings.end(), [](const SpecialPoint& point) {
        return point.at_end && std::abs(point.parameter - 0.467802437768) < 1e-9;
    });
    ASSERT_NE(beyond, grazings.end()) << names(all);
    one.settings.stop_when_unphysical = true;
    const Branch curve = one.curve(*beyond);
    EXPECT_EQ(curve.outcome, BranchOutcome::unphysical);
    EXPECT_NE(curve.detail.find("'front'"), std::string::npos) << curve.detail;
}

} // namespace graze::end_grazing_test
