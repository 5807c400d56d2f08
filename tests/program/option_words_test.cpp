#include "program/option_words.hpp"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace graze::option_words_test {

TEST(OptionWords, NameTheOptionThatDoesWhatTheLibraryAdvises) {
    EXPECT_EQ(in_options("r.csv: the record has no rows; give one with rows, and let `part` leave some"),
              "r.csv: the record has no rows; give one with rows, and let --from and --to leave some");
    EXPECT_EQ(in_options("channel: the record has no channel 'w'; it has v"),
              "--channel: the record has no channel 'w'; it has v");
    EXPECT_EQ(in_options("gap or stiffness are not known; give gap and stiffness, in the units of the record"),
              "gap or stiffness are not known; give --gap and --stiffness, in the units of the record");
    EXPECT_EQ(in_options("a leakage inductance needs all three; give beta1, beta2 and gap, or none"),
              "a leakage inductance needs all three; give --beta1, --beta2 and --gap, or none");
    EXPECT_EQ(in_options("time and periods cannot be given together; choose one of them"),
              "--time and --periods cannot be given together; choose one of them");
    EXPECT_EQ(in_options("periods: 0 is not a positive number; give 1 or more"),
              "--periods: 0 is not a positive number; give 1 or more");
    EXPECT_EQ(
        in_options("'V' does not rise through 5 twice; choose another reference or level, or record more periods"),
        "'V' does not rise through 5 twice; choose another --reference or --level, or record more periods");
    EXPECT_EQ(in_options("x.csv: channel 'x' is in mm, and what it measures in m; convert it in the run that has the "
                         "record: scale = { x = { factor = 0.001, unit = \"m\" } }"),
              "x.csv: channel 'x' is in mm, and what it measures in m; convert it by --scale x=0.001:m");
    EXPECT_EQ(
        in_options("x.csv: channel 'my q' is in mm; convert it in the run that has the record: scale = { my q = { "
                   "factor = 0.001, unit = \"m\" } }"),
        "x.csv: channel 'my q' is in mm; convert it by --scale my q=0.001:m");
    EXPECT_EQ(in_options("run 'a' has no orbit number 99; give one of its 10 orbits"),
              "run 'a' has no orbit number 99; graze points --run a --all lists its 10 orbits");
    EXPECT_EQ(in_options("given gap: gap is -1 um, not positive"), "--set gap: gap is -1 um, not positive");
}

TEST(OptionWords, LeaveAllElseAsItIs) {
    for (const char* message : {"", "model.toml:1:1: unknown name 'a'; did you mean 'b'?",
                                "'from its release on' is no channel", "it was given "})
        EXPECT_EQ(in_options(message), message);
    EXPECT_EQ(in_options("run 'a': coupling lacks gap; give gap and stiffness, such as gap = 1"),
              "run 'a': coupling lacks gap; give gap and stiffness, such as gap = 1");
}

TEST(OptionWords, AFileThatIsNamedLikeAnOptionIsToldAsAFile) {
    const std::vector<std::string> arguments{"record", "scale"};
    EXPECT_EQ(in_options("scale: the record cannot be read", arguments), "scale: the record cannot be read");
    EXPECT_EQ(in_options("at: it is no number", arguments), "--at: it is no number");
}

} // namespace graze::option_words_test
