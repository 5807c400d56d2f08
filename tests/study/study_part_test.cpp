#include "graze/study/study_part.hpp"

#include "study_fixture.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <map>
#include <set>

namespace graze::study_part_test {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

const char* const text = R"(
name = "s"
model = "impact-oscillator"
set = { sigma = 0.5, omega = 1.2, amplitude = 0.1 }
[runs.sweep]
kind = "sweep"
vary = { amplitude = { from = 0.1, to = 0.3, points = 3 }, omega = { from = 1.1, to = 1.3, points = 11 } }
cycles = 10
[runs.orbit]
kind = "orbit"
[runs.motions]
kind = "simulate"
vary = { v = { from = -1, to = 1, points = 5 } }
periods = 3
start = { run = "orbit" }
[runs.motion]
kind = "simulate"
time = 1
[runs.after]
kind = "sweep"
start = { run = "sweep" }
vary = { amplitude = { from = 0.3, to = 0.4, points = 4 } }
cycles = 10
[runs.follows]
kind = "simulate"
start = { run = "after" }
time = 1
)";

class StudyParts : public testing::StudyFixture {
protected:
    std::map<std::string, RunReport> reports_of(const StudyPart& part, ResultFile& file,
                                                const RunnerOptions& options = {}) const {
        std::map<std::string, RunReport> reports;
        for (RunReport& report : run_part(study_, part, nullptr, file, options).runs)
            reports.emplace(report.name, report);
        return reports;
    }
    std::string part_path(const StudyPart& part) const {
        return folder_ / (std::to_string(part.number) + "-" + std::to_string(part.count));
    }

    const Study study_ = parse_study(text, "s.toml");
};

TEST_F(StudyParts, AreWrittenAsTheyAreRead) {
    EXPECT_EQ(text_of(study_part("3/64")), "3/64");
    EXPECT_EQ(study_part("64/64"), (StudyPart{64, 64}));
    for (const char* const wrong : {"", "3", "/", "3/", "/3", "0/3", "4/3", "-1/3", "1/3x", "1 /3", "a/b", "1/0",
                                    "99999999999999999999/99999999999999999999"})
        EXPECT_THAT(testing::message_of([&] { study_part(wrong); }), HasSubstr("no part of a study")) << wrong;
}

TEST_F(StudyParts, HaveEachTaskOnce) {
    for (const std::size_t count : {1, 2, 3, 7, 40}) {
        std::map<std::string, std::multiset<std::size_t>> points;
        std::map<std::string, std::size_t> whole;
        for (std::size_t number = 1; number <= count; ++number) {
            const StudyPart part{number, count};
            ResultFile file(part_path(part), ResultFile::Access::write);
            const auto reports = reports_of(part, file);
            EXPECT_EQ(part_in(file), part);
            EXPECT_TRUE(has_ended(file));
            for (const auto& [name, report] : reports)
                if (name == "sweep" || name == "motions") {
                    EXPECT_EQ(report.outcome, count == 1 ? RunOutcome::complete : RunOutcome::partial) << name;
                    for (const std::size_t point : testing::point_numbers_of(file, name))
                        points[name].insert(point);
                } else {
                    EXPECT_EQ(report.outcome, RunOutcome::complete) << name;
                    ++whole[name];
                }
            // What a task needs is computed with it.
            EXPECT_EQ(file.point_count("motions") == 0 || file.point_count("orbit") == 1, true);
            EXPECT_FALSE(file.find_run("after"));
        }
        for (const char* const name : {"sweep", "motions"}) {
            const std::size_t all = points_of(*study_.find_run(name));
            EXPECT_EQ(points[name].size(), all) << name << count;
            EXPECT_EQ(std::set(points[name].begin(), points[name].end()).size(), all) << name << count;
        }
        EXPECT_EQ(whole["motion"], 1U);
        EXPECT_GE(whole["orbit"], 1U);
    }
}

