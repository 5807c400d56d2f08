#include "layout/mask_edges.hpp"

#include <gtest/gtest.h>

#include <algorithm>

namespace graze {
namespace {

GridPolygon box(std::int64_t left, std::int64_t bottom, std::int64_t right, std::int64_t top) {
    return {{left, bottom}, {right, bottom}, {right, top}, {left, top}};
}

std::int64_t least(const std::vector<FacingEdges>& places, bool etched) {
    std::int64_t found = 1'000'000;
    for (const FacingEdges& one : places)
        if (one.etched == etched)
            found = std::min(found, one.distance);
    return found;
}

TEST(MaskEdges, DistinguishTrenchesFromLines) {
    // Two trenches, 30 and 20 wide, 7 apart; one drawn clockwise.
    GridPolygon second = box(37, 0, 57, 100);
    std::reverse(second.begin(), second.end());
    const std::vector<FacingEdges> places = facing_edges(mask_edges(std::vector{box(0, 0, 30, 90), second}));
    EXPECT_EQ(least(places, true), 20);
    EXPECT_EQ(least(places, false), 7);
    const auto line = std::find_if(places.begin(), places.end(), [](const auto& one) { return !one.etched; });
    EXPECT_EQ(line->first, (GridPoint{30, 45}));
    EXPECT_EQ(line->second, (GridPoint{37, 45}));
}

TEST(MaskEdges, OfPolygonsThatTouchAreThoseOfTheirUnion) {
    // One trench of 50 in two parts, and a notch of 4 next to them.
    const std::vector<FacingEdges> places =
        facing_edges(mask_edges(std::vector{box(0, 0, 50, 20), box(0, 20, 50, 50), box(50, 10, 54, 30)}));
    EXPECT_EQ(least(places, true), 20) << "the notch is 20 high; the cut at 20 is none";
    EXPECT_EQ(least(places, false), 1'000'000);
}

TEST(MaskEdges, ContainPointsInsideAndOnTheOutline) {
    const GridPolygon l{{0, 0}, {10, 0}, {10, 5}, {5, 5}, {5, 10}, {0, 10}};
    EXPECT_TRUE(contains(l, {2, 8}));
    EXPECT_TRUE(contains(l, {5, 7})) << "on its outline";
    EXPECT_TRUE(contains(l, {10, 5}));
    EXPECT_FALSE(contains(l, {7, 7}));
    EXPECT_FALSE(contains(l, {-1, 5}));
    EXPECT_FALSE(contains(l, {11, 0}));
}

} // namespace
} // namespace graze
