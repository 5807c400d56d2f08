// Runs of kind atlas: their keys, their samples, and what is stored of them. What explores from there has its own
// tests.

#include "graze/base/input_errors.hpp"
#include "graze/results/stored_run.hpp"
#include "graze/study/further_runs.hpp"
#include "graze/study/stored_study.hpp"
#include "study/run_record.hpp"
#include "study/study_fixture.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>

#include <string>
#include <vector>

namespace graze::atlas_run_test {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using testing::message_of;

const std::string head = "name = \"s\"\nmodel = \"impact-oscillator\"\n";
const std::string box = "vary = { omega = [2.7, 2.75, 2.8, 2.85], e = [0.7, 0.8] }\ncycles = 60\n";
const std::string limits = R"(contacts = 3
multiple = 2
branches = 20
curves = 0
starts = { x = [-1, 0], v = [-2, 2], theta = [0, 3] }
draws = 5
seed = 7
minutes = 1.5
)";

std::string atlas_with(const std::string& lines) {
    return head + "[runs.map]\nkind = \"atlas\"\n" + lines;
}

StudyRun atlas_of(const std::string& lines) {
    return parse_study(atlas_with(lines), "s.toml").runs.at(0);
}

/// "line: problem; remedy" of each mistake.
std::vector<std::string> mistakes_in(const std::string& text) {
    std::vector<std::string> found;
    const auto add = [&](const InputError& error) {
        found.push_back(fmt::format("{}: {}; {}", error.place().line, error.problem(), error.remedy()));
    };
    try {
        parse_study(text, "s.toml");
    } catch (const InputErrors& errors) {
        for (const InputError& error : errors.all())
            add(error);
    } catch (const InputError& error) {
        add(error);
    }
    return found;
}

AtlasLimits all_limits() {
    AtlasLimits all;
    all.contacts = 3;
    all.multiple = 2;
    all.branches = 20;
    all.curves = 0;
    all.starts = {{"x", -1, 0}, {"v", -2, 2}, {"theta", 0, 3}};
    all.draws = 5;
    all.seed = 7;
    all.minutes = 1.5;
    return all;
}

TEST(AtlasRun, HasTheKeysOfASweepAndLimitsOfItsOwn) {
    const StudyRun plain = atlas_of(box), limited = atlas_of(box + limits);
    EXPECT_TRUE(plain.motion().atlas == AtlasLimits());
    EXPECT_EQ(plain.motion().direction, SweepDirection::both);
    EXPECT_EQ(plain.motion().attractor.cycles, 60U);
    EXPECT_EQ(points_of(plain), 16U);
    EXPECT_TRUE(limited.motion().atlas == all_limits());
    // They are not those of random points.
    EXPECT_EQ(limited.motion().draws, 0U);
    EXPECT_EQ(points_of(limited), 16U);
    EXPECT_EQ(atlas_of(box + "direction = \"down\"\n").motion().direction, SweepDirection::down);
}

TEST(AtlasRun, RefusesWhatIsNoBox) {
    const auto refused = [](const std::string& vary) { return mistakes_in(atlas_with("vary = " + vary)); };
    EXPECT_THAT(refused("{ omega = [2, 3], e = [0.7, 0.8], zeta = [0, 0.1] }"),
                ElementsAre("5: an atlas is of one or two parameters, and runs.map.vary varies 3; give the others "
                            "values: set = { PARAMETER = VALUE }"));
    EXPECT_THAT(refused("{ omega = [2, 3], x = [0, 0.1] }"),
                ElementsAre("5: runs.map.vary.x is a state, and an atlas is of parameters; give a range of initial "
                            "states: starts = { x = [LEAST, GREATEST] }"));
    EXPECT_THAT(refused("{ omega = { random = [2, 3] } }"),
                ElementsAre(HasSubstr("5: runs.map.vary.omega is random, and an atlas goes through values in their "
                                      "order; write { from = A, to = B, points = N }")));
    EXPECT_THAT(refused("{ omega = 2 }"), ElementsAre(HasSubstr("5: runs.map.vary.omega has one value")));
    EXPECT_THAT(mistakes_in(atlas_with("")), ElementsAre(HasSubstr("3: runs.map sweeps nothing")));
}

