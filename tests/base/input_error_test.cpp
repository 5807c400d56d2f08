#include "graze/base/input_error.hpp"

#include <gtest/gtest.h>

namespace graze {
namespace {

TEST(Place, TextLeavesOutWhatIsNotKnown) {
    EXPECT_EQ((Place{"model.toml", 3, 7}.text()), "model.toml:3:7");
    EXPECT_EQ((Place{"model.toml", 3, 0}.text()), "model.toml:3");
    EXPECT_EQ((Place{"model.toml", 0, 0}.text()), "model.toml");
    EXPECT_EQ((Place{"model.toml", 0, 7}.text()), "model.toml") << "a column means nothing without its line";
    EXPECT_EQ((Place{"", 3, 7}.text()), "3:7");
    EXPECT_EQ(Place{}.text(), "");
}

TEST(InputError, SaysPlaceProblemAndRemedyOnOneLine) {
    const InputError error(Place{"model.toml", 3, 7}, "unknown name 'a'", "did you mean 'b'?");
    EXPECT_STREQ(error.what(), "model.toml:3:7: unknown name 'a'; did you mean 'b'?");
    EXPECT_EQ(error.place().line, 3);
    EXPECT_EQ(error.problem(), "unknown name 'a'");
    EXPECT_EQ(error.remedy(), "did you mean 'b'?");
}

TEST(InputError, WorksWithoutPlaceOrRemedy) {
    EXPECT_STREQ(InputError("no such state", "").what(), "no such state");
    EXPECT_STREQ(InputError("no such state", "see the model").what(), "no such state; see the model");
}

} // namespace
} // namespace graze
