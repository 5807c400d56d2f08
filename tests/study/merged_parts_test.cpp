// However a study is divided, and whatever happens to the parts, the merged file is that of one process to the last
// bit.

#include "graze/study/merged_parts.hpp"

#include "graze/study/stored_study.hpp"
#include "graze/study/study_part.hpp"
#include "study_of_every_kind.hpp"

#include <fmt/ranges.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <random>

namespace graze::merged_parts_test {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

// Chains that carry states, random draws, motions from an orbit, a branch with a failing one after it, a run that is
// skipped, and a sweep that starts from the end of another one.
const char* const text = R"(
name = "s"
model = "impact-oscillator"
set = { sigma = 0.5, omega = 1.2, amplitude = 0.1 }
[runs.rest]
kind = "orbit"
[runs.branch]
kind = "continue"
direction = "up"
start = { run = "rest" }
along = { amplitude = [0.05, 0.6] }
steps = 30
[runs.one]
kind = "sweep"
vary = { amplitude = { from = 0.1, to = 0.3, points = 6 }, omega = [1.15, 1.2, 1.25] }
cycles = 20
[runs.two]
kind = "basin"
draws = 7
vary = { x = { random = [-1, 0] } }
cycles = 20
[runs.motions]
kind = "simulate"
vary = { v = { from = -2, to = 2, points = 5 } }
periods = 5
start = { run = "rest" }
[runs.after]
kind = "sweep"
start = { run = "one" }
vary = { amplitude = { from = 0.3, to = 0.4, points = 4 } }
cycles = 20
[runs.wrong]
kind = "sweep"
start = { run = "branch", point = "GR9" }
vary = { amplitude = { from = 0.3, to = 0.4, points = 4 } }
cycles = 20
[runs.lost]
kind = "simulate"
start = { run = "wrong" }
time = 1
)";

class MergedPartsTest : public testing::StudyOfEveryKind {
protected:
    ResultFile written(const std::string& name) const { return {folder_ / name, ResultFile::Access::write}; }
    std::string whole(const Study& study) const {
        ResultFile file = written("whole.sqlite");
        run_study(study, file, {});
        return testing::bits_of(file);
    }
    ResultFile part_file(const StudyPart& part) const {
        return written("part-" + std::to_string(part.number) + "-of-" + std::to_string(part.count));
    }
    /// Computes all parts, and merges them, until nothing is missing. @return how often
    std::size_t rounds(const Study& study, std::size_t count, ResultFile& results) const {
        for (std::size_t round = 1; round < 5; ++round) {
            std::vector<ResultFile> parts;
            for (std::size_t number = 1; number <= count; ++number) {
                ResultFile& file = parts.emplace_back(part_file({number, count}));
                run_part(study, {number, count}, &results, file, {.jobs = 2});
            }
            const MergedParts merged = merge_parts(asked_study(parts.back()), parts, results, {});
            if (merged.complete())
                return round;
        }
        return 0;
    }
};

TEST_F(MergedPartsTest, EqualWhatOneProcessComputes) {
    const Study study = parse_study(text, "s.toml");
    const std::string expected = whole(study);
    for (const std::size_t count : {1, 2, 3, 8, 50}) {
        ResultFile results = written("merged-" + std::to_string(count));
        EXPECT_EQ(rounds(study, count, results), 2U) << count; // `after` needs all of `one`
        EXPECT_EQ(testing::bits_of(results), expected) << count;
    }
}

TEST_F(MergedPartsTest, OfEveryKindOfRunEqualWhatOneProcessComputes) {
    run_and_forget();
    ResultFile one(path_, ResultFile::Access::read);
    const Study study = asked_study(one);
    ResultFile results = written("merged");
    EXPECT_EQ(rounds(study, 3, results), 1U);
    EXPECT_EQ(testing::bits_of(results), testing::bits_of(one));
}

TEST_F(MergedPartsTest, ReportFailuresAsOneProcessDoes) {
    const Study study = parse_study(text, "s.toml");
    ResultFile one = written("one");
    const std::vector<RunReport> expected = run_study(study, one, {});
    ResultFile results = written("merged");
    ASSERT_NE(rounds(study, 2, results), 0U);
    const MergedParts again = merge_parts(study, {}, results, {});
    ASSERT_EQ(again.reports.size(), expected.size());
    for (std::size_t r = 0; r < expected.size(); ++r) {
        EXPECT_EQ(again.reports[r].outcome, expected[r].outcome) << expected[r].name;
        EXPECT_EQ(again.reports[r].problem, expected[r].problem);
        EXPECT_EQ(again.reports[r].remedy, expected[r].remedy);
    }
}

