// Explorations against models whose curves and points of codimension two are known in closed form.

#include "atlas/truth_atlas.hpp"
#include "study/study_fixture.hpp"
#include "truth/cubic_map.hpp"
#include "truth/impact_line.hpp"
#include "truth/square_root_map.hpp"
#include "truth/torus_map.hpp"

#include <gmock/gmock.h>

#include <array>

namespace graze::run_atlas_test {

using namespace graze::testing;
using ::testing::HasSubstr;

AtlasFindings found_by(const std::string& text) {
    AtlasResults results(text);
    expect_complete(results.run());
    return results.findings();
}

TEST(RunAtlas, FindsAllOfTheCubicMap) {
    namespace known = truth::cubic_map;
    const AtlasFindings found = found_by(
        atlas_study(truth_model("cubic-map"), "vary = { a = { from = -1.4, to = 1.9, points = 24 }, b = [-1.5, -1.2, "
                                              "-0.7, -0.2, 0.15, 0.6, 1.15, 1.5] }\nmultiple = 2\ndraws = 6\n"));
    expect_truth(found, known::box, known::curves, known::joints());
}

TEST(RunAtlas, FindsAllOfTheMapWithTori) {
    namespace known = truth::torus_map;
    const AtlasFindings found = found_by(atlas_study(
        truth_model("torus-map"), "vary = { beta = { from = -1.3, to = 1.5, points = 29 }, alpha = [-1.2, -0.5, 0.1, "
                                  "0.65, 1.3, 2.2, 2.5, 2.8] }\nmultiple = 2\ndraws = 6\n"
                                  "starts = { x = [0.5, 3], y = [-0.5, 2] }\n"));
    expect_truth(found, known::box, known::curves, known::joints());
}

TEST(RunAtlas, FindsAllOfTheSquareRootMap) {
    namespace known = truth::square_root_map;
    const AtlasFindings found = found_by(atlas_study(truth_model("square-root-map"),
                                                     "vary = { a = { from = -0.7, to = 0.8, points = 10 }, m = [0, "
                                                     "0.35, 0.45, 0.55, 0.62, 0.7, 0.9, 1.2] }\nmultiple = 2\n"
                                                     "contacts = 1\n"));
    expect_truth(found, known::box, known::curves, known::joints());
}

TEST(RunAtlas, FindsAllOfTheSquareRootMapWithTori) {
    namespace known = truth::square_root_map;
    const AtlasFindings found = found_by(atlas_study(
        truth_model("square-root-map"), "set = { d = -0.5 }\nvary = { a = { from = -0.4, to = 0.1, points = 12 }, m = "
                                        "[0, 0.3, 0.47, 0.9] }\nmultiple = 2\ncontacts = 1\n"));
    expect_truth(found, known::torus_box, known::torus_box_curves, known::torus_box_joints());
}

TEST(RunAtlas, FindsAllOfTheOscillatorWithAStop) {
    namespace known = truth::impact_line;
    expect_truth(found_by(line_study()), known::box, known::curves, known::joints());
}

TEST(RunAtlas, IsTheSameForAnyNumberOfThreadsAndComputesNothingTwice) {
    AtlasResults one(line_study()), two(line_study());
    one.run({.jobs = 1});
    two.run({.jobs = 2});
    EXPECT_EQ(bits_of(one.file), bits_of(two.file));
    for (const RunReport& report : two.run({.jobs = 1}))
        EXPECT_EQ(report.computed, 0U) << report.name;
    EXPECT_EQ(bits_of(one.file), bits_of(two.file));
}

/// Parameters that it takes over from where it begins are those of its motions, too.
TEST(RunAtlas, BeginsWhereAnotherRunHasEnded) {
    const std::string text =
        fmt::format("name = \"s\"\nmodel = \"{}\"\n[runs.first]\nkind = \"sweep\"\nset = {{ a = 0.5 }}\n"
                    "vary = {{ b = [0.15, 0.2] }}\n[runs.map]\nkind = \"atlas\"\nstart = {{ run = \"first\" }}\n"
                    "vary = {{ a = {{ from = 0.5, to = 1.4, points = 4 }} }}\nmultiple = 1\n",
                    truth_model("cubic-map"));
    AtlasResults results(text);
    results.run();
    const AtlasFindings found = results.findings();
    EXPECT_GT(found.count(AtlasClaim::explained), 4U);
    EXPECT_EQ(found.count(AtlasClaim::unexplained), 0U);
}

TEST(RunAtlas, GoesOnAfterInterruptions) {
    AtlasResults whole(line_study()), parts(line_study());
    whole.run();
    int calls = 0, most = 0;
    for (calls = 0; calls < 20 && !(calls > 0 && parts.findings().finished); ++calls) {
        most = parts.rounds + 2; // what is there already, and one round more
        parts.run({.interrupted = [&] { return parts.rounds >= most; }});
    }
    EXPECT_GT(calls, 2);
    EXPECT_EQ(text_of(parts.findings()), text_of(whole.findings()));
    for (const AtlasBranch& branch : whole.findings().branches)
        EXPECT_EQ(parts.file.orbits(branch.run, false).size(), whole.file.orbits(branch.run, false).size());
}

TEST(RunAtlas, NotesOfStrangersHarmNothing) {
    AtlasResults plain(line_study()), other(line_study());
    plain.run();
    other.file.set_note("atlas map", "same map.branch1 map.branch1\nsame map.branch2 map.curve1\nsame map.branch3 "
                                     "map.branch99\non map 3 map.branch1 100000\non map 5 map.branch7 -3\non x y z\n"
                                     "not map 1\non\nsame\n\n\xff\xfe 99999999999999999999999999 \n");
    other.run();
    EXPECT_EQ(text_of(other.findings()), text_of(plain.findings()));
}

TEST(RunAtlas, FollowsNothingBeyondItsLimits) {
    const AtlasFindings all = found_by(flips_study("multiple = 2\n"));
    const AtlasFindings simple = found_by(flips_study("multiple = 1\n"));
    const AtlasFindings few = found_by(flips_study("multiple = 2\nbranches = 3\ncurves = 1\n"));
    const auto has_doubled = [](const AtlasFindings& found) {
        return std::ranges::any_of(found.branches, [](const AtlasBranch& one) { return one.multiple > 1; });
    };
    const auto remainders = [](const AtlasFindings& found) {
        std::string text;
        for (const AtlasRemainder& one : found.remainders)
            text += one.what + ": " + one.why + '\n';
        return text;
    };
    EXPECT_TRUE(has_doubled(all));
    EXPECT_FALSE(has_doubled(simple));
    EXPECT_THAT(remainders(simple), HasSubstr("their period of 2 returns exceeds `multiple`"));
    EXPECT_LE(few.branches.size(), 3U);
    EXPECT_LE(few.curves.size(), 1U);
    EXPECT_GT(all.curves.size(), 1U);
    EXPECT_TRUE(few.finished);
    EXPECT_THAT(remainders(few), HasSubstr("1 curves have been followed: `curves`"));
    AtlasResults none(flips_study("multiple = 2\nminutes = 1e-9\n"));
    none.run();
    EXPECT_FALSE(none.findings().finished);
    EXPECT_TRUE(none.findings().branches.empty());
}

TEST(RunAtlas, FollowsNoContactsBeyondItsLimit) {
    std::string text = line_study();
    text.replace(text.find("contacts = 1"), 12, "contacts = 0");
    const AtlasFindings found = found_by(text);
    EXPECT_TRUE(found.finished);
    ASSERT_EQ(found.curves.size(), 1U);
    EXPECT_EQ(found.curves[0].name, "GR-a");
    for (const AtlasBranch& one : found.branches)
        EXPECT_EQ(one.contacts, 0U) << one.run;
    EXPECT_GT(found.count(AtlasClaim::beyond), 0U);
}

TEST(RunAtlas, HasNoCurvesInOneParameter) {
    const AtlasFindings found = found_by(
        atlas_study(truth_model("cubic-map"),
                    "set = { b = 0.5 }\nvary = { a = { from = -1.4, to = 1.9, points = 12 } }\nmultiple = 2\n"));
    EXPECT_TRUE(found.finished);
    EXPECT_TRUE(found.rows.empty());
    EXPECT_TRUE(found.curves.empty());
    EXPECT_EQ(found.branches.size(), 2U);
    // Two flips of period 1, and one of period 2.
    std::vector<std::string> names;
    for (const AtlasPoint& one : found.points) {
        names.push_back(one.name);
        const auto& curve = truth::cubic_map::curves[(one.multiple == 2 ? 2 : 0) + (one.name[0] == 'P' ? 1 : 0)];
        EXPECT_LT(off_curve(curve, {one.at[0], 0.5}), 1e-9) << one.name;
        EXPECT_EQ(one.at.size(), 1U);
    }
    EXPECT_THAT(names, ::testing::ElementsAre("PD1", "PD2", "PD3"));
}

/// The cubic map with lengths and times in other units.
std::string scaled_map(double length, double time) {
    std::string text = contents(truth_model("cubic-map"));
    const auto replace = [&](const std::string& from, const std::string& to) {
        text.replace(text.find(from), from.size(), to);
    };
    replace("[states]", fmt::format("L = {{ value = {:.17g}, text = \"length\" }}\nT = {{ value = {:.17g}, text = "
                                    "\"time\" }}\n\n[states]",
                                    length, time));
    replace("x - 1", "x - L");
    replace("{ x = 1, theta = 1 }", "{ x = \"L/T\", theta = \"1/T\" }");
    replace("a*before - before^3 + b", "a*before - before^3/L^2 + b*L");
    replace("x - 3/4", "x - 3/4*L");
    return text;
}

TEST(RunAtlas, IsTheSameInOtherUnits) {
    const auto in_units = [](double length, double time) {
        const TemporaryFolder folder;
        std::string study = flips_study("multiple = 2\n");
        const std::string model = truth_model("cubic-map");
        study.replace(study.find(model), model.size(), folder.write("m.toml", scaled_map(length, time)));
        return text_of(found_by(study), 8);
    };
    const std::string usual = in_units(1, 1);
    EXPECT_THAT(usual, HasSubstr("GF2"));
    EXPECT_EQ(in_units(1e-9, 1e6), usual);
    EXPECT_EQ(in_units(1e6, 1e-9), usual);
}

} // namespace graze::run_atlas_test
