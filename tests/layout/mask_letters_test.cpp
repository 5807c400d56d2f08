#include "graze/layout/mask_letters.hpp"

#include <gtest/gtest.h>

#include <set>
#include <string>

namespace graze::testing::mask_letters_test {

const std::string drawn = "ABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789.,-_+=:/()";

std::set<std::pair<std::int64_t, std::int64_t>> squares(char letter) {
    std::set<std::pair<std::int64_t, std::int64_t>> result;
    for (const GridBox& box : letter_boxes(std::string(1, letter), letter_rows))
        for (std::int64_t x = box.left; x < box.right; ++x)
            for (std::int64_t y = box.bottom; y < box.top; ++y)
                EXPECT_TRUE(result.insert({x, y}).second) << letter << ": boxes overlap";
    return result;
}

TEST(MaskLetters, DifferAndTouchAlongEdgesOnly) {
    std::set<std::set<std::pair<std::int64_t, std::int64_t>>> different;
    for (const char letter : drawn) {
        const auto own = squares(letter);
        EXPECT_FALSE(own.empty()) << letter;
        EXPECT_TRUE(different.insert(own).second) << letter << " looks like another";
        for (const auto& [x, y] : own) {
            EXPECT_TRUE(0 <= x && x < letter_columns && 0 <= y && y < letter_rows) << letter;
            for (const std::int64_t side : {-1, 1})
                if (own.contains({x + side, y + 1})) {
                    EXPECT_TRUE(own.contains({x + side, y}) || own.contains({x, y + 1})) << letter << ": only a corner";
                }
        }
    }
}

TEST(MaskLetters, HaveTheStatedWidth) {
    EXPECT_EQ(letters_width("", 70), 0);
    EXPECT_EQ(letters_width("H", 70), 50);
    EXPECT_EQ(letters_width("HH", 76), 110) << "whole sevenths are used";
    GridBox all = letter_boxes("HH", 70).front();
    for (const GridBox& one : letter_boxes("HH", 70))
        all = all.with(one);
    EXPECT_EQ(all, (GridBox{0, 0, 110, 70}));
    EXPECT_EQ(letter_boxes("h", 70), letter_boxes("H", 70));
    EXPECT_TRUE(letter_boxes(" ", 70).empty());
    EXPECT_TRUE(can_be_drawn(drawn + " abcxyz"));
    EXPECT_FALSE(can_be_drawn("µm"));
    EXPECT_FALSE(can_be_drawn("a;b"));
}

} // namespace graze::testing::mask_letters_test
