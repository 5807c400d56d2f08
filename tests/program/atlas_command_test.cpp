#include "program/run_graze.hpp"

#include "atlas/truth/cubic_map.hpp"
#include "places.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>

namespace graze::testing::atlas_command_test {

using ::testing::HasSubstr;
using ::testing::Not;

const std::string model = std::string(source_folder) + "/tests/atlas/truth/cubic-map.toml";

std::string text_in(const std::string& path) {
    std::ifstream stream(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
}

class AtlasCommand : public ::testing::Test {
protected:
    std::string path(const std::string& name) const { return folder / name; }
    /// Along the slope of the map, at a fixed offset.
    std::vector<std::string> line(const std::string& output, const std::vector<std::string>& more = {}) const {
        std::vector<std::string> words{"atlas",  model,     "--along", "a=0.5:1.9:15", "--multiple", "1", "--starts",
                                       "x=-2:2", "--draws", "8",       "--output",     path(output)};
        words.insert(words.end(), more.begin(), more.end());
        return words;
    }
    TemporaryFolder folder;
};

/// Values of a column of a table in CSV, of the rows whose first cell begins with this.
std::vector<double> numbers_of(const std::string& csv, const std::string& column, const std::string& begin) {
    std::istringstream lines(csv);
    std::string row, cell;
    std::getline(lines, row);
    std::istringstream heading(row);
    std::size_t index = 0;
    while (std::getline(heading, cell, ',') && cell != column)
        ++index;
    std::vector<double> values;
    while (std::getline(lines, row)) {
        if (!row.starts_with(begin))
            continue;
        std::istringstream cells(row);
        for (std::size_t i = 0; i <= index; ++i)
            std::getline(cells, cell, ',');
        values.push_back(std::stod(cell));
    }
    return values;
}

TEST_F(AtlasCommand, TellsWhatItFoundAndDrawsIt) {
    const std::string told = done(line("a"));
    EXPECT_THAT(told, HasSubstr("Atlas 'atlas': a from 0.5 to 1.9\nFound: 2 branches with 2 special points.\n"));
    EXPECT_THAT(told, Not(HasSubstr("within the limits")));
    EXPECT_THAT(
        told,
        HasSubstr("orbits of twice the period, first at a = 1.846: their period of 2 returns exceeds `multiple`"));
    EXPECT_TRUE(std::filesystem::exists(path("a/atlas.png")));
    EXPECT_EQ(text_in(path("a/atlas.csv")), done({"atlas", path("a"), "--format", "csv"}));
    const std::string points = done({"atlas", path("a"), "--what", "points", "--format", "csv"});
    const std::vector<double> folds = numbers_of(points, "a", "SN"), flips = numbers_of(points, "a", "PD");
    ASSERT_EQ(folds.size(), 1U); // 27 b^2 = 4 (a - 1)^3, b = 0.1
    EXPECT_NEAR(truth::cubic_map::folds(folds[0]).back(), 0.1, 1e-12);
    ASSERT_EQ(flips.size(), 1U);
    EXPECT_NEAR(truth::cubic_map::flips(flips[0]).back(), 0.1, 1e-12);
}

TEST_F(AtlasCommand, ShowsStoredAtlases) {
    const std::string told = done(line("a"));
    const std::string shown = done({"atlas", path("a")});
    const std::string found = shown.substr(0, shown.find("\n\n")); // the summary
    EXPECT_THAT(told, HasSubstr(found));
    EXPECT_EQ(shown, done({"atlas", path("a/results.sqlite"), "--run", "atlas"}));
    const std::string json = done({"atlas", path("a"), "--format", "json"});
    EXPECT_THAT(json, HasSubstr("\"finished\":\"yes\""));
    EXPECT_THAT(json, HasSubstr("\"unexplained\":0"));
    for (const char* table : {"curves", "points", "branches", "motions", "left"})
        done({"atlas", path("a"), "--what", table, "--format", "csv"});
}

TEST_F(AtlasCommand, PrintsOneTableAloneForPrograms) {
    const std::string csv = done(line("a", {"--format", "csv"}));
    EXPECT_EQ(csv, done({"atlas", path("a"), "--format", "csv"}));
    EXPECT_TRUE(csv.starts_with("kind,name,type,a,"));
    EXPECT_EQ(done(line("a", {"--what", "points", "--format", "csv"})),
              done({"atlas", path("a"), "--what", "points", "--format", "csv"}));
    EXPECT_EQ(done(line("a", {"--quiet"})), "");
}

TEST_F(AtlasCommand, TheSameCommandComputesNothingAgain) {
    done(line("a"));
    const std::string again = done(line("a"));
    EXPECT_THAT(again, HasSubstr("was there"));
    const std::string whole = done({"export", path("a"), "--what", "runs", "--format", "csv"});
    std::vector<std::string> wider = line("a"); // goes on with what is there
    *(std::ranges::find(wider, "--multiple") + 1) = "2";
    done(wider);
    EXPECT_NE(done({"export", path("a"), "--what", "runs", "--format", "csv"}), whole);
    EXPECT_THAT(done({"atlas", path("a")}), HasSubstr("Found: 3 branches"));
}

TEST_F(AtlasCommand, RunsOfAStudyAreToldAlike) {
    const std::string study = path("study.toml");
    std::ofstream(study) << "name = \"maps\"\nmodel = \"" << model
                         << "\"\n[runs.one]\nkind = \"atlas\"\nvary = { a = { from = 0.5, to = 1.9, points = 15 } }\n"
                            "multiple = 1\ndraws = 1\n[runs.two]\nkind = \"atlas\"\nvary = { b = [0.1, 0.2, 0.3] }\n"
                            "multiple = 1\ndraws = 0\n";
    const std::string told = done({"run", study, "--output", path("s")});
    EXPECT_THAT(told, HasSubstr("Atlas 'one': a from 0.5 to 1.9\n"));
    EXPECT_THAT(told, HasSubstr("Atlas 'two': b from 0.1 to 0.3\n"));
    EXPECT_THAT(told, Not(HasSubstr("one.branch1 "))) << "what an atlas has made is not listed";
    expect_refusal({"atlas", path("s")}, "there are 2 atlases; choose one by --run, such as one");
    EXPECT_THAT(done({"atlas", path("s"), "--run", "two"}), HasSubstr("Atlas 'two'"));
    expect_refusal({"atlas", path("s"), "--run", "tow"}, "there is no atlas 'tow'; did you mean 'two'?");
}

/// Whatever the number of parts, and if one is computed twice or late.
TEST_F(AtlasCommand, PartsExploreAsOneProcessDoes) {
    const std::string study = path("study.toml");
    std::ofstream(study) << "name = \"maps\"\nmodel = \"" << model
                         << "\"\n[runs.map]\nkind = \"atlas\"\nvary = { a = { from = 0.5, to = 1.9, points = 5 }, "
                            "b = [0.1, 0.2] }\nmultiple = 1\ndraws = 1\n";
    done({"run", study, "--output", path("whole"), "--no-pictures"});
    const auto part = [&](const std::string& number) {
        done({"run", study, "--output", path("shared"), "--part", number, "--quiet"});
    };
    std::size_t rounds = 0;
    for (int code = exit_irregular; code != exit_success && rounds < 30; ++rounds) {
        part("1/2");
        if (rounds == 1) { // without the other part
            const Printed printed = run_graze({"merge", path("shared"), "--no-pictures", "--quiet"});
            EXPECT_EQ(printed.code, exit_irregular);
            part("1/2");
        }
        part("2/2");
        code = run_graze({"merge", path("shared"), "--no-pictures", "--quiet"}).code;
    }
    EXPECT_GE(rounds, 3U);
    EXPECT_LT(rounds, 30U);
    for (const char* table : {"curves", "points", "branches", "motions", "left"})
        EXPECT_EQ(done({"atlas", path("shared"), "--what", table, "--format", "csv"}),
                  done({"atlas", path("whole"), "--what", table, "--format", "csv"}))
            << table;
    for (const char* run : {"map", "map.starts", "map.branch1", "map.branch2", "map.curve1"})
        EXPECT_EQ(done({"export", path("shared"), "--run", run, "--format", "csv"}),
                  done({"export", path("whole"), "--run", run, "--format", "csv"}))
            << run;
}

TEST_F(AtlasCommand, RefusesWhatItCannotExplore) {
    const auto refused = [&](const std::vector<std::string>& more, const std::string& message) {
        std::vector<std::string> words{"atlas", model, "--output", path("x")};
        words.insert(words.end(), more.begin(), more.end());
        expect_refusal(words, message);
        EXPECT_FALSE(std::filesystem::exists(path("x")));
    };
    refused({"--along", "a"}, "--along: 'a' is not NAME=FROM:TO");
    refused({"--along", "a=1"}, "--along: '1' is no range");
    refused({"--along", "a=1:2:3:4"}, "--along: '1:2:3:4' is no range");
    refused({"--along", "a=1:2:1"}, "--along: '1' is no number of values");
    refused({"--along", "a=1:2:1e3"}, "--along: '1e3' is no number of values");
    refused({"--along", "a=1:x"}, "--along: unknown name 'x'");
    refused({"--along", "a=2:1"}, "let it rise");
    refused({"--along", "x=0:1"}, "--along: 'x' is a state, and an atlas is of parameters; give a range of its initial "
                                  "values: --starts x=LOW:HIGH");
    refused({"--along", "aa=0:1"}, "--along: the model has no parameter or state 'aa'; did you mean 'a'?");
    refused({"--along", "a=0:1", "--along", "a=1:2"}, "--along: 'a' is given twice");
    refused({"--along", "a=0:1", "--along", "b=0:1", "--along", "c=0:1"}, "an atlas is of one or two parameters");
    refused({"--along", "a=0:1", "--starts", "x=1"}, "--starts: '1' is no range");
    refused({"--along", "a=0:1", "--starts", "y=0:1"}, "--starts: the model has no state 'y'");
    refused({"--along", "a=0:1", "--section", "nowhere"}, "--section: ");
    refused({"--along", "a=0:1", "--from", "x"}, "--from: 'x' is not STATE=VALUE");
    refused({"--along", "a=0:1", "--curves", "3"}, "curves lie in a plane of two parameters");
    refused({"--along", "a=0:1", "--contacts", "5000"}, "--contacts: ");
    refused({"--along", "a=0:1", "--set", "c=1"}, "--set: no model of the study has a parameter 'c'");
    refused({"--minutes", "1"}, "--minutes has no effect without --along");
    expect_refusal({"atlas", model}, "--along: nothing says along which parameter");
    expect_refusal("atlas nothing", "there is no shipped model 'nothing'");
}

TEST_F(AtlasCommand, KeepsWhatAFolderHasOfAnotherBox) {
    done(line("a", {"--no-pictures"}));
    const std::string before = done({"atlas", path("a")});
    for (const char* other : {"--set=b=0.2", "--section=phase0", "--from=x=0.5"}) {
        const Printed printed = run_graze(line("a", {other}));
        if (std::string(other) == "--section=phase0")
            EXPECT_EQ(printed.code, exit_success) << "the section that is the usual one";
        else
            EXPECT_EQ(printed.code, exit_bad_input) << other;
    }
    expect_refusal({"atlas", model, "--along", "a=0.5:1.8:15", "--output", path("a")},
                   "has results of another box, model or study; choose another folder");
    EXPECT_EQ(done({"atlas", path("a")}), before);
}

TEST_F(AtlasCommand, ResultsWithoutAnAtlasAreRefused) {
    std::ofstream(path("orbit.toml")) << "name = \"o\"\nmodel = \"" << model
                                      << "\"\nset = { a = 0.5 }\n[runs.o]\nkind = \"orbit\"\n";
    done({"run", path("orbit.toml"), "--output", path("o"), "--no-pictures"});
    expect_refusal({"atlas", path("o")}, "there is no atlas in these results; make one: graze atlas MODEL --along");
}

} // namespace graze::testing::atlas_command_test