TEST(AtlasRun, RefusesLimitsOutOfRangeOrWithoutEffect) {
    EXPECT_THAT(mistakes_in(atlas_with(box + "contacts = 1001\nmultiple = 0\nbranches = 0\ncurves = 10001\n"
                                             "draws = -1\nminutes = 0\nstarts = { y = [0, 1], x = [1, 0] }\n")),
                ElementsAre(HasSubstr("7: runs.map.contacts is 1001"), HasSubstr("8: runs.map.multiple is 0"),
                            HasSubstr("9: runs.map.branches is 0"), HasSubstr("10: runs.map.curves is 10001"),
                            HasSubstr("11: runs.map.draws is -1"), HasSubstr("12: runs.map.minutes is 0, not positive"),
                            HasSubstr("13: the model has no state 'y'"),
                            HasSubstr("13: runs.map.starts.x goes from 1 to 0; give the smaller number first")));
    EXPECT_THAT(mistakes_in(atlas_with("vary = { omega = [2, 3] }\ncurves = 3\n")),
                ElementsAre("6: `curves` has no effect here: curves lie in a plane of two parameters; leave it out, "
                            "or vary a second parameter"));
    EXPECT_THAT(mistakes_in(atlas_with(box + "draws = 0\nseed = 2\nstarts = { x = [0, 1] }\n")),
                ElementsAre(HasSubstr("8: `seed` has no effect here: nothing is drawn at random"),
                            HasSubstr("9: `starts` has no effect here: nothing is drawn at random")));
    EXPECT_THAT(mistakes_in(atlas_with(box + "starts = {}\n")), ElementsAre(HasSubstr("7: runs.map.starts names no")));
    EXPECT_THAT(mistakes_in(head + "[runs.a]\nkind = \"sweep\"\nvary = { omega = [2, 3] }\nmultiple = 2\n"),
                ElementsAre(HasSubstr("6: runs of kind \"sweep\" have no `multiple`; leave it out; it belongs to "
                                      "\"atlas\"")));
}

TEST(AtlasRun, LimitsDoNotEnterTheFingerprint) {
    const StudyRun plain = atlas_of(box), limited = atlas_of(box + limits);
    EXPECT_EQ(run_fingerprint(limited, ""), run_fingerprint(plain, ""));
    EXPECT_EQ(record_of(limited, "", 16).fingerprint, run_fingerprint(plain, ""));
    EXPECT_NE(run_fingerprint(atlas_of(box + "keep = 50\n"), ""), run_fingerprint(plain, ""));
    EXPECT_NE(settings_of(limited), settings_of(plain));
}

TEST(AtlasRun, ItsStoredSettingsAreThoseThatAStudyCanHave) {
    const RunRecord good = record_of(atlas_of(box + limits), "", 16);
    EXPECT_TRUE(stored_run(good).motion().atlas == all_limits());
    const auto changed = [&](const std::string& from, const std::string& to) {
        RunRecord record = good;
        const std::size_t at = record.settings.find(from);
        EXPECT_NE(at, std::string::npos) << from;
        record.settings.replace(at, from.size(), to);
        return message_of([&] { stored_run(record); });
    };
    EXPECT_THAT(changed("\"name\":\"e\"", "\"name\":\"x\""), HasSubstr("'vary' is not one or two parameters"));
    EXPECT_THAT(changed("\"set\":", "\"draws\":3,\"seed\":1,\"set\":"), HasSubstr("'vary' is not one or two"));
    EXPECT_THAT(changed("\"state\":\"x\"", "\"state\":\"y\""), HasSubstr("'starts' is not ranges of states"));
    EXPECT_THAT(changed("\"low\":-1", "\"low\":1"), HasSubstr("'starts' is not ranges of states"));
    EXPECT_THAT(changed("\"low\":-1", "\"low\":\"-inf\""), HasSubstr("'starts' is not ranges of states"));
    EXPECT_THAT(changed("\"multiple\":2", "\"multiple\":0"), HasSubstr("'multiple' is not in the range"));
}

TEST(AtlasRun, NamesThatBeginWithItsOwnBelongToTheRunsThatItAdds) {
    const auto with_run = [](const std::string& name) {
        return atlas_with(box) + "[runs.\"" + name + "\"]\nkind = \"simulate\"\nperiods = 3\n";
    };
    EXPECT_THAT(mistakes_in(with_run("map.branch1")),
                ElementsAre("7: run 'map.branch1' has a name of those that the atlas 'map' adds, which begin with "
                            "'map.'; choose another name"));
    EXPECT_THAT(mistakes_in(with_run("Map.b.c")), ElementsAre(HasSubstr("choose another name"))); // as in SQL
    EXPECT_THAT(mistakes_in(with_run("mapper")), ElementsAre());
    EXPECT_THAT(mistakes_in(with_run("my.map.b1")), ElementsAre());
    EXPECT_THAT(mistakes_in(head + "[runs.\"map.b1\"]\nkind = \"simulate\"\nperiods = 3\n"), ElementsAre());
}

