#include "graze/study/stored_study.hpp"

#include "graze/study/study_catalogue.hpp"

#include "study_of_every_kind.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>

namespace graze::stored_study_test {

using ::testing::HasSubstr;

using StoredStudyTest = testing::StudyOfEveryKind;

using testing::bits_of;
using testing::expect_complete;

TEST_F(StoredStudyTest, EveryRunIsReadFromTheFileAlone) {
    run_and_forget();
    const ResultFile file(path("results.sqlite"), ResultFile::Access::read);
    const Study study = stored_study(file);
    EXPECT_EQ(study.name, "all");
    EXPECT_EQ(study.text, "one of each kind");
    ASSERT_EQ(study.runs.size(), 6u);
    ASSERT_EQ(study.pictures.size(), 3u);
    EXPECT_EQ(study.pictures[0].x_range, std::pair(2.7, 2.8));
    EXPECT_TRUE(study.pictures[1].logarithmic_x);
    EXPECT_EQ(study.pictures[2].at.front().first, "omega");
    EXPECT_EQ(study.runs[0].value_units, (std::vector<std::string>{"", ""}));
}

TEST_F(StoredStudyTest, CompleteRunsAreNotRepeated) {
    run_and_forget();
    ResultFile file(path("results.sqlite"), ResultFile::Access::write);
    for (const RunReport& report : run_study(stored_study(file), file, {})) {
        EXPECT_TRUE(report.complete()) << report.name << ": " << report.problem;
        EXPECT_EQ(report.computed, 0u) << report.name;
    }
}

TEST_F(StoredStudyTest, EveryRunIsRepeatedBitForBitInAnotherFile) {
    run_and_forget();
    const ResultFile file(path("results.sqlite"), ResultFile::Access::read);
    ResultFile again(path("again.sqlite"), ResultFile::Access::write);
    expect_complete(run_study(stored_study(file), again, {}));
    EXPECT_EQ(bits_of(again), bits_of(file));
    // Runs are kept as they were asked for; the rest is the same.
    const auto words_and_pictures = [](const ResultFile& one) {
        const std::string note = one.note("study").value();
        return note.substr(0, note.find("\"runs\":[{"));
    };
    EXPECT_EQ(words_and_pictures(again), words_and_pictures(file));
}

TEST_F(StoredStudyTest, HasRunsThatWereNeverBegun) {
    run_and_forget();
    const ResultFile whole(path("results.sqlite"), ResultFile::Access::read);
    const Study study = stored_study(whole);
    {
        ResultFile file(path("part.sqlite"), ResultFile::Access::write);
        run_study(study, file, {.only = {"orbit"}});
        ASSERT_EQ(file.runs().size(), 1U);
    }
    const Study again = stored_study(ResultFile(path("part.sqlite"), ResultFile::Access::read));
    ASSERT_EQ(again.runs.size(), study.runs.size());
    EXPECT_EQ(again.pictures.size(), study.pictures.size());
    for (const StudyRun& run : study.runs) {
        const auto found = std::find_if(again.runs.begin(), again.runs.end(),
                                        [&](const StudyRun& one) { return one.name == run.name; });
        ASSERT_NE(found, again.runs.end()) << run.name;
        EXPECT_EQ(settings_of(*found), settings_of(run)) << run.name;
    }
    ResultFile file(path("part.sqlite"), ResultFile::Access::write);
    expect_complete(run_study(again, file, {}));
    for (const RunRecord& record : whole.runs()) {
        const auto repeated = file.find_run(record.name);
        ASSERT_TRUE(repeated) << record.name;
        EXPECT_EQ(repeated->fingerprint, record.fingerprint) << record.name;
        EXPECT_EQ(repeated->values.size(), record.values.size());
        for (std::size_t v = 0; v < record.values.size(); ++v)
            EXPECT_EQ(repeated->values[v].unit, record.values[v].unit);
        EXPECT_EQ(file.point_count(record.name), whole.point_count(record.name)) << record.name;
    }
}

TEST_F(StoredStudyTest, AnInterruptedSweepContinues) {
    run_and_forget();
    std::string whole;
    {
        const ResultFile file(path("results.sqlite"), ResultFile::Access::read);
        whole = bits_of(file);
        ResultFile half(path("half.sqlite"), ResultFile::Access::write);
        std::size_t done = 0;
        const auto reports =
            run_study(stored_study(file), half,
                      {.interrupted = [&] { return done > 6; }, .progress = [&](const StudyProgress&) { ++done; }});
        EXPECT_EQ(reports.back().outcome, RunOutcome::interrupted);
    }
    std::filesystem::remove(path("results.sqlite"));
    ResultFile half(path("half.sqlite"), ResultFile::Access::write);
    Study study = stored_study(half);
    ASSERT_EQ(study.runs.size(), 6U);
    ASSERT_EQ(half.runs().size(), 1U);
    const auto reports = run_study(study, half, {});
    EXPECT_TRUE(reports.front().complete());
    EXPECT_LT(reports.front().computed, reports.front().points);
    EXPECT_EQ(bits_of(half), whole);
}

TEST_F(StoredStudyTest, ABranchIsContinuedFromItsLastPoint) {
    run_and_forget();
    ResultFile file(path("results.sqlite"), ResultFile::Access::write);
    Study study = stored_study(file);
    StudyRun longer =
        *std::find_if(study.runs.begin(), study.runs.end(), [](const StudyRun& run) { return run.name == "chain"; });
    const auto before = file.orbits("chain", false);
    longer.name = "longer";
    longer.start->run = "chain";
    longer.start->point = std::to_string(before.back().number);
    longer.branch().settings.greatest = 3.0;
    longer.branch().settings.least = 2.6;
    study.runs.push_back(longer);
    const auto reports = run_study(study, file, {});
    EXPECT_TRUE(reports.back().complete()) << reports.back().problem;
    const auto after = file.orbits("longer", false);
    ASSERT_GT(after.size(), 2u);
    EXPECT_EQ(after.front().point.solution.orbit.signature, before.back().point.solution.orbit.signature);
    EXPECT_NEAR(after.front().point.parameter, before.back().point.parameter, 1e-9);
}

TEST_F(StoredStudyTest, ShippedStudiesAreStoredWhole) {
    for (const std::string& name : shipped_studies()) {
        const Study study = load_study(name);
        ResultFile file(path(name), ResultFile::Access::write);
        run_study(study, file, {.interrupted = [] { return true; }});
        const Study stored = stored_study(file);
        ASSERT_FALSE(stored.runs.empty());
        for (const StudyRun& run : stored.runs)
            for (const StudyRun& given : study.runs)
                if (given.name == run.name && !run.start) {
                    EXPECT_EQ(settings_of(run), settings_of(given)) << name << ' ' << run.name;
                }
    }
}

std::string refusal_of_stored(const RunRecord& record) {
    return testing::message_of([&] { stored_run(record); });
}

TEST_F(StoredStudyTest, TellsWhatIsWrongWithSettings) {
    run_and_forget();
    const ResultFile file(path("results.sqlite"), ResultFile::Access::read);
    const RunRecord good = *file.find_run("sweep");
    EXPECT_EQ(refusal_of_stored(good), "");
    const auto changed = [&](const std::string& from, const std::string& to) {
        RunRecord record = good;
        const std::size_t at = record.settings.find(from);
        EXPECT_NE(at, std::string::npos) << from;
        record.settings.replace(at, from.size(), to);
        return refusal_of_stored(record);
    };
    EXPECT_THAT(changed("{", ""), HasSubstr("no JSON"));
    EXPECT_THAT(changed("\"cycles\":60", "\"cycles\":\"many\""), HasSubstr("'cycles' is not a whole number"));
    EXPECT_THAT(changed("\"cycles\":60", "\"cycles\":-1"), HasSubstr("'cycles' is not a whole number"));
    EXPECT_THAT(changed("\"omega\"", "\"omicron\""), HasSubstr("'omicron'"));
    EXPECT_THAT(changed("\"kind\":\"sweep\"", "\"kind\":\"basin\""), HasSubstr("settings"));
    EXPECT_THAT(changed("\"cycles\":60", "\"cycles\":60,\"new\":1"), HasSubstr("changed afterwards"));
    EXPECT_THAT(changed("\"recurrence\":0.001", "\"recurrence\":1e-3"), HasSubstr("change the study file instead"));
    RunRecord later = good;
    later.version = "99.1.0";
    later.settings.insert(1, "\"new\":1,");
    EXPECT_THAT(refusal_of_stored(later), HasSubstr("more than this version of graze knows; use graze 99.1.0"));
    RunRecord many = *file.find_run("basin");
    many.settings.replace(many.settings.find("\"draws\":9"), 9, "\"draws\":999999999");
    EXPECT_THAT(refusal_of_stored(many), HasSubstr("twenty million"));
    RunRecord deep = good;
    deep.settings = std::string(100'000, '[');
    EXPECT_THAT(refusal_of_stored(deep), HasSubstr("nested"));
}

} // namespace graze::stored_study_test
