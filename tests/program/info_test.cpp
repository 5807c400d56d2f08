#include "branch_results.hpp"
#include "results/schema.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>

#include <filesystem>
#include <fstream>
#include <regex>

#include <sys/stat.h>

namespace graze::testing::info_test {

using ::testing::HasSubstr;
using ::testing::MatchesRegex;
using ::testing::Not;
using ::testing::StartsWith;

using Info = BranchResults;

constexpr const char* study = R"(
name = "two"
text = "Two runs."
source = "Nowhere"
model = "model.toml"
set = { w = 3 }
[runs.swept]
kind = "sweep"
vary = { g = { from = 1, to = 2, points = 11 } }
[runs.thrown]
kind = "simulate"
time = 1
sample = { top = { maxima = "x" } }
[pictures.all]
run = "swept"
)";

/// The value of a fact in CSV without quoted cells. @param start item, name and property
std::string fact(const std::string& csv, const std::string& start) {
    const std::size_t at = csv.find("\n" + start + ",");
    if (at == std::string::npos)
        return "none";
    const std::size_t begin = at + start.size() + 2;
    return csv.substr(begin, csv.find(',', begin) - begin);
}

void write_model(const std::string& path) {
    std::ofstream(path)
        << "name = \"rest\"\ntext = \"A state that falls.\"\n[parameters]\nw = 1\ng = { value = 2, unit "
           "= \"m\" }\n[states]\nx = 1\n[modes.m]\nrates = { x = \"-g*x*w\" }\nwatch = [\"low\"]\n"
           "[events.low]\nfunction = \"x - 0.1\"\nkind = \"section\"\n[[transitions]]\nmode = \"m\"\n"
           "event = \"low\"\nnext = [{ mode = \"end\" }]\n[sections.s]\nfunction = \"x - 0.5\"\n";
}

TEST_F(Info, CountsPointsOfResults) {
    write_branches();
    const std::string csv = done({"info", path, "--format", "csv"});
    EXPECT_THAT(csv, StartsWith("item,name,property,value,unit\n"));
    EXPECT_EQ(fact(csv, "file,,kind"), "results");
    EXPECT_EQ(fact(csv, "file,,size"), fmt::format("{}", std::filesystem::file_size(path)));
    EXPECT_EQ(fact(csv, "file,,format"), fmt::format("{}", result_format));
    EXPECT_EQ(fact(csv, "run,first,kind"), "continue");
    EXPECT_EQ(fact(csv, "run,first,points"), "10");
    EXPECT_EQ(fact(csv, "run,first,segments"), "10");
    EXPECT_EQ(fact(csv, "run,second,points"), "2");
    EXPECT_EQ(fact(csv, "run,alone,status"), "complete");
    EXPECT_EQ(fact(csv, "run,alone,version"), "test");
    EXPECT_EQ(fact(csv, "run,alone,model"), "ball");
    EXPECT_EQ(fact(csv, "parameter,first,g"), "2");
    const std::string text = done({"info", folder / "."});
    EXPECT_THAT(text, HasSubstr("3 runs, of model ball, by graze test\n"));
    EXPECT_THAT(text, HasSubstr("first   continue  complete      10"));
    EXPECT_TRUE(JsonCheck(run_graze({"info", path, "--format", "json"}).out).valid());
}

TEST_F(Info, ShowsHowAndWhenResultsWereComputed) {
    write_model(folder / "model.toml");
    std::ofstream(folder / "two.toml") << study;
    const std::string results = folder / "made";
    const std::vector<std::string> run{"run", folder / "two.toml", "--output", results, "--no-pictures", "--quiet"};
    done(run);
    const std::string csv = run_graze({"info", results, "--format", "csv"}).out;
    EXPECT_EQ(fact(csv, "study,two,text"), "Two runs.");
    EXPECT_EQ(fact(csv, "run,swept,planned"), "11");
    EXPECT_EQ(fact(csv, "run,swept,points"), "11");
    EXPECT_EQ(fact(csv, "setting,swept,vary.1.name"), "g");
    EXPECT_EQ(fact(csv, "setting,swept,vary.1.values.count"), "11");
    EXPECT_EQ(fact(csv, "setting,swept,vary.1.values.last"), "2");
    EXPECT_EQ(fact(csv, "setting,thrown,time"), "1");
    EXPECT_EQ(fact(csv, "parameter,swept,w"), "3");
    EXPECT_EQ(fact(csv, "parameter,swept,g"), "2");
    EXPECT_THAT(fact(csv, "run,swept,version"), StartsWith("0."));
    const std::string begun = fact(csv, "run,swept,begun"), ended = fact(csv, "run,swept,ended");
    EXPECT_TRUE(std::regex_match(begun, std::regex("20..-..-..T..:..:..Z"))) << begun;
    EXPECT_LE(begun, ended);
    EXPECT_EQ(fact(csv, "picture,all,run"), "swept");
    // A second run computes nothing and changes no time.
    done(run);
    const std::string again = run_graze({"info", results, "--format", "csv"}).out;
    for (const char* one : {"run,swept,begun", "run,swept,ended", "run,swept,seconds", "run,thrown,seconds"})
        EXPECT_EQ(fact(again, one), fact(csv, one));
    const std::string text = run_graze({"info", results}).out;
    EXPECT_THAT(text, HasSubstr("study two\nTwo runs.\nSource: Nowhere\n"));
    EXPECT_THAT(text, HasSubstr("g from 1 to 2 (11 values)"));
    EXPECT_THAT(text, HasSubstr("1 picture: all"));
    EXPECT_THAT(text, Not(HasSubstr("  w = 3")));
    EXPECT_THAT(run_graze({"info", results, "--all"}).out, HasSubstr("run swept: parameters\n  w = 3\n  g = 2 m\n"));
}