class AtlasResults : public testing::StudyFixture {
protected:
    /// All that is known of the points and samples of a run, but for its name.
    std::string points_of_run(const std::string& name) const {
        const ResultFile file(path_, ResultFile::Access::read);
        std::string all;
        for (const char* table : {"points", "samples"}) {
            auto rows = file.query(fmt::format("SELECT * FROM \"{}_{}\"", table, name));
            while (rows.next())
                for (std::size_t c = 0; c < rows.columns(); ++c)
                    all +=
                        rows.is_text(c) || rows.is_null(c) ? rows.text(c) + '|' : fmt::format("{:a}|", rows.number(c));
        }
        return all;
    }
    std::size_t computed(const std::string& text) const {
        const auto reports = run(text);
        testing::expect_complete(reports);
        std::size_t all = 0;
        for (const RunReport& report : reports)
            all += report.computed;
        return all;
    }
    Study stored() const { return stored_study(ResultFile(path_, ResultFile::Access::read)); }
};

TEST_F(AtlasResults, ItsPointsAreThoseOfASweep) {
    testing::expect_complete(
        run(atlas_with(box + limits) + "[runs.plain]\nkind = \"sweep\"\ndirection = \"both\"\n" + box));
    const std::string points = points_of_run("map");
    EXPECT_THAT(points, HasSubstr("periodic"));
    EXPECT_EQ(points, points_of_run("plain"));
}

TEST_F(AtlasResults, OtherLimitsAreStoredWithoutComputingAnythingAgain) {
    EXPECT_EQ(computed(atlas_with(box)), 16U);
    EXPECT_TRUE(stored().runs.at(0).motion().atlas == AtlasLimits());
    EXPECT_EQ(computed(atlas_with(box + limits)), 0U);
    EXPECT_TRUE(stored().runs.at(0).motion().atlas == all_limits());
    EXPECT_EQ(computed(atlas_with(box + "minutes = 3\n")), 0U);
    EXPECT_EQ(stored().runs.at(0).motion().atlas.minutes, 3);
    EXPECT_EQ(computed(atlas_with(box + "keep = 50\n")), 16U);
}

TEST_F(AtlasResults, TheStudyOfAFileHasRunsWithReservedNamesAndTakesMore) {
    testing::expect_complete(run(atlas_with("set = { e = 0.8 }\nvary = { omega = [2.7, 2.75] }\ncycles = 60\n")));
    ResultFile file(path_, ResultFile::Access::write);
    const std::string b1 = "name = \"more\"\nmodel = \"impact-oscillator\"\n[runs.\"map.b1\"]\nkind = \"simulate\"\n"
                           "periods = 3\nstart = { run = \"map\", at = { omega = 2.75 }, direction = \"up\" }\n";
    const std::string b2 = "name = \"more\"\nmodel = \"impact-oscillator\"\n[runs.\"map.b2\"]\nkind = \"simulate\"\n"
                           "periods = 3\nstart = { run = \"map.b1\" }\n";
    const Study first = parse_further_runs(b1, "more.toml", stored_study(file));
    const Study both = parse_further_runs(b2, "more.toml", first);
    testing::expect_complete(run_study(both, file, {}));
    const Study again = stored_study(file);
    ASSERT_NE(again.find_run("map.b2"), nullptr);
    EXPECT_EQ(again.find_run("map.b2")->start->run, "map.b1");
    EXPECT_EQ(again.find_run("map.b1")->start->run, "map");
    for (const RunReport& report : run_study(again, file, {}))
        EXPECT_EQ(report.computed, 0U) << report.name;
}

TEST_F(AtlasResults, AFileIsRefusedWhoseAtlasVariesNothing) {
    ResultFile file(path_, ResultFile::Access::write);
    RunRecord record = record_of(atlas_of(box), "", 16);
    record.coordinates.clear();
    EXPECT_THAT(message_of([&] { file.begin_run(record); }), HasSubstr("run 'map' varies nothing"));
}

} // namespace graze::atlas_run_test
