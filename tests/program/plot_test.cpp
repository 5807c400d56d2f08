#include "program/process.hpp"
#include "run_graze.hpp"

#include <gmock/gmock.h>

namespace graze::testing::plot_test {

using ::testing::HasSubstr;

class Plot : public ::testing::Test {
protected:
    void SetUp() override {
        if (!find_program("gnuplot"))
            GTEST_SKIP() << "no gnuplot";
    }
    Folder folder;
};

TEST_F(Plot, DrawsEveryShippedModelWithAClockWithoutATable) {
    for (const std::string model :
         {"ball-and-shaker", "belt-oscillator", "bouncing-ball", "cam-follower", "dry-friction-oscillator",
          "electromagnetic-testbed", "impact-microactuator", "impact-oscillator", "impact-oscillator-two-stops",
          "mems-switch", "microbeam", "rocking-block"}) {
        const std::string file = folder / (model + ".svg");
        const std::string run = done("simulate " + model + " --periods 3 --quiet --plot " + file);
        EXPECT_EQ(run, "") << "a picture alone comes without a table";
        const std::string picture = contents(file);
        EXPECT_THAT(picture, HasSubstr("</svg>"));
        EXPECT_GT(picture.size(), 5000U);
    }
    EXPECT_EQ(folder.files(), 12U);
}

TEST_F(Plot, OtherFormatsComeWithATableIfAsked) {
    for (const std::string ending : {"png", "pdf"}) {
        const std::string run =
            done("simulate mems-switch --section phase0 --format csv --portrait q,v theta,energy --plot " +
                 (folder / ("switch." + ending)));
        EXPECT_EQ(header(run), "section,time,direction,mode,q,v,theta");
        EXPECT_GT(contents(folder / ("switch." + ending)).size(), 5000U);
    }
}

TEST_F(Plot, NeverRunsTextOfAModel) {
    const std::string trace = folder / "trace", model = folder / "model.toml";
    const std::string text = "`echo>" + trace + "` #1 \\\" a_b^c{d}@e&f~g\\\\";
    std::ofstream(model) << ("[states]\nx = { initial = 1, unit = \"" + text + "\", text = \"" + text +
                             "\" }\ny = 0\n[modes.only.rates]\nx = \"y\"\ny = \"-x\"\n");
    const std::string picture = folder / "picture.svg";
    done("simulate " + model + " --time 6 --plot " + picture);
    EXPECT_FALSE(std::filesystem::exists(trace));
    EXPECT_THAT(contents(picture), HasSubstr("`echo"));
    EXPECT_THAT(contents(picture), HasSubstr("#1"));
}

TEST_F(Plot, KeptCommandsDrawTheSamePicture) {
    const std::string picture = folder / "it's_mine.svg", commands = folder / "mine.gp";
    done("simulate mems-switch --quantity q gap --plot " + picture + " --data " + commands);
    const std::string first = contents(picture);
    std::filesystem::remove(picture);
    const ProcessResult again = run_process({*find_program("gnuplot"), commands}, "");
    EXPECT_EQ(again.status, 0) << again.output;
    EXPECT_EQ(again.output, "");
    EXPECT_EQ(contents(picture), first);
}

TEST_F(Plot, IsRefusedBeforeTheRunIfItCannotBeWritten) {
    expect_refusal("simulate mems-switch --plot " + (folder / "no/such/folder.svg"), "cannot be written");
}

} // namespace graze::testing::plot_test
