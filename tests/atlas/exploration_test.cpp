// Which runs an atlas asks for next.

#include "atlas/exploration.hpp"

#include "atlas/truth_atlas.hpp"

#include <gmock/gmock.h>

namespace graze::exploration_test {

using namespace graze::testing;

/// An atlas of which only the samples have been computed.
class Sampled : public AtlasResults {
public:
    explicit Sampled(const std::string& text) : AtlasResults(text) { run_study(study, file, {}); }
    std::vector<StudyRun> next() const { return Exploration(study, *study.find_run("map"), file).next(); }
};

std::vector<std::string> names_of(const std::vector<StudyRun>& runs) {
    std::vector<std::string> names;
    for (const StudyRun& one : runs)
        names.push_back(one.name);
    return names;
}

TEST(Exploration, BeginsAtRandomNearWhereMotionsHaveSettled) {
    std::string text = flips_study("multiple = 2\n");
    text.replace(text.find("draws = 0\n"), 10, "");
    const Sampled sampled(text);
    const auto runs = sampled.next();
    ASSERT_EQ(names_of(runs), std::vector<std::string>{"map.starts"});
    // Many of its motions grow without bound, to 1e300.
    const std::vector<Variation>& axes = runs[0].motion().axes;
    ASSERT_EQ(axes.size(), 3U);
    EXPECT_GT(axes[2].low, -4);
    EXPECT_LT(axes[2].high, 6);
    EXPECT_EQ(runs[0].motion().draws, 2U);
}

TEST(Exploration, BeginsInTheRangesThatAreAskedFor) {
    std::string text = flips_study("multiple = 2\nstarts = { x = [-1, 3] }\nseed = 9\n");
    text.replace(text.find("draws = 0"), 9, "draws = 5");
    const auto runs = Sampled(text).next();
    ASSERT_EQ(runs.size(), 1U);
    const Variation& x = runs[0].motion().axes.at(2);
    EXPECT_EQ(x.low, -1);
    EXPECT_EQ(x.high, 3);
    EXPECT_EQ(runs[0].motion().draws, 5U);
    EXPECT_EQ(runs[0].motion().seed, 9U);
}

TEST(Exploration, FollowsOneBranchOfEachKindInEachRow) {
    const auto runs = Sampled(flips_study("multiple = 2\n")).next();
    ASSERT_FALSE(runs.empty());
    for (const StudyRun& one : runs) {
        EXPECT_EQ(one.kind, RunKind::follow);
        EXPECT_EQ(one.start->run, "map");
        EXPECT_EQ(one.branch().settings.least, -1.4);
        EXPECT_EQ(one.branch().settings.greatest, 1.9);
    }
    EXPECT_EQ(names_of(runs)[0], "map.branch1");
}

TEST(Exploration, NamesRunsAfterThoseThatAreThere) {
    Sampled sampled(flips_study("multiple = 2\n"));
    for (const char* name : {"map.branch7", "map.branch99999999999999999999999999999", "map.branch"}) {
        StudyRun stranger = sampled.next().at(0);
        stranger.name = name;
        stranger.start->point = "0";
        sampled.study.runs.push_back(std::move(stranger));
    }
    EXPECT_EQ(names_of(sampled.next()).at(0), "map.branch8");
}

} // namespace graze::exploration_test
