#include "graze/layout/layout_cell.hpp"

#include "graze/base/input_error.hpp"

#include <gtest/gtest.h>

#include <set>

namespace graze::testing::layout_cell_test {

TEST(LayoutCell, IsMirroredThenRotatedThenMoved) {
    LayoutCell arrow{.name = "ARROW"};
    arrow.add({1, 0}, GridPolygon{{0, 0}, {4, 0}, {4, 1}});
    const LayoutLibrary library{.cells = {arrow,
                                          {.name = "ONE", .references = {{"ARROW", {100, 10}, true, 90}}},
                                          {.name = "TWO", .references = {{"ONE", {1000, 0}, true, 180}}}}};
    const std::vector<PlacedShape> one = flattened(library, "ONE");
    ASSERT_EQ(one.size(), 1U);
    // (x, y) -> (x, -y) -> (y, x) -> moved
    EXPECT_EQ(one[0].polygon, (GridPolygon{{100, 10}, {100, 14}, {101, 14}}));
    // And (x, y) -> (x, -y) -> (-x, y) -> moved.
    EXPECT_EQ(flattened(library, "TWO")[0].polygon, (GridPolygon{{900, 10}, {900, 14}, {899, 14}}));
    EXPECT_THROW(flattened(library, "THREE"), InputError);
}

TEST(LayoutCell, RotatedByAnyAngleIsRoundedToTheGrid) {
    LayoutCell square{.name = "SQUARE"};
    square.add({1, 0}, GridBox{0, 0, 1000, 1000});
    const LayoutLibrary library{.cells = {square, {.name = "TOP", .references = {{"SQUARE", {}, false, 30}}}}};
    EXPECT_EQ(flattened(library, "TOP")[0].polygon, (GridPolygon{{0, 0}, {866, 500}, {366, 1366}, {-500, 866}}));
    EXPECT_EQ(areas_of(library, "TOP").at({1, 0}), 1) << "of what is drawn, not of what is rounded";
}

TEST(LayoutCell, LayersHaveDescriptionsAndNamesHaveOnlyLettersAndDigits) {
    std::set<MaskLayer> different;
    for (const MaskLayer layer : all_layers()) {
        EXPECT_FALSE(layer_text(layer).empty());
        different.insert(layer);
    }
    EXPECT_EQ(different.size(), all_layers().size());
    EXPECT_EQ(layer_text({99, 0}), "");
    EXPECT_EQ(cell_name("my-switch.2"), "my_switch_2");
    EXPECT_EQ(cell_name(std::string(100, 'a')).size(), 28U);
}

} // namespace graze::testing::layout_cell_test
