// A drawing shows results; it is not one of the things that they depend on.
#include "graze/model/model_file.hpp"
#include "graze/results/stored_run.hpp"
#include "graze/study/stored_study.hpp"

#include "study_fixture.hpp"

#include <gtest/gtest.h>

namespace graze::drawn_model_test {

const char* const with_drawing =
    "name = \"ball\"\n[states]\nx = 1\nv = 0\n[modes.fall]\nrates = { x = \"v\", v = -1 }\n"
    "[drawing]\nx = [-1, 1]\ny = [0, 1]\n"
    "shapes = [{ kind = \"circle\", at = [0, \"x\"], radius = 0.1 }]\n";
const char* const study = "name = \"s\"\nmodel = \"./ball.toml\"\n[runs.fall]\nkind = \"simulate\"\ntime = 1\n"
                          "sample = { lowest = { minima = \"x\" } }\n";

class DrawnModel : public testing::StudyFixture {
protected:
    std::size_t computed(const std::string& model) {
        folder_.write("ball.toml", model);
        return run(study).at(0).computed;
    }
    Model stored_model() const { return StoredRun(ResultFile(path_, ResultFile::Access::read), "fall", {}).model; }
};

TEST_F(DrawnModel, ResultsStayWhenTheDrawingChanges) {
    const std::string text = with_drawing;
    EXPECT_EQ(computed(text), 1U);
    std::string other = text;
    other.replace(other.find("0.1"), 3, "0.2");
    EXPECT_EQ(computed(other), 0U);
    EXPECT_EQ(stored_model().drawing->shapes.at(0).radius, "0.2"); // the new one is shown
    EXPECT_EQ(computed(text.substr(0, text.find("[drawing]"))), 0U);
    other.replace(other.find("v = -1"), 6, "v = -2");
    EXPECT_EQ(computed(other), 1U);
}

TEST_F(DrawnModel, ResultsHaveTheDrawing) {
    computed(with_drawing);
    const ResultFile file(path_, ResultFile::Access::read);
    ASSERT_TRUE(stored_model().drawing);
    EXPECT_EQ(stored_model().drawing->shapes.at(0).radius, "0.1");
    EXPECT_TRUE(stored_study(file).runs.at(0).model.drawing);
}

/// The model of a virtual bench is one of the settings of its run.
TEST_F(DrawnModel, ABenchStaysToo) {
    const std::string bench = "name = \"s\"\nmodel = \"impact-oscillator\"\n[runs.r]\nkind = \"record\"\n"
                              "vary = { amplitude = { from = 0.8, to = 1, step = 0.1 } }\nreference = \"F\"\n"
                              "[runs.r.bench]\nchannels = { F = \"sin(theta)\", x = \"x\" }\nrate = 20\nsettle = 30\n"
                              "time = 20\n";
    const auto settings = [&](bool drawn) {
        Study made = parse_study(bench, "s.toml");
        for (StudyRun& run : made.runs)
            if (!drawn)
                run.record().bench->model.drawing.reset();
        return settings_of(made.runs.at(0));
    };
    EXPECT_EQ(settings(true), settings(false));
}

} // namespace graze::drawn_model_test
