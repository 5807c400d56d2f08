// Pictures of a study are drawn again only if their inputs or files have changed.

#include "graze/picture/result_picture.hpp"
#include "run_graze.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <filesystem>

namespace graze::testing::study_pictures_test {

using ::testing::HasSubstr;

class KeptPictures : public ::testing::Test {
protected:
    KeptPictures() { write("title = \"one\""); }
    void write(const std::string& more, double end = 3) const {
        std::ofstream(folder / "model.toml") << "name = \"o\"\n[states]\nx = 1\nv = 0\n[modes.only]\n"
                                                "rates = { x = \"v\", v = \"-x\" }\n";
        std::ofstream(folder / "study.toml")
            << "name = \"s\"\nmodel = \"model.toml\"\n[runs.r]\nkind = \"simulate\"\ntime = " << end
            << "\nsample = { a = { maxima = \"x\" } }\n[pictures.p]\nkind = \"history\"\nformat = \"svg\"\nrun = "
               "\"r\"\n"
            << more << '\n';
    }
    std::string run() const {
        const std::string printed = done({"run", folder / "study.toml", "--output", folder / "out"});
        EXPECT_THAT(printed, HasSubstr("out/p.svg\n"));
        return contents(picture());
    }
    std::filesystem::path picture() const { return folder / "out/p.svg"; }
    /// Gives the picture an old time and runs the study. @return true if the study does not write the picture again
    bool is_kept() const {
        const auto old = std::filesystem::last_write_time(picture()) - std::chrono::hours(1);
        std::filesystem::last_write_time(picture(), old);
        run();
        return std::filesystem::last_write_time(picture()) == old;
    }
    Folder folder;
};

TEST_F(KeptPictures, UnchangedPicturesAreNotDrawnAgain) {
    const std::string first = run();
    EXPECT_THAT(first, HasSubstr("<svg"));
    EXPECT_TRUE(is_kept());
    EXPECT_EQ(contents(picture()), first);
}

TEST_F(KeptPictures, ChangedPicturesAndResultsAreDrawnAgain) {
    const std::string first = run();
    write("title = \"two\"");
    EXPECT_FALSE(is_kept());
    EXPECT_TRUE(is_kept());
    write("title = \"two\"", 4); // other results
    EXPECT_FALSE(is_kept());
    EXPECT_TRUE(is_kept());
}

TEST_F(KeptPictures, MissingAndModifiedPicturesAreDrawnAgain) {
    const std::string first = run();
    std::filesystem::remove(picture());
    EXPECT_EQ(run(), first);
    std::ofstream(picture()) << "something else";
    EXPECT_EQ(run(), first);
    std::ofstream(picture(), std::ios::app) << "<!-- more -->";
    EXPECT_EQ(run(), first);
    EXPECT_TRUE(is_kept());
}

// Histories compute the motion again from the model, which does not know the values that a study defines.
TEST_F(KeptPictures, ValuesOfTheStudyCanBeDrawnOverTime) {
    std::ofstream(folder / "study.toml") << "name = \"s\"\nmodel = \"model.toml\"\n[runs.r]\nkind = \"simulate\"\n"
                                            "time = 3\nvalues = [\"x\", \"balance = (x^2 - v^2)/2\"]\n"
                                            "sample = { a = { maxima = \"x\" } }\n";
    done({"run", folder / "study.toml", "--output", folder / "out", "--no-pictures"});
    const ResultFile file(folder / "out/results.sqlite", ResultFile::Access::read);
    const Figure figure = make_picture(default_picture(file.runs().front()), file).figure;
    ASSERT_EQ(figure.panels.size(), 2U);
    EXPECT_EQ(figure.panels[1].y_label, "balance");
    const std::vector<PlanePoint>& points = figure.panels[1].series.at(0).points;
    EXPECT_GT(points.size(), 50U);
    for (const PlanePoint& point : points) // x = cos t, v = -sin t
        EXPECT_NEAR(point.y, std::cos(2 * point.x) / 2, 1e-12);
}

} // namespace graze::testing::study_pictures_test
