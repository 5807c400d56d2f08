// Names that a study gives to special points (key point_names): in pictures, tables, exports and references to points.

#include "graze/picture/result_picture.hpp"
#include "graze/results/result_table.hpp"
#include "graze/results/stored_orbit.hpp"
#include "graze/study/runner.hpp"
#include "graze/study/stored_study.hpp"
#include "graze/study/study_table.hpp"

#include "base/message_of.hpp"
#include "base/temporary_folder.hpp"

#include <gmock/gmock.h>

namespace graze::point_names_test {

using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::Not;

/// @param names point_names of the branch without impacts
/// @param point name by which the other run and the table refer to its grazing
std::string study_text(const std::string& names, const std::string& point = "first touch") {
    return R"(name = "s"
model = "impact-oscillator"
set = { sigma = 0.5, omega = 1.2 }
[runs.free]
kind = "continue"
direction = "up"
set = { amplitude = 0.1 }
along = { amplitude = [0.05, 1] }
monitors = { reach = { maximum = "x" } }
)" + names +
           R"([runs.hits]
kind = "continue"
direction = "up"
start = { run = "free", point = ")" +
           point + R"(" }
along = { amplitude = [0.05, 1] }
monitors = { reach = { maximum = "x" } }
steps = 5
[runs.again]
kind = "continue"
direction = "up"
set = { amplitude = 0.1 }
along = { amplitude = [0.05, 1] }
monitors = { reach = { maximum = "x" } }
[tables.touches]
run = "free"
points = ")" +
           point + R"("
columns = ["amplitude"]
)";
}

const std::string named = "point_names = { GR1 = \"first touch\" }\n";

class PointNames : public ::testing::Test {
protected:
    std::vector<RunReport> run(const std::string& text) const {
        ResultFile file(path_, ResultFile::Access::write);
        return run_study(parse_study(text, "s.toml"), file, {});
    }
    std::vector<std::string> labels_of(const std::string& run) const {
        const ResultFile file(path_, ResultFile::Access::read);
        StudyPicture picture;
        picture.runs = {run};
        std::vector<std::string> labels;
        const ResultPicture made = make_picture(picture, file);
        for (const FigureLabel& label : made.figure.panels.at(0).labels)
            labels.push_back(label.text);
        return labels;
    }

    const testing::TemporaryFolder folder_;
    const std::string path_ = folder_ / "results.sqlite";
};

TEST_F(PointNames, ReplaceLabels) {
    for (const RunReport& report : run(study_text(named)))
        EXPECT_TRUE(report.complete()) << report.name << ": " << report.problem;
    EXPECT_THAT(labels_of("free"), Contains("first touch"));
    EXPECT_THAT(labels_of("free"), Not(Contains("GR1")));
    EXPECT_THAT(labels_of("again"), Contains("GR1")); // this run gives the point no name
    const ResultFile file(path_, ResultFile::Access::read);
    const OrbitRecord by_name = find_stored_orbit(file, "free:first touch", {}).record;
    EXPECT_EQ(by_name.label, "GR1");
    EXPECT_EQ(by_name.point.parameter, find_stored_orbit(file, "free:GR1", {}).record.point.parameter);

    const Study study = stored_study(file);
    const Table table = make_table(study.tables.at(0), file);
    ASSERT_EQ(table.rows(), 1U);
    EXPECT_EQ(table.columns().at(1).name, "name");
    EXPECT_EQ(table.text(0, 0), "GR1");
    EXPECT_EQ(table.text(0, 1), "first touch");
    EXPECT_DOUBLE_EQ(table.number(0, 2), by_name.point.parameter);

    for (const char* what : {"points", "segments"}) {
        ResultTableRequest request;
        request.what = what;
        request.runs = {"free"};
        ResultTable exported = result_table(file, request);
        bool found = false;
        while (exported.rows.next())
            for (std::size_t c = 1; c < exported.rows.columns(); ++c)
                if (exported.rows.column_name(c) == "name" && exported.rows.text(c) == "first touch") {
                    EXPECT_EQ(exported.rows.text(c - 1), "GR1");
                    found = true;
                }
        EXPECT_TRUE(found) << what;
    }
}

TEST_F(PointNames, CanChangeWithoutComputation) {
    run(study_text(named));
    const std::string other = "point_names = { GR1 = \"G-1\" }\n";
    for (const RunReport& report : run(study_text(other, "G-1")))
        if (report.name == "free") {
            EXPECT_EQ(report.computed, 0U);
        }
    EXPECT_THAT(labels_of("free"), Contains("G-1"));
    run(study_text("", "GR1"));
    EXPECT_THAT(labels_of("free"), Contains("GR1"));
}

TEST_F(PointNames, AreStoredWithTheStudy) {
    {
        ResultFile file(path_, ResultFile::Access::write);
        store_study(parse_study(study_text(named), "s.toml"), file);
    }
    const ResultFile file(path_, ResultFile::Access::read);
    const Study study = stored_study(file);
    ASSERT_EQ(study.find_run("free")->point_names.size(), 1U);
    EXPECT_EQ(study.find_run("free")->point_names[0].name, "first touch");
}

TEST(PointNamesOfStudies, AreRefusedIfAmbiguous) {
    const auto refusal = [](const std::string& names) {
        return testing::message_of([&] { parse_study(study_text("point_names = " + names + "\n", "GR1"), "s.toml"); });
    };
    EXPECT_EQ(refusal("{ GR1 = \"SN-1\" }"), "");
    EXPECT_EQ(refusal("{ R1-1 = \"resonance\" }"), "");
    for (const char* name : {"GR2", "R1-2", "SN", "12", "free:GR1", ""})
        EXPECT_THAT(refusal(std::string("{ GR1 = \"") + name + "\" }"), HasSubstr("cannot be told from a label"))
            << name;
    EXPECT_THAT(refusal("{ GR1 = \"a\", GR2 = \"a\" }"), HasSubstr("GR1 is called 'a' too"));
    EXPECT_THAT(refusal("{ touch = \"a\" }"), HasSubstr("no point has the label 'touch'"));
}

} // namespace graze::point_names_test
