#include "run_graze.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <filesystem>
#include <fstream>

namespace graze::testing::run_set_test {

using ::testing::HasSubstr;

/// A study of x' = -k x from x(0) = 1, with x(1) = exp(-k).
class RunSet : public ::testing::Test {
protected:
    RunSet() {
        std::ofstream(folder / "decay.toml") << "name = \"decay\"\n[parameters]\nk = 1\n[states]\nx = 1\n"
                                                "[modes.m]\nrates = { x = \"-k*x\" }\n";
        std::ofstream(folder / "study.toml") << "name = \"study\"\nmodel = \"decay.toml\"\n[runs.r]\n"
                                                "kind = \"simulate\"\ntime = 1\nsample = { a = { maxima = \"x\" } }\n"
                                                "[runs.swept]\nkind = \"simulate\"\ntime = 1\nvary = { k = [1, 2] }\n"
                                                "sample = { a = { maxima = \"x\" } }\n";
    }
    Printed run(const std::vector<std::string>& options) const {
        std::vector<std::string> words{"run", folder / "study.toml", "--no-pictures", "--quiet"};
        words.insert(words.end(), options.begin(), options.end());
        return run_graze(words);
    }
    double end_of(const std::string& results) const {
        const Csv csv(run_graze({"export", folder / results, "--run", "r", "--format", "csv"}).out);
        return csv.number(0, "end_x");
    }
    Folder folder;
};

TEST_F(RunSet, UsesAndStoresTheValues) {
    ASSERT_EQ(run({"--output", folder / "own"}).code, 0);
    const Printed other = run({"--output", folder / "other", "--set", "k=2*3"});
    ASSERT_EQ(other.code, 0) << other.err;
    // The tolerance of a step is 1e-12.
    EXPECT_NEAR(end_of("own"), std::exp(-1.0), 1e-12);
    EXPECT_NEAR(end_of("other"), std::exp(-6.0), 1e-12);
    EXPECT_THAT(run_graze({"info", folder / "other"}).out, HasSubstr("with k = 6\n"));
    EXPECT_THAT(run_graze({"info", folder / "other", "--format", "csv"}).out, HasSubstr("study,study,set.k,6,\n"));
    // The results alone are enough to repeat the run.
    done({"run", folder / "other", "--output", folder / "again", "--quiet", "--no-pictures"});
    EXPECT_EQ(end_of("again"), end_of("other"));
    EXPECT_EQ(run({"--output", folder / "again", "--set", "k=6"}).code, 0);
}

TEST_F(RunSet, ResultsOfDifferentValuesDoNotMix) {
    ASSERT_EQ(run({"--output", folder / "a", "--set", "k=6"}).code, 0);
    const double before = end_of("a");
    for (const std::vector<std::string>& options :
         {std::vector<std::string>{"--output", folder / "a"}, {"--output", folder / "a", "--set", "k=7"}}) {
        const Printed refused = run(options);
        EXPECT_EQ(refused.code, 2);
        EXPECT_THAT(refused.err, HasSubstr("the results there were made with k=6"));
        EXPECT_THAT(refused.err, HasSubstr("choose another folder by --output"));
        EXPECT_EQ(end_of("a"), before);
    }
    ASSERT_EQ(run({"--output", folder / "own"}).code, 0);
    EXPECT_THAT(run({"--output", folder / "own", "--set", "k=6"}).err, HasSubstr("the study's own values"));
}

TEST_F(RunSet, DefaultFolderIsNamedAfterTheValues) {
    const std::filesystem::path here = std::filesystem::current_path();
    std::filesystem::current_path(folder / ".");
    const Printed printed = run({"--set", "k=0.5"});
    std::filesystem::current_path(here);
    EXPECT_EQ(printed.code, 0) << printed.err;
    EXPECT_NEAR(end_of("study-k=0.5"), std::exp(-0.5), 1e-12);
}

TEST_F(RunSet, RefusesUnknownNamesAndValues) {
    ASSERT_EQ(run({"--output", folder / "a"}).code, 0);
    const std::vector<std::pair<std::vector<std::string>, std::string>> mistakes{
        {{"--set", "c=1"}, "--set: no model of the study has a parameter 'c'; known are: k"},
        {{"--set", "x=1"}, "--set: 'x' is a state, not a parameter"},
        {{"--set", "k"}, "--set: 'k' sets nothing; write k=VALUE"},
        {{"--set", "k=1", "k=2"}, "--set: 'k' is given twice"},
        {{"--set", "k=2*q"}, "--set k=2*q:1:5"},
        {{"--set", "k=1/0"}, "no finite value"},
    };
    for (const auto& [options, message] : mistakes)
        expect_refusal(run(options), message);
    std::ofstream(folder / "found.toml") << "model = \"another\"\n[set]\nk = 2\n";
    expect_refusal(run({"--set", "@" + (folder / "found.toml")}),
                   "found.toml:1:1: these values were found for the model 'another', not for '");
    std::ofstream(folder / "found.toml") << "[set]\nk = 2\n  wrong = 3\nx = 1\n";
    expect_refusal(run({"--set", "@" + (folder / "found.toml")}),
                   "found.toml:3:3: no model of the study has a parameter 'wrong'; ");
    std::ofstream(folder / "found.toml") << "[set]\nk = 2\nx = 1\n";
    EXPECT_THAT(run({"--set", "@" + (folder / "found.toml")}).err,
                HasSubstr("found.toml:3:1: 'x' is a state, not a parameter; "));
    EXPECT_THAT(run({"--set", "@" + (folder / "found.toml"), "--set", "x=3"}).err,
                HasSubstr("--set: 'x' is a state, not a parameter; "));
    expect_refusal({"run", folder / "a", "--set", "k=2"}, "name the study instead of its results");
}

} // namespace graze::testing::run_set_test
