#include "layout/mask_outlines.hpp"

#include "graze/base/error.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

namespace graze::mask_outlines_test {

std::int64_t least(const std::vector<FacingEdges>& places, bool etched) {
    std::int64_t found = 1'000'000;
    for (const FacingEdges& one : places)
        if (one.etched == etched)
            found = std::min(found, one.distance);
    return found;
}

TEST(MaskEdges, DistinguishTrenchesFromLines) {
    // Two trenches, 30 and 20 wide, 7 apart; one drawn clockwise.
    GridPolygon second = polygon_of({37, 0, 57, 100});
    std::reverse(second.begin(), second.end());
    const std::vector<FacingEdges> places = facing_edges(mask_edges(std::vector{polygon_of({0, 0, 30, 90}), second}));
    EXPECT_EQ(least(places, true), 20);
    EXPECT_EQ(least(places, false), 7);
    const auto line = std::find_if(places.begin(), places.end(), [](const auto& one) { return !one.etched; });
    EXPECT_EQ(line->first, (GridPoint{30, 45}));
    EXPECT_EQ(line->second, (GridPoint{37, 45}));
}

TEST(MaskEdges, OfPolygonsThatTouchAreThoseOfTheirUnion) {
    // One trench of 50 in two parts, and a notch of 4 next to them.
    const std::vector<FacingEdges> places = facing_edges(
        mask_edges(std::vector{polygon_of({0, 0, 50, 20}), polygon_of({0, 20, 50, 50}), polygon_of({50, 10, 54, 30})}));
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

TEST(BoxSets, ExcludeSubtractedBoxes) {
    const std::vector<GridBox> boxes{{0, 0, 10, 10}, {5, 0, 20, 10}}, without{{0, 0, 3, 3}};
    const auto found = outlines(boxes, without, {0, 0, 20, 10});
    ASSERT_EQ(found.size(), 1U);
    EXPECT_EQ(found[0].size(), 6U) << "without corners on straight sides";
    EXPECT_NEAR(total_area(found), 191e-6, 1e-18);
    EXPECT_THROW(outlines(boxes, std::vector<GridBox>{{5, 5, 6, 6}}, {0, 0, 20, 10}), InternalError) << "a hole";
    EXPECT_TRUE(outlines(boxes, boxes, {0, 0, 20, 10}).empty());
}

/// Compares areas with counted squares.
TEST(BoxSets, HaveTheAreaOfTheCountedSquares) {
    std::mt19937_64 random(7);
    constexpr std::int64_t side = 24;
    const auto box = [&] {
        const auto x = static_cast<std::int64_t>(random() % side), y = static_cast<std::int64_t>(random() % side);
        return GridBox{x, y, x + 1 + static_cast<std::int64_t>(random() % 8),
                       y + 1 + static_cast<std::int64_t>(random() % 8)};
    };
    int tried = 0;
    for (int seed = 0; seed < 300; ++seed) {
        const std::vector<GridBox> boxes{box(), box(), box(), box()}, without{box(), box()};
        const GridBox clip{3, 3, side, side};
        const auto has = [](const std::vector<GridBox>& all, std::int64_t x, std::int64_t y) {
            return std::any_of(all.begin(), all.end(), [&](const GridBox& one) {
                return one.left <= x && x < one.right && one.bottom <= y && y < one.top;
            });
        };
        double squares = 0;
        for (std::int64_t x = clip.left; x < clip.right; ++x)
            for (std::int64_t y = clip.bottom; y < clip.top; ++y)
                squares += has(boxes, x, y) && !has(without, x, y) ? 1e-6 : 0;
        try {
            const auto found = outlines(boxes, without, clip);
            EXPECT_NEAR(total_area(found), squares, 1e-15) << seed;
            ++tried;
        } catch (const InternalError&) { // an area with a hole
        }
    }
    EXPECT_GT(tried, 200);
}

} // namespace graze::mask_outlines_test
