// By which numbers orbits are told apart.

#include "atlas/orbit_mark.hpp"

#include <gtest/gtest.h>

#include <limits>

namespace graze::orbit_mark_test {

const MarkScales scales{{2, 10}, {4, 4}};
const OrbitMark orbit{{1, 5}, 3, {2, -4}};

OrbitMark moved(double first, double second, double period, double extent) {
    return {{orbit.at[0] + first, orbit.at[1] + second}, orbit.period * period, {orbit.extents[0] + extent, -4}};
}

TEST(OrbitMark, AgreesWithinRoundOffOfLocatedPoints) {
    EXPECT_TRUE(is_same_orbit(orbit, orbit, scales));
    EXPECT_TRUE(is_same_orbit(orbit, moved(9e-8, -4e-7, 1 + 1e-6, 3e-5), scales)); // of values 1 and 5
    EXPECT_FALSE(is_same_orbit(orbit, moved(3e-7, 0, 1, 0), scales));
    EXPECT_FALSE(is_same_orbit(orbit, moved(0, 1.1e-6, 1, 0), scales));
    EXPECT_FALSE(is_same_orbit(orbit, moved(0, 0, 1 + 1e-4, 0), scales));
    EXPECT_FALSE(is_same_orbit(orbit, moved(0, 0, 1, 1e-4), scales));
    EXPECT_FALSE(is_same_orbit(orbit, moved(0, 0, 1, std::numeric_limits<double>::quiet_NaN()), scales));
}

TEST(OrbitMark, TwiceThePeriodIsTheSameOnlyWhereThatIsAsked) {
    const OrbitMark twice = moved(0, 0, 2, 0), thrice = moved(0, 0, 3, 0);
    EXPECT_FALSE(is_same_orbit(orbit, twice, scales));
    EXPECT_TRUE(is_same_orbit(orbit, twice, scales, true));
    EXPECT_TRUE(is_same_orbit(twice, orbit, scales, true));
    EXPECT_TRUE(is_same_orbit(orbit, orbit, scales, true));
    EXPECT_FALSE(is_same_orbit(orbit, thrice, scales, true));
}

TEST(OrbitMark, ScalesAreMediansOfStates) {
    constexpr double infinite = std::numeric_limits<double>::infinity();
    const std::vector<OrbitMark> marks{
        {{0}, 1, {1, -3}}, {{0}, 1, {2, infinite}}, {{0}, 1, {2, -2}}, {{0}, 1, {1e14, 0}}};
    MarkScales fitted{{1}, {}};
    fitted.fit({});
    EXPECT_TRUE(fitted.extents.empty());
    fitted.fit({&marks[0], &marks[1], &marks[2], &marks[3]});
    EXPECT_EQ(fitted.extents, (std::vector<double>{3, 3})); // of 2, 3 and 1e14
    EXPECT_EQ(fitted.extent(0, marks[0], marks[3]), 1e14);
    EXPECT_FALSE(has_same_extents(marks[0], marks[2], fitted));
    const OrbitMark idle{{0}, 1, {1e-17, -3e-18}}, other{{0}, 1, {5e-16, 0}};
    EXPECT_TRUE(has_same_extents(idle, other, fitted)) << "round-off of a state that does not move";
}

TEST(OrbitMark, AWallAtZeroDoesNotMakeRoundOffADifference) {
    const OrbitMark one{{0}, 1, {2, 1e-14, 3, -3}}, other{{0}, 1, {2, -3e-16, 3, -3}};
    MarkScales walled{{1}, {}};
    walled.fit({&one, &other});
    EXPECT_TRUE(is_same_orbit(one, other, walled));
}

TEST(OrbitMark, PlacesInABoxThatIsMuchWiderAreToldApart) {
    const MarkScales wide{{2e6}, {}};
    EXPECT_FALSE(is_same_place({{0.14516}, 1, {}}, {{0.25060}, 1, {}}, wide));
    EXPECT_TRUE(is_same_place({{0.25060}, 1, {}}, {{0.2506000001}, 1, {}}, wide));
}

} // namespace graze::orbit_mark_test
