#include "program/wrapped_text.hpp"

#include <gtest/gtest.h>

namespace graze::wrapped_text_test {

TEST(WrappedText, BreaksOnlyBetweenWords) {
    EXPECT_EQ(wrapped("", 10), "");
    EXPECT_EQ(wrapped("one two", 7), "one two");
    EXPECT_EQ(wrapped("one two", 6), "one\ntwo");
    EXPECT_EQ(wrapped("  one\n two  three ", 9), "one two\nthree");
    EXPECT_EQ(wrapped("a verylongword b", 5), "a\nverylongword\nb");
}

TEST(WrappedText, CountsCharactersRatherThanBytes) {
    EXPECT_EQ(width_of("Größe µm"), 8u);
    EXPECT_EQ(wrapped("ää öö üü", 5), "ää öö\nüü");
}

TEST(WrappedText, IndentsAllLinesButTheFirst) {
    EXPECT_EQ(wrapped("one two three", 9, 4), "one\n    two\n    three");
    EXPECT_EQ(wrapped("one two three", 11, 4), "one two\n    three");
}

} // namespace graze::wrapped_text_test