TEST_F(Info, ListsRunsWithinAHundredColumns) {
    for (const char* name : {"microactuator", "microbeam", "electromagnetic-testbed", "mems-switch",
                             "testbed-experiment", "ball-and-shaker"}) {
        const std::string printed = done(std::vector<std::string>{"info", name});
        std::istringstream text(printed);
        for (std::string line; std::getline(text, line);)
            EXPECT_LE(line.size(), 110U) << name << ": " << line; // some letters have two bytes
    }
}

TEST_F(Info, RefusesEmptyAndSpecialFiles) {
    const Folder begun;
    const auto refused = [&](const std::string& name, const std::string& words) {
        expect_refusal(std::vector<std::string>{"info", name}, words);
    };
    std::ofstream(begun / "results.sqlite");
    refused(std::filesystem::path(begun / "results.sqlite").parent_path().string(),
            "results.sqlite: nothing has been computed yet");
    refused(begun / "results.sqlite", "results.sqlite: the file is empty");
    refused("/dev/null", "/dev/null: this is no plain file");
    ASSERT_EQ(mkfifo((begun / "pipe").c_str(), 0600), 0);
    refused(begun / "pipe", "pipe: this is no plain file");
}

TEST_F(Info, DescribesModelsAndStudies) {
    write_model(folder / "model.toml");
    std::ofstream(folder / "two.toml") << study;
    const std::string told = run_graze({"info", folder / "model.toml", "--format", "csv"}).out;
    EXPECT_EQ(fact(told, "file,,kind"), "model");
    EXPECT_EQ(fact(told, "model,rest,states"), "1");
    EXPECT_EQ(fact(told, "model,rest,parameters"), "2");
    EXPECT_EQ(fact(told, "model,rest,modes"), "1");
    EXPECT_EQ(fact(told, "model,rest,events"), "1");
    EXPECT_EQ(fact(told, "model,rest,sections"), "1");
    const std::string two = run_graze({"info", folder / "two.toml", "--format", "csv"}).out;
    EXPECT_EQ(fact(two, "file,,kind"), "study");
    EXPECT_EQ(fact(two, "run,swept,planned"), "11");
    EXPECT_EQ(fact(two, "run,thrown,model"), "rest");
    EXPECT_EQ(fact(two, "setting,swept,kind"), "sweep");
    const std::string shipped = done("info mems-switch");
    EXPECT_THAT(shipped, StartsWith("model and study, of graze 0."));
    EXPECT_THAT(run_graze("info bouncing-ball").out, StartsWith("model, of graze 0."));
    EXPECT_EQ(run_graze({"info", "bouncing-ball", "--output", folder / "told.txt"}).out, "");
    EXPECT_THAT(contents(folder / "told.txt"), StartsWith("model, of graze"));
}

TEST_F(Info, RefusesUnreadableInputs) {
    write_model(folder / "model.toml");
    std::ofstream(folder / "torn.toml") << "name = \"torn";
    std::filesystem::create_directory(folder / "empty");
    const std::vector<std::pair<std::vector<std::string>, std::string>> mistakes{
        {{"info"}, "the file is missing"},
        {{"info", "mems-swich"}, "did you mean 'mems-switch'?"},
        {{"info", folder / "none.toml"}, "none.toml"},
        {{"info", folder / "empty"}, "there are no results in this folder"},
        {{"info", folder / "torn.toml"}, "torn.toml:1:"},
        {{"info", folder / "model.toml", "--format", "xml"}, "choose table, csv or json"},
        {{"info", folder / "model.toml", "--output", folder / "model.toml"}, "choose another name"},
    };
    for (const auto& [words, message] : mistakes)
        expect_refusal(words, message);
}

} // namespace graze::testing::info_test
