#include "graze/study/study_table.hpp"

#include "graze/results/name_advice.hpp"
#include "graze/study/stored_study.hpp"

#include "study_fixture.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>
#include <string>
#include <vector>

namespace graze::study_table_test {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

const std::string runs = R"(name = "s"
model = "impact-oscillator"
set = { sigma = 0.5, omega = 1.2 }
[runs.free]
kind = "orbit"
set = { amplitude = 0.1 }
[runs.up]
kind = "continue"
direction = "up"
start = { run = "free" }
along = { amplitude = [0.05, 1] }
monitors = { reach = { maximum = "x" } }
[runs.hits]
kind = "continue"
direction = "up"
start = { run = "up", point = "GR1" }
along = { amplitude = [0.05, 1] }
monitors = { reach = { maximum = "x" } }
[runs.motion]
kind = "simulate"
time = 30
from = { x = -0.4 }
values = ["x", "twice = 2*x"]
sample = { low = { minima = "x" }, high = { maxima = "x" } }
)";

std::string refusal(const std::string& table) {
    return testing::message_of([&] { parse_study(runs + table, "s.toml"); });
}

std::size_t column(const Table& table, const std::string& name) {
    for (std::size_t c = 0; c < table.columns().size(); ++c)
        if (table.columns()[c].name == name)
            return c;
    throw std::out_of_range(name);
}

/// The results of these runs of a study.
struct Results : testing::StudyResults {
    Results(const Study& of, const std::vector<std::string>& only) : StudyResults(of) { run(only); }
};

TEST(StudyTable, HasRowsOfSpecialPoints) {
    const Study study = parse_study(runs + R"(
[tables.grazings]
runs = ["up", "hits"]
points = "GR"
columns = ["amplitude", "depth = reach + 0", "signature"]
[tables.all]
run = "up"
columns = ["amplitude"]
)",
                                    "s.toml");
    const Results results(study, {"up", "hits"});
    const Table table = make_table(results.table("grazings"), results.file());
    EXPECT_THAT(names_of(table.columns()), ElementsAre("run", "label", "amplitude", "depth", "signature"));
    ASSERT_GE(table.rows(), 1u);
    EXPECT_EQ(table.text(0, 0), "up");
    EXPECT_EQ(table.text(0, 1), "GR1");
    // The motion without contact has the amplitude a/|1 - omega^2 + 2 i zeta omega|, and the wall is at sigma.
    const Model& model = study.runs.front().model;
    const double zeta = model.parameters[*model.find_parameter("zeta")].value.value();
    const double grazing = 0.5 * std::hypot(1 - 1.44, 2 * zeta * 1.2);
    EXPECT_NEAR(table.number(0, 2), grazing, 1e-11 * grazing);
    EXPECT_NEAR(table.number(0, 3), 0.5, 1e-11);
    EXPECT_FALSE(table.text(0, 4).empty());
    // Without types, all points that have a label.
    EXPECT_EQ(make_table(results.table("all"), results.file()).rows(), results.file().orbits("up", true).size());
}

TEST(StudyTable, HasRowsOfSamplesOrOfPoints) {
    const Study study = parse_study(runs + R"(
[tables.lows]
run = "motion"
columns = ["x", "same = twice/2", "t = s.time"]
samples = "low"
[tables.points]
run = "motion"
columns = ["ending_time"]
)",
                                    "s.toml");
    const Results results(study, {"motion"});
    const Table lows = make_table(results.table("lows"), results.file());
    EXPECT_THAT(names_of(lows.columns()), ElementsAre("x", "same", "t"));
    ASSERT_GT(lows.rows(), 2u);
    for (std::size_t r = 0; r < lows.rows(); ++r) {
        EXPECT_EQ(lows.number(r, 0), lows.number(r, 1));
        EXPECT_LT(lows.number(r, 0), 0);
        EXPECT_GT(lows.number(r, 2), r == 0 ? 0 : lows.number(r - 1, 2));
    }
    const Table points = make_table(results.table("points"), results.file());
    ASSERT_EQ(points.rows(), 1u);
    EXPECT_EQ(points.number(0, 0), 30);
}

TEST(StudyTable, HasRatiosOfSuccessiveDistances) {
    const Study study = parse_study(R"toml(name = "s"
model = "impact-oscillator"
[runs.times]
kind = "simulate"
vary = { sigma = [1, 2, 4, 8] }
time = 1
[tables.ratios]
run = "times"
columns = ["sigma", "third = sigma/3", "constant = 3.0", "label", "gap = nullif(sigma, 4)"]
ratios = { of_sigma = "sigma", of_third = "third", of_none = "constant", of_words = "label", of_gap = "gap" }
)toml",
                                    "s.toml");
    const Results results(study, {});
    const Table table = make_table(study.tables.at(0), results.file());
    ASSERT_EQ(table.rows(), 4u);
    EXPECT_EQ(column(table, "of_sigma"), 5u); // behind the columns
    for (const char* doubling : {"of_sigma", "of_third"}) {
        for (std::size_t r : {0u, 1u})
            EXPECT_NEAR(table.number(r, column(table, doubling)), 2, 1e-14) << doubling;
        for (std::size_t r : {2u, 3u})
            EXPECT_TRUE(table.is_missing(r, column(table, doubling))) << doubling;
    }
    for (const char* none : {"of_none", "of_words", "of_gap"})
        for (std::size_t r = 0; r < 4; ++r)
            EXPECT_TRUE(table.is_missing(r, column(table, none))) << none;
}

