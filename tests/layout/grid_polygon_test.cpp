#include "graze/layout/grid_polygon.hpp"

#include <gmock/gmock.h>

namespace graze::testing::grid_polygon_test {

using ::testing::HasSubstr;

std::string fault(const GridPolygon& polygon, std::int64_t least = 1) {
    const auto found = polygon_fault(polygon, least);
    return found ? found->text : "";
}

TEST(GridPolygon, AreasAreExactUpToMetres) {
    EXPECT_EQ(area_of(polygon_of({0, 0, 1, 1})), 1e-6);
    EXPECT_EQ(area_of(GridPolygon{{0, 0}, {3, 0}, {0, 5}}), 7.5e-6);
    // 2 m square: twice the area, 8e18, is close to the largest 64-bit integer.
    EXPECT_EQ(area_of(polygon_of({-1'000'000'000, -1'000'000'000, 1'000'000'000, 1'000'000'000})), 4e12);
    GridPolygon clockwise = polygon_of({0, 0, 10, 20});
    std::reverse(clockwise.begin(), clockwise.end());
    EXPECT_EQ(area_of(clockwise), 2e-4);
    EXPECT_EQ(bounding_box(clockwise), (GridBox{0, 0, 10, 20}));
    EXPECT_EQ(area_of(GridPolygon()), 0);
}

TEST(GridPolygon, FacingIsTheLeastDistanceAndItsLength) {
    const GridPolygon left{{0, 0}, {10, 0}, {10, 40}, {5, 40}, {5, 100}, {0, 100}};
    const auto found = facing(left, polygon_of({17, 30, 30, 200}));
    ASSERT_TRUE(found);
    EXPECT_EQ(found->distance, 7);
    EXPECT_EQ(found->length, 10) << "the step further back is not as near";
    EXPECT_FALSE(facing(left, polygon_of({17, 100, 30, 200}))) << "they only share a height of zero";
    EXPECT_FALSE(facing(left, polygon_of({-30, 0, -20, 100}))) << "it is on the other side";
}

TEST(GridPolygon, FaultsAreFound) {
    EXPECT_EQ(fault(polygon_of({0, 0, 10, 20})), "");
    EXPECT_THAT(fault({{0, 0}, {1, 0}}), HasSubstr("fewer than three"));
    EXPECT_THAT(fault({{0, 0}, {10, 0}, {10, 10}, {10, 10}, {0, 10}}), HasSubstr("turns back"));
    EXPECT_THAT(fault({{0, 0}, {10, 0}, {10, 2}, {12, 2}, {12, 10}, {0, 10}}, 3), HasSubstr("too small"));
    EXPECT_THAT(fault({{0, 0}, {5, 0}, {10, 0}, {10, 10}, {0, 10}}), HasSubstr("a straight corner"));
    EXPECT_THAT(fault({{0, 0}, {10, 0}, {10, 10}, {10, 5}, {0, 5}}), HasSubstr("turns back"));
    EXPECT_THAT(fault({{0, 0}, {100, 0}, {100, 10}}), HasSubstr("acute"));
    EXPECT_THAT(fault({{0, 0}, {10, 0}, {10, 10}, {-5, 10}, {-5, 5}, {5, 5}, {5, 20}, {0, 20}}),
                HasSubstr("intersects itself"));
    // Two squares that share one corner.
    EXPECT_THAT(fault({{0, 0}, {10, 0}, {10, 10}, {20, 10}, {20, 20}, {10, 20}, {10, 10}, {0, 10}}),
                HasSubstr("intersects itself"));
    const auto far = polygon_fault(polygon_of({-1'000'000'000, -1'000'000'000, 1'000'000'000, 1'000'000'000}), 1);
    EXPECT_FALSE(far) << far->text;
}

} // namespace graze::testing::grid_polygon_test
