#include "program/wrapped_text.hpp"

#include <gtest/gtest.h>

namespace graze {
namespace {

TEST(WrappedText, breaks_between_words_and_never_within_one) {
    EXPECT_EQ(wrapped("", 10), "");
    EXPECT_EQ(wrapped("one two", 7), "one two");
    EXPECT_EQ(wrapped("one two", 6), "one\ntwo");
    EXPECT_EQ(wrapped("  one\n two  three ", 9), "one two\nthree");
    EXPECT_EQ(wrapped("a verylongword b", 5), "a\nverylongword\nb");
}

TEST(WrappedText, counts_characters_rather_than_bytes) {
    EXPECT_EQ(width_of("Größe µm"), 8u);
    EXPECT_EQ(wrapped("ää öö üü", 5), "ää öö\nüü");
}

TEST(WrappedText, indents_all_lines_but_the_first) {
    EXPECT_EQ(wrapped("one two three", 9, 4), "one\n    two\n    three");
    EXPECT_EQ(wrapped("one two three", 11, 4), "one two\n    three");
}

} // namespace
} // namespace graze
