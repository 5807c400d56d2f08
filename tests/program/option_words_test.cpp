#include "program/option_words.hpp"

#include <gtest/gtest.h>

namespace graze {
namespace {

TEST(OptionWords, NameTheOptionThatDoesWhatTheLibraryAdvises) {
    EXPECT_EQ(in_options("r.csv: the record has no rows; give one with rows, and let the times leave some"),
              "r.csv: the record has no rows; give one with rows, and let --from and --to leave some");
    EXPECT_EQ(in_options("run 'a' has no orbit number 99; give one of its 10 orbits"),
              "run 'a' has no orbit number 99; graze points --run a --all lists its 10 orbits");
    EXPECT_EQ(in_options("given gap: gap is -1 um, not positive"), "--set gap: gap is -1 um, not positive");
}

TEST(OptionWords, LeaveAllElseAsItIs) {
    for (const char* message : {"", "model.toml:1:1: unknown name 'a'; did you mean 'b'?",
                                "'from its release on' is no channel", "it was given "})
        EXPECT_EQ(in_options(message), message);
}

} // namespace
} // namespace graze