TEST(StudyTable, TellsWhatTheResultsDoNotHave) {
    const Study study = parse_study(runs + "[tables.t]\nrun = \"up\"\ncolumns = [\"speed\"]\n", "s.toml");
    const Results results(study, {"up"});
    EXPECT_THAT(testing::message_of([&] { make_table(study.tables.at(0), results.file()); }),
                HasSubstr("s.toml:25:9: run 'up': no such column: speed"));
}

TEST(StudyTable, IsStoredWithTheResults) {
    const Study study = parse_study(
        runs +
            "[tables.t]\ntext = \"why\"\nruns = [\"up\", \"hits\"]\npoints = \"GR1\"\ncolumns = [\"a = amplitude\"]\n"
            "ratios = { lambda = \"a\" }\ndirections = \"up\"\n",
        "s.toml");
    const Results results(study, {"up", "hits"});
    const Study stored = stored_study(results.file());
    ASSERT_EQ(stored.tables.size(), 1u);
    const StudyTable &one = stored.tables[0], &given = study.tables[0];
    EXPECT_EQ(one.name, given.name);
    EXPECT_EQ(one.text, given.text);
    EXPECT_EQ(one.runs, given.runs);
    EXPECT_EQ(one.points, given.points);
    EXPECT_EQ(one.directions, given.directions);
    EXPECT_EQ(one.columns.at(0).name, "a");
    EXPECT_EQ(one.columns.at(0).value, "amplitude");
    EXPECT_EQ(one.ratios.at(0).value, "a");
    EXPECT_EQ(make_table(one, results.file()).number(0, 2), make_table(given, results.file()).number(0, 2));
}

TEST(StudyTable, MistakesAreReportedWithPlaceAndRemedy) {
    struct Case {
        std::string table, message;
    };
    for (
        const Case& wrong : std::vector<Case>{
            {"[tables.t]\ncolumns = \"x\"", "s.toml:25:9: tables.t shows no run; give run = \"NAME\""},
            {"[tables.t]\nrun = \"up\"", "s.toml:25:9: tables.t has no columns; name parameters, values or monitors"},
            {"[tables.t]\nrun = \"upp\"\ncolumns = \"x\"",
             "s.toml:25:9: the study has no run 'upp'; did you mean 'up'?"},
            {"[tables.t]\nrun = \"up\"\ncolums = \"x\"",
             "s.toml:27:1: unknown key 'colums' in tables.t; did you mean 'columns'?"},
            {"[tables.\"a/b\"]\nrun = \"up\"", "s.toml:25:9: 'a/b' cannot be the name of a table"},
            {"[tables.t]\nruns = [\"up\", \"motion\"]\ncolumns = \"x\"",
             "branches and other runs have different columns"},
            {"[tables.t]\nrun = \"up\"\ncolumns = [\"x\", \"x = reach\"]",
             "s.toml:27:17: there is another column 'x'; leave it out, or give it a name of its own: \"NAME = reach\""},
            {"[tables.t]\nrun = \"up\"\ncolumns = \"x =\"", "s.toml:27:11: tables.t.columns names nothing"},
            {"[tables.t]\nrun = \"up\"\ncolumns = \"label\"", "s.toml:25:9: the table has a column 'label' by itself"},
            {"[tables.t]\nruns = [\"up\", \"hits\"]\ncolumns = \"run = reach\"",
             "the table has a column 'run' by itself"},
            {"[tables.t]\nrun = \"up\"\ncolumns = \"x\"\nratios = { x = \"x\" }",
             "s.toml:28:12: there is another column 'x'"},
            {"[tables.t]\nrun = \"up\"\ncolumns = \"reach\"\nratios = { r = \"rech\" }",
             "s.toml:28:16: the table has no column 'rech'; did you mean 'reach'?"},
            {"[tables.t]\nrun = \"up\"\ncolumns = \"x\"\npoints = [\"GR\", \"XY1\"]",
             "s.toml:28:10: 'XY1' is no label, no name and no type of points; labels are like GR1; types are SN"},
            {"[tables.t]\nrun = \"up\"\ncolumns = \"x\"\npoints = \"GR1x\"", "'GR1x' is no label, no name"},
            {"[tables.t]\nrun = \"motion\"\ncolumns = \"x\"\npoints = \"GR\"", "points of run 'motion' have no labels"},
            {"[tables.t]\nrun = \"up\"\ncolumns = \"x\"\nsamples = \"low\"", "orbits of run 'up' are not sampled"},
            {"[tables.t]\nrun = \"motion\"\ncolumns = \"x\"\nsamples = \"lw\"",
             "there is no sampling 'lw'; did you mean 'low'?"},
            {"[pictures.t]\nrun = \"up\"\n[tables.t]\nrun = \"up\"\ncolumns = \"x\"",
             "s.toml:27:9: there is a picture 't', whose table has the same file; give the table another name"},
        })
        EXPECT_THAT(refusal(wrong.table), HasSubstr(wrong.message)) << wrong.table;
    EXPECT_EQ(refusal("[tables.t]\nrun = \"motion\"\ncolumns = [\"label\", \"x\", \"is_low = x <= -0.1\"]"), "");
}

} // namespace graze::study_table_test