TEST_F(StudyParts, DealOutNeighboursInTurn) {
    ResultFile file(path_, ResultFile::Access::write);
    const PartReports reports = run_part(study_, {2, 3}, nullptr, file, {.only = {"sweep"}});
    EXPECT_THAT(reports.waiting, ElementsAre("after", "follows"));
    auto chains = file.query("SELECT DISTINCT chain FROM points_sweep ORDER BY chain");
    for (const std::int64_t chain : {1, 4, 7, 10}) {
        ASSERT_TRUE(chains.next());
        EXPECT_EQ(chains.integer(0), chain);
    }
    EXPECT_FALSE(chains.next());
}

TEST_F(StudyParts, LeaveWhatNeedsTheRunsOfSeveralPartsUntilTheseAreThere) {
    EXPECT_THAT(waiting_runs(study_, nullptr), ElementsAre("after", "follows"));
    ResultFile results(folder_ / "results", ResultFile::Access::write);
    run_study(study_, results, {.only = {"sweep", "orbit"}});
    EXPECT_THAT(waiting_runs(study_, &results), IsEmpty());
    ResultFile file(path_, ResultFile::Access::write);
    std::vector<std::string> names;
    const PartReports reports = run_part(study_, {1, 1}, &results, file, {});
    EXPECT_THAT(reports.waiting, IsEmpty());
    for (const RunReport& report : reports.runs) {
        names.push_back(report.name);
        EXPECT_TRUE(report.complete()) << report.name;
    }
    // Those that are there are taken where they are needed, and nothing of them is computed.
    EXPECT_THAT(names, ElementsAre("sweep", "orbit", "motions", "motion", "after", "follows"));
    ResultFile whole(folder_ / "whole", ResultFile::Access::write);
    run_study(study_, whole, {});
    EXPECT_EQ(testing::bits_of(file), testing::bits_of(whole));
    // A run that is out of date counts as not there.
    std::string changed = text;
    changed.replace(changed.find("cycles = 10"), 11, "cycles = 12");
    EXPECT_THAT(waiting_runs(parse_study(changed, "s.toml"), &results), ElementsAre("after", "follows"));
}

TEST_F(StudyParts, GoOnWhereTheyWereInterrupted) {
    const StudyPart part{1, 2};
    ResultFile whole(folder_ / "whole", ResultFile::Access::write);
    reports_of(part, whole);
    ResultFile file(path_, ResultFile::Access::write);
    std::size_t interruptions = 0;
    for (bool interrupted = true; interrupted;) {
        ASSERT_LT(++interruptions, 40U);
        std::atomic<std::size_t> done{0};
        interrupted = false;
        for (const auto& [name, report] : reports_of(part, file,
                                                     {.jobs = 2,
                                                     .interrupted = [&] { return done >= 3; },
                                                     .progress = [&](const StudyProgress&) { ++done; }}))
            interrupted = interrupted || report.outcome == RunOutcome::interrupted;
        EXPECT_EQ(has_ended(file), !interrupted);
    }
    EXPECT_GT(interruptions, 3U);
    EXPECT_EQ(testing::bits_of(file), testing::bits_of(whole));
}

TEST_F(StudyParts, TellHowMuchTheyHaveToDo) {
    ResultFile file(path_, ResultFile::Access::write);
    StudyProgress last;
    reports_of({1, 3}, file, {.only = {"sweep"}, .progress = [&](const StudyProgress& made) { last = made; }});
    EXPECT_EQ(last.study_points, file.point_count("sweep"));
    EXPECT_EQ(last.study_done, last.study_points);
}

TEST_F(StudyParts, MayHaveNothingToDo) {
    ResultFile file(path_, ResultFile::Access::write);
    EXPECT_THAT(reports_of({100, 1000}, file), IsEmpty());
    EXPECT_TRUE(has_ended(file));
    EXPECT_FALSE(part_in(ResultFile(folder_ / "other", ResultFile::Access::write)));
}

} // namespace graze::study_part_test
