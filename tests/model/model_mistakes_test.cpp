// Several mistakes of a model file are reported at once, without those that only follow from others.

#include "graze/base/input_errors.hpp"
#include "graze/model/model_file.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <random>
#include <string>
#include <vector>

namespace graze::model_mistakes_test {

using ::testing::ElementsAre;
using ::testing::StartsWith;

/// Returns the beginnings of the messages, without the name of the file.
std::vector<std::string> mistakes_of(const std::string& text) {
    std::vector<std::string> said;
    const auto note = [&](const InputError& error) { said.push_back(std::string(error.what()).substr(5)); };
    try {
        parse_model(text, "m.tml");
    } catch (const InputErrors& errors) {
        EXPECT_STREQ(errors.what(), errors.all().front().what());
        for (const InputError& error : errors.all())
            note(error);
    } catch (const InputError& error) {
        note(error);
    }
    return said;
}

const std::vector<std::string> lines{
    "name = \"many\"",                      // 1
    "[parameters]",                         // 2
    "k = 2",                                // 3
    "c = \"k/4\"",                          // 4
    "[states]",                             // 5
    "x = 1",                                // 6
    "v = 0",                                // 7
    "[definitions]",                        // 8
    "force = \"-k*x - c*v\"",               // 9
    "[events]",                             // 10
    "floor = \"x\"",                        // 11
    "wall = \"3 - x\"",                     // 12
    "[jumps.bounce]",                       // 13
    "v = \"-v\"",                           // 14
    "[modes.free]",                         // 15
    "rates = { x = \"v\", v = \"force\" }", // 16
    "watch = [\"floor\", \"wall\"]",        // 17
    "[[transitions]]",                      // 18
    "mode = \"free\"",                      // 19
    "event = \"floor\"",                    // 20
    "jump = \"bounce\"",                    // 21
    "next = \"free\"",                      // 22
    "[[transitions]]",                      // 23
    "mode = \"free\"",                      // 24
    "event = \"wall\"",                     // 25
    "next = \"end\"",                       // 26
    "[quantities]",                         // 27
    "energy = \"v^2/2 + k*x^2/2\"",         // 28
};

std::string text_with(const std::vector<std::pair<std::size_t, std::string>>& changes) {
    std::vector<std::string> changed = lines;
    for (const auto& [line, text] : changes)
        changed[line - 1] = text;
    std::string text;
    for (const std::string& line : changed)
        text += line + '\n';
    return text;
}

TEST(ModelMistakes, AreReportedInTheOrderOfTheFile) {
    EXPECT_TRUE(mistakes_of(text_with({})).empty());
    EXPECT_THAT(mistakes_of(text_with({{4, "c = \"q/4\""},
                                       {9, "force = \"-k*x - c*u\""},
                                       {12, "wall = \"3 - \""},
                                       {16, "rates = { x = \"v +* 1\", v = \"forse\" }"},
                                       {20, "event = \"flor\""},
                                       {25, "even = \"wall\""},
                                       {28, "energy = true"}})),
                ElementsAre(StartsWith(":4:6: unknown name 'q'"), StartsWith(":9:"), StartsWith(":12:"),
                            StartsWith(":16:"), StartsWith(":16:"), StartsWith(":20:9: there is no event 'flor'"),
                            StartsWith(":25:1: unknown key 'even'"), StartsWith(":28:10: quantities.energy must be")));
}

TEST(ModelMistakes, OfTransitionsAndSectionsAreReportedTogether) {
    EXPECT_THAT(mistakes_of(text_with({{20, "event = \"wall\""},
                                       {25, "event = \"wall\""},
                                       {27, "[sections]"},
                                       {28, "here = { state = \"x\", value = 0 }"}})),
                ElementsAre(StartsWith(":17:10: mode 'free' watches the barrier 'floor' but has no transition"),
                            StartsWith(":23:"), StartsWith(":28:")));
}

TEST(ModelMistakes, OfOneItemAreNotReportedForItsUsers) {
    // Other items refer to the event, the jump, the definition and the parameter, and have no mistakes of their own.
    for (const auto& [line, text] :
         std::vector<std::pair<std::size_t, std::string>>{{3, "k = true"},
                                                          {3, "k = { valu = 3 }"},
                                                          {4, "c = \"k*\""},
                                                          {7, "v = { intial = 0 }"},
                                                          {9, "force = { vale = \"-k*x\" }"},
                                                          {11, "floor = \"x +\""},
                                                          {11, "floor = { function = \"x\", kid = \"barrier\" }"},
                                                          {12, "wall = 1979-05-27"},
                                                          {14, "v = \"-w\""},
                                                          {14, "u = \"-v\""},
                                                          {16, "rates = { x = \"v\" }"},
                                                          {21, "jump = \"bonce\""}})
        EXPECT_THAT(mistakes_of(text_with({{line, text}})), ElementsAre(StartsWith(":" + std::to_string(line) + ":")))
            << text;
}

/// Each mistake is reported whichever other mistakes there are; a name used twice is reported at both places.
TEST(ModelMistakes, AreReportedIndependently) {
    const std::vector<std::pair<std::size_t, std::string>> some{
        {3, "k = \"2 +\""},       {4, "c = \"z\""},
        {6, "x = \"y\""},         {9, "force = \"-k*\""},
        {11, "floor = \"xx\""},   {12, "wall = { function = \"3 - x\", kind = \"hard\" }"},
        {14, "v = \"-(v\""},      {16, "rates = { x = \"v\", v = \"a\" }"},
        {19, "mode = \"fre\""},   {26, "next = \"over\""},
        {28, "energy = \"v^2/\""}};
    std::mt19937 random(5);
    for (int trial = 0; trial < 200; ++trial) {
        std::vector<std::pair<std::size_t, std::string>> chosen;
        for (const auto& one : some)
            if (random() % 2 == 0)
                chosen.push_back(one);
        const std::vector<std::string> said = mistakes_of(text_with(chosen));
        ASSERT_EQ(said.size(), chosen.size()) << trial;
        for (std::size_t i = 0; i < said.size(); ++i)
            EXPECT_THAT(said[i], StartsWith(":" + std::to_string(chosen[i].first) + ":"));
    }
}

TEST(ModelMistakes, OfNamesEndTheReading) {
    EXPECT_THAT(mistakes_of(text_with({{7, "k = 0"}, {9, "force = \"-k*x\""}})), ElementsAre(StartsWith(":7:1: ")));
    EXPECT_THAT(mistakes_of("colour = 1\nsize = 2\n" + text_with({})),
                ElementsAre(StartsWith(":1:1: unknown key 'colour'"), StartsWith(":2:1: unknown key 'size'")));
}

} // namespace graze::model_mistakes_test