TEST_F(MergedPartsTest, SayWhatIsMissing) {
    const Study study = parse_study(text, "s.toml");
    std::vector<ResultFile> parts;
    for (const std::size_t number : {1, 3, 4}) {
        ResultFile& file = parts.emplace_back(part_file({number, 4}));
        std::size_t done = 0;
        const bool stops = number == 3;
        run_part(study, {number, 4}, nullptr, file,
                 {.interrupted = [&] { return stops && done > 2; }, .progress = [&](const StudyProgress&) { ++done; }});
    }
    ResultFile results = written("merged");
    const MergedParts merged = merge_parts(study, parts, results, {});
    EXPECT_FALSE(merged.complete());
    const std::string all = fmt::format("{}", fmt::join(merged.missing, "\n"));
    EXPECT_THAT(all, HasSubstr("points are missing"));
    EXPECT_THAT(all, HasSubstr("run 'after' can begin when the runs that it needs are complete"));
    EXPECT_THAT(all, HasSubstr("not there: part 2 of 4"));
    EXPECT_THAT(all, HasSubstr("not ended: part 3 of 4"));
    // The rest by one process, from what was merged.
    run_study(study, results, {});
    EXPECT_EQ(testing::bits_of(results), whole(study));
}

TEST_F(MergedPartsTest, AreTheSameHoweverOftenPartsAreInterruptedRepeatedAndDividedAnew) {
    const Study study = parse_study(text, "s.toml");
    const std::string expected = whole(study);
    for (const unsigned seed : {1U, 2U, 3U}) {
        std::mt19937 random(seed);
        const std::string folder = "attempt-" + std::to_string(seed);
        std::filesystem::create_directory(path(folder));
        ResultFile results = written(folder + "/results");
        bool complete = false;
        for (std::size_t attempt = 0; attempt < 200 && !complete; ++attempt) {
            const std::size_t count = 1 + random() % 4;
            const StudyPart part{1 + random() % count, count};
            ResultFile file = written(folder + "/" + std::to_string(part.number) + "of" + std::to_string(count));
            // A branch begins again each time.
            const std::size_t stop_after = random() % 3 == 0 ? 1000 : random() % 20;
            std::size_t done = 0;
            const bool from_results = random() % 2 == 0;
            run_part(study, part, from_results ? &results : nullptr, file,
                     {.interrupted = [&] { return done > stop_after; },
                      .progress = [&](const StudyProgress&) { ++done; },
                      .orbit = [&](const std::string&, const OrbitRecord&) { ++done; }});
            if (random() % 3 != 0)
                continue;
            std::vector<ResultFile> parts;
            for (const auto& entry : std::filesystem::directory_iterator(path(folder)))
                if (const std::string name = entry.path().filename();
                    name != "results" && name.find_first_not_of("0123456789of") == name.npos)
                    parts.emplace_back(entry.path(), ResultFile::Access::read);
            complete = merge_parts(study, parts, results, {}).complete();
        }
        EXPECT_TRUE(complete) << seed;
        EXPECT_EQ(testing::bits_of(results), expected) << seed;
    }
}

TEST_F(MergedPartsTest, TakeNothingOfAnotherStudy) {
    std::string changed = text;
    changed.replace(changed.find("cycles = 20"), 11, "cycles = 21");
    ResultFile part = part_file({1, 1});
    run_part(parse_study(changed, "s.toml"), {1, 1}, nullptr, part, {});
    ResultFile results = written("merged");
    const Study study = parse_study(text, "s.toml");
    const MergedParts merged = merge_parts(study, {part}, results, {});
    EXPECT_EQ(results.point_count("one"), 0U);
    EXPECT_GT(results.point_count("two"), 0U);
    EXPECT_THAT(merged.missing, ::testing::Contains(HasSubstr("of another study, model or version of graze: one")));
    EXPECT_THAT(merged.missing, ::testing::Contains(HasSubstr("run 'one': 18 of 18 points are missing")));
}

TEST_F(MergedPartsTest, LeaveOutPointsWithoutThoseBeforeThem) {
    const Study study = parse_study(text, "s.toml");
    ResultFile part = part_file({1, 1});
    run_part(study, {1, 1}, nullptr, part, {.only = {"one"}});
    {
        testing::TemporaryFolder other;
        // As a file would be that has been damaged.
        ResultFile damaged(other / "damaged", ResultFile::Access::write);
        damaged.begin_run(*part.find_run("one"));
        part.each_point("one", [&](const PointRecord& point) {
            if (point.number != 8)
                damaged.add_point("one", point);
        });
        damaged.flush();
        ResultFile results = written("merged");
        merge_parts(study, {damaged}, results, {});
        EXPECT_THAT(testing::point_numbers_of(results, "one"),
                    ElementsAre(0, 1, 2, 3, 4, 5, 6, 7, 12, 13, 14, 15, 16, 17));
        run_study(study, results, {});
        EXPECT_EQ(testing::bits_of(results), whole(study));
    }
}

TEST_F(MergedPartsTest, OfNothingAreNothing) {
    const Study study = parse_study(text, "s.toml");
    ResultFile results = written("merged");
    const MergedParts merged = merge_parts(study, {}, results, {});
    EXPECT_FALSE(merged.complete());
    for (const RunReport& report : merged.reports)
        EXPECT_EQ(report.outcome, RunOutcome::partial) << report.name;
}

} // namespace graze::merged_parts_test
