// How pictures look: the keys of a study that say so.

#include "graze/study/stored_study.hpp"

#include <gmock/gmock.h>

namespace graze::testing::study_picture_reader_test {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Pair;

StudyPicture picture_with(const std::string& keys) {
    return parse_study("name = \"s\"\nmodel = \"bouncing-ball\"\n[runs.r]\nkind = \"simulate\"\ntime = 1\n"
                       "[pictures.p]\nrun = \"r\"\n" +
                           keys,
                       "s.toml")
        .pictures.at(0);
}

std::string problem_of(const std::string& keys) {
    try {
        picture_with(keys);
    } catch (const InputError& error) {
        EXPECT_EQ(error.place().line, 8U) << keys;
        return error.problem();
    }
    return "";
}

TEST(PictureStyle, HasTheSizeAndFontOfTheStudy) {
    const StudyPicture usual = picture_with("");
    EXPECT_EQ(usual.style.width, 0);
    EXPECT_EQ(usual.style.font_size, 0);
    EXPECT_TRUE(usual.names.empty());
    const StudyPicture picture =
        picture_with("size = [85, 60]\nfont = { name = \"Latin Modern\", size = 8 }\nx_label = \"time (s)\"\n"
                     "y_label = [\"height\", \"speed\"]\nnames = { r = \"free fall\" }\nformat = \"tex\"");
    EXPECT_EQ(picture.style.width, 85);
    EXPECT_EQ(picture.style.height, 60);
    EXPECT_EQ(picture.style.font_size, 8);
    EXPECT_EQ(picture.style.font, "Latin Modern");
    EXPECT_EQ(picture.x_label, "time (s)");
    EXPECT_THAT(picture.y_labels, ElementsAre("height", "speed"));
    EXPECT_THAT(picture.names, ElementsAre(Pair("r", "free fall")));
    EXPECT_EQ(picture.format, "tex");
    EXPECT_EQ(picture_with("size = 85").style.width, 85);
    EXPECT_EQ(picture_with("font = 8").style.font_size, 8);
    EXPECT_EQ(picture_with("font = \"Times\"").style.font, "Times");
    EXPECT_THAT(picture_with("y_label = \"height\"").y_labels, ElementsAre("height"));
}

TEST(PictureStyle, RefusesSizesThatCannotBeDrawn) {
    EXPECT_THAT(problem_of("size = \"250x140\""), HasSubstr("is a text, not a width"));
    EXPECT_THAT(problem_of("size = 5"), HasSubstr("width of 5 mm"));
    EXPECT_THAT(problem_of("size = [85, 5000]"), HasSubstr("height of 5000 mm"));
    EXPECT_THAT(problem_of("size = [85]"), HasSubstr("width and a height"));
    EXPECT_THAT(problem_of("font = 200"), HasSubstr("200 points"));
    EXPECT_THAT(problem_of("font = \"a'; system('x')\""), HasSubstr("no name of a font"));
    EXPECT_NE(problem_of("names = { r = \"a\\nb\" }"), "");
    EXPECT_NE(problem_of("names = \"r\""), "");
    EXPECT_NE(problem_of("x_label = 3"), "");
}

TEST(StudyPicture, HasAFewAxesOnly) {
    const auto axes = [](int count) {
        std::string list;
        for (int i = 0; i < count; ++i)
            list += "\"x\", ";
        return "y = [" + list + "]";
    };
    EXPECT_EQ(picture_with(axes(50)).y.size(), 50U);
    EXPECT_THROW(picture_with(axes(51)), InputError);
}

TEST(PictureStyle, IsPartOfThePicturesSettings) {
    const std::string usual = settings_of(picture_with(""));
    for (const char* keys : {"size = 85", "size = [170, 85]", "font = 8", "font = \"Times\"", "x_label = \"a\"",
                             "y_label = \"a\"", "names = { r = \"a\" }"})
        EXPECT_NE(settings_of(picture_with(keys)), usual) << keys;
}

} // namespace graze::testing::study_picture_reader_test
