#include "graze/study/further_runs.hpp"

#include "graze/study/stored_study.hpp"

#include "study_of_every_kind.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace graze::further_runs_test {

using testing::bits_of;
using ::testing::ElementsAre;
using testing::expect_complete;
using ::testing::HasSubstr;
using testing::message_of;
using ::testing::Pair;

class FurtherRuns : public testing::StudyOfEveryKind {
protected:
    FurtherRuns() { run_and_forget(); }

    const std::string original = path("results.sqlite");
};

TEST_F(FurtherRuns, CopiesOfAllRunsHaveTheSameBits) {
    const ResultFile file(original, ResultFile::Access::read);
    ResultFile copy(path("copy.sqlite"), ResultFile::Access::write);
    for (const auto& [name, there] : copy_runs(file, copy, {}))
        EXPECT_EQ(name, there);
    EXPECT_EQ(bits_of(copy), bits_of(file));
    // Nothing is copied twice.
    copy_runs(file, copy, {});
    EXPECT_EQ(bits_of(copy), bits_of(file));
    // And nothing is computed again.
    for (const RunReport& report : run_study(stored_study(file), copy, {}))
        EXPECT_EQ(report.computed, 0U) << report.name;
}

TEST_F(FurtherRuns, ACopyWhoseNameIsTakenIsNamedAnew) {
    const ResultFile file(original, ResultFile::Access::read);
    ResultFile other(path("other.sqlite"), ResultFile::Access::write);
    const Study taken = parse_study("name = \"t\"\nmodel = \"impact-oscillator\"\n[runs.orbit]\nkind = \"orbit\"\n"
                                    "set = { omega = 4 }\nfrom = { x = -0.06 }\n",
                                    "t.toml");
    expect_complete(run_study(taken, other, {}));
    const auto names = copy_runs(file, other, {"chain"});
    EXPECT_THAT(names, ElementsAre(Pair("chain", "chain"), Pair("orbit", "orbit_2")));
    // The copy starts from the renamed orbit, and both are complete as they are.
    const Study study = stored_study(other);
    EXPECT_EQ(study.find_run("chain")->start->run, "orbit_2");
    for (const RunReport& report : run_study(study, other, {}))
        EXPECT_EQ(report.computed, 0U) << report.name;
    EXPECT_EQ(other.point_count("chain"), file.point_count("chain"));
}

TEST_F(FurtherRuns, ACopyWhoseNameIsTakenButForItsCaseIsNamedAnew) {
    const ResultFile file(original, ResultFile::Access::read);
    ResultFile other(path("other.sqlite"), ResultFile::Access::write);
    const Study taken = parse_study("name = \"t\"\nmodel = \"impact-oscillator\"\n[runs.Orbit]\nkind = \"orbit\"\n"
                                    "set = { omega = 4 }\nfrom = { x = -0.06 }\n",
                                    "t.toml");
    expect_complete(run_study(taken, other, {}));
    EXPECT_THAT(copy_runs(file, other, {"chain"}), ElementsAre(Pair("chain", "chain"), Pair("orbit", "orbit_2")));
    EXPECT_EQ(stored_study(other).find_run("chain")->start->run, "orbit_2");
    for (const RunReport& report : run_study(stored_study(other), other, {}))
        EXPECT_EQ(report.computed, 0U) << report.name;
}

TEST_F(FurtherRuns, GoOnFromRunsOfAFile) {
    ResultFile file(original, ResultFile::Access::write);
    const Study earlier = stored_study(file);
    const Study study = parse_further_runs("name = \"more\"\n[runs.more]\nkind = \"continue\"\n"
                                           "model = \"known\"\nstart = { run = \"orbit\" }\n"
                                           "along = { omega = [2.75, 2.85] }\n",
                                           "more.toml", earlier, {{"known", earlier.find_run("orbit")->model}});
    EXPECT_EQ(study.name, "more");
    EXPECT_EQ(study.runs.size(), earlier.runs.size() + 1);
    const auto reports = run_study(study, file, {.only = {"more"}});
    expect_complete(reports);
    EXPECT_GT(file.point_count("more"), 2U);
    EXPECT_TRUE(file.find_run("chain"));
}

TEST_F(FurtherRuns, TellMistakes) {
    const ResultFile file(original, ResultFile::Access::read);
    const Study earlier = stored_study(file);
    const auto told = [&](const std::string& text) {
        return message_of([&] { parse_further_runs("name = \"m\"\n" + text, "m.toml", earlier); });
    };
    EXPECT_THAT(told("[runs.orbit]\nkind = \"orbit\"\nmodel = \"impact-oscillator\"\n"),
                HasSubstr("there is a run 'orbit' already"));
    EXPECT_THAT(told("[runs.a]\nkind = \"continue\"\nmodel = \"impact-oscillator\"\nstart = { run = \"orbitt\" }\n"
                     "along = { omega = [3.9, 4.1] }\n"),
                HasSubstr("'orbitt'"));
    ResultFile copy(path("copy.sqlite"), ResultFile::Access::write);
    EXPECT_THAT(message_of([&] { copy_runs(file, copy, {"nowhere"}); }), HasSubstr("no run 'nowhere'"));
}

} // namespace graze::further_runs_test
