#include "graze/study/run_part.hpp"

#include "graze/study/elsewhere.hpp"
#include "study_fixture.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <chrono>

namespace graze::run_part_test {

using ::testing::HasSubstr;

// All three kinds, with states that are carried along, random draws, a start from another run and from a branch,
// samples, motions that escape, and a point that fails.
const char* const text = R"(
name = "s"
model = "impact-oscillator"
values = ["v", "x + 0.1*v"]
[runs.sweep]
kind = "sweep"
vary = { omega = { from = 2.7, to = 2.9, points = 6 }, sigma = [1.2, 1.25, 1.3] }
direction = "both"
cycles = 60
[runs.basin]
kind = "basin"
draws = 5
vary = { x = { random = [-1, 0] }, omega = [2.7, 2.8] }
cycles = 60
start = { run = "sweep", at = { omega = 2.8 }, direction = "up" }
[runs.alone]
kind = "sweep"
carry = false
vary = { omega = { from = 2.7, to = 2.9, points = 6 }, sigma = [1.2, 1.25] }
direction = "both"
cycles = 60
[runs.orbit]
kind = "orbit"
set = { omega = 4 }
from = { x = -0.07 }
[runs.motions]
kind = "simulate"
vary = { v = { from = -2, to = 2, points = 9 } }
periods = 12
bounds = { x = [-1, 2] }
start = { run = "orbit" }
)";

/// Computes runs in parts of some chains each, the last part first, from texts and bytes alone as another process does.
struct Parts {
    std::size_t size = 1;
    std::size_t stop_after = 1'000'000; ///< parts, of all runs together
    std::size_t done = 0;
    std::vector<std::string> texts{}, bytes{};

    bool operator()(const PartedRun& run, const KnownChains& known, const PointSink& sink) {
        const PartedRun other(texts.emplace_back(run.text()));
        for (std::size_t last = run.chains(); last > 0;) {
            if (done++ >= stop_after)
                return false;
            const std::size_t first = last - std::min(size, last);
            const RunPart part{{first, last}, known.of({first, last})};
            const std::string asked = bytes_of(part);
            bytes.push_back(computed_points(other, part_of(asked), {}));
            read_points(run, part, bytes.back(), sink);
            last = first;
        }
        return true;
    }
    Elsewhere elsewhere() {
        return {.points = [this](const AskedPoints& asked, const PointSink& sink) {
            return (*this)(asked.run, asked.known, sink);
        }};
    }
};

class RunPartTest : public testing::StudyFixture {
protected:
    std::string bits_of_whole() const {
        ResultFile file(folder_ / "whole.sqlite", ResultFile::Access::write);
        testing::expect_complete(run_study(study_, file, {}));
        return testing::bits_of(file);
    }
    const Study study_ = parse_study(text, "s.toml");
};

TEST_F(RunPartTest, AnyDivisionGivesTheSameFile) {
    const std::string whole = bits_of_whole();
    for (const std::size_t size : {1, 2, 7, 1000}) {
        ResultFile file(folder_ / std::to_string(size), ResultFile::Access::write);
        Parts parts{size};
        const auto reports = run_study(study_, file, {.jobs = 2}, parts.elsewhere());
        testing::expect_complete(reports);
        EXPECT_EQ(reports[0].computed, 36u);
        EXPECT_EQ(parts.texts.size(), 4u);
        EXPECT_EQ(testing::bits_of(file), whole) << size;
    }
}

TEST_F(RunPartTest, PointsThatCarryNoStateAreChainsOfTheirOwn) {
    const StudyRun& carried = study_.runs[0];
    const StudyRun& alone = study_.runs[2];
    EXPECT_EQ(chains_of(carried), 3u);
    EXPECT_EQ(points_of(carried), 36u);
    EXPECT_EQ(chains_of(alone), 24u);
    EXPECT_EQ(points_of(alone), 24u);
    EXPECT_EQ(alone.motion().rows(alone.kind), 2);
    ResultFile file(path_, ResultFile::Access::write);
    run_study(study_, file, {.only = {"alone"}});
    // They are numbered as if states were carried along.
    auto rows = file.query("SELECT chain, direction, sigma, count(*), min(omega), max(omega) FROM points_alone "
                           "GROUP BY chain, direction, sigma ORDER BY min(number)");
    for (const std::size_t row : {0, 1})
        for (const char* const direction : {"up", "down"}) {
            ASSERT_TRUE(rows.next());
            EXPECT_EQ(rows.integer(0), static_cast<std::int64_t>(row));
            EXPECT_EQ(rows.text(1), direction);
            EXPECT_EQ(rows.number(2), row == 0 ? 1.2 : 1.25);
            EXPECT_EQ(rows.integer(3), 6);
            EXPECT_EQ(rows.number(4), 2.7);
            EXPECT_EQ(rows.number(5), 2.9);
        }
    EXPECT_FALSE(rows.next());
}

TEST_F(RunPartTest, GoesOnWhereItWasInterrupted) {
    const std::string whole = bits_of_whole();
    ResultFile file(path_, ResultFile::Access::write);
    // Within chains by threads, between chains by parts.
    for (std::size_t attempt = 1;; ++attempt) {
        ASSERT_LT(attempt, 40u);
        Parts parts{3, 1};
        std::atomic<std::size_t> done{0};
        const auto reports = attempt % 2 == 0 ? run_study(study_, file, {}, parts.elsewhere())
                                              : run_study(study_, file,
                                                          {.interrupted = [&] { return done >= 5; },
                                                           .progress = [&](const StudyProgress&) { ++done; }});
        if (reports.size() == study_.runs.size() && reports.back().complete())
            break;
        EXPECT_EQ(reports.back().outcome, RunOutcome::interrupted);
    }
    EXPECT_EQ(testing::bits_of(file), whole);
}

TEST_F(RunPartTest, ATextIsThatOfTheRunItMakes) {
    ResultFile file(path_, ResultFile::Access::write);
    Parts parts{1000};
    run_study(study_, file, {}, parts.elsewhere());
    for (const std::string& one : parts.texts)
        EXPECT_EQ(PartedRun(one).text(), one);
}

TEST_F(RunPartTest, RefusesWhatIsNoPart) {
    ResultFile file(path_, ResultFile::Access::write);
    Parts parts{1000};
    run_study(study_, file, {}, parts.elsewhere());
    const PartedRun run(parts.texts.front());
    const RunPart whole{{0, run.chains()}, {}};
    const std::string& bytes = parts.bytes.front();
    std::size_t points = 0;
    const PointSink count = [&](std::size_t, PointResult&) { ++points; };
    const auto refusal = [&](const RunPart& part, const std::string& given) {
        return testing::message_of([&] { read_points(run, part, given, count); });
    };
    EXPECT_EQ(refusal(whole, bytes), "");
    EXPECT_EQ(points, 36u);
    for (std::size_t size = 0; size < bytes.size(); size += 1 + size / 7)
        EXPECT_THAT(refusal(whole, bytes.substr(0, size)), HasSubstr("no part of a computation")) << size;
    EXPECT_THAT(refusal({{0, 2}, {}}, bytes), HasSubstr("no part of a computation"));
    EXPECT_THAT(refusal({{0, std::size_t{1} << 62}, {}}, bytes), HasSubstr("no part of a computation"));
    KnownChains begun, beyond, ended;
    begun.begin(1, {1, false, {}, 0});
    beyond.begin(3, {1, false, {}, 0});
    ended.end({1, 2});
    for (const KnownChains& known : {begun, beyond, ended})
        EXPECT_THAT(refusal({{0, 3}, known}, bytes), HasSubstr("no part of a computation"));
    EXPECT_THAT(refusal({{3, 0}, {}}, bytes), HasSubstr("no part of a computation"));
    EXPECT_EQ(points, 36u); // nothing of what is refused is given

    EXPECT_THAT(testing::message_of([] { part_of("graze-part-1\n"); }), HasSubstr("no part of a computation"));
    KnownChains both = ended;
    both.begin(0, {4, true, {0.5}, 1});
    const std::string part = bytes_of({{1, 3}, both});
    const RunPart read = part_of(part);
    EXPECT_EQ(read.chains.last, 3u);
    EXPECT_TRUE(read.known.has_ended(1));
    ASSERT_TRUE(read.known.begun(0));
    EXPECT_EQ(read.known.begun(0)->state, std::vector<double>{0.5});
    for (std::size_t size = 0; size < part.size(); ++size)
        EXPECT_THAT(testing::message_of([&] { part_of(part.substr(0, size)); }), HasSubstr("no part of a computation"));
    EXPECT_THAT(testing::message_of([&] { part_of(part + "x"); }), HasSubstr("no part of a computation"));
    EXPECT_THAT(testing::message_of([&] { computed_points(run, {{2, 4}, {}}, {}); }), HasSubstr("chains of a part"));
    EXPECT_THAT(testing::message_of([&] {
                    computed_points(run, {{0, 3}, begun}, {});
                }),
                HasSubstr("no part of a computation"));

    EXPECT_THAT(testing::message_of([&] {
                    computed_points(run, {{0, 3}, beyond}, {});
                }),
                HasSubstr("no part of a computation"));

    std::string other = parts.texts.front();
    const std::string before = "\"version\":\"";
    other.insert(other.find(before) + before.size(), "older-");
    EXPECT_THAT(testing::message_of([&] { const PartedRun refused(other); }), HasSubstr("graze older-"));
    EXPECT_NE(testing::message_of([] { const PartedRun refused("{"); }), "");
    EXPECT_NE(testing::message_of([] { const PartedRun refused("{}"); }), "");
}

TEST_F(RunPartTest, IsReadPieceByPiece) {
    ResultFile file(path_, ResultFile::Access::write);
    Parts parts{1000};
    run_study(study_, file, {.only = {"sweep"}}, parts.elsewhere());
    const PartedRun run(parts.texts.front());
    const RunPart part{{1, 3}, {}};
    std::vector<std::string> pieces;
    pieces.push_back(computed_points(
        run, part, {}, [&](std::string piece) { pieces.push_back(std::move(piece)); }, std::chrono::milliseconds(0)));
    ASSERT_EQ(pieces.size(), 25U); // each point, and the end
    std::vector<std::size_t> points;
    const PointSink note = [&](std::size_t point, PointResult&) { points.push_back(point); };
    PointsReader reader(run, part);
    for (const std::string& piece : pieces)
        reader.read(piece, &piece == &pieces.back(), note);
    std::ranges::sort(points);
    ASSERT_EQ(points.size(), 24U);
    for (std::size_t point = 0; point < points.size(); ++point)
        EXPECT_EQ(points[point], 12 + point);
    // A piece is refused when one before it is missing, or when it is the last and others are missing.
    PointsReader other(run, part);
    EXPECT_THROW(other.read(pieces[3], false, note), InputError);
    EXPECT_THROW(other.read(pieces[0], true, note), InputError);
    other.read(pieces[0], false, note);
    EXPECT_THROW(other.read(pieces[0], false, note), InputError);
    EXPECT_EQ(points.size(), 25U);
}

TEST_F(RunPartTest, AFailureElsewhereFailsTheRun) {
    ResultFile file(path_, ResultFile::Access::write);
    const auto reports = run_study(
        study_, file, {.only = {"sweep"}},
        {.points = [](const AskedPoints&, const PointSink&) -> bool { throw InputError("no worker", "start one"); }});
    EXPECT_EQ(reports.front().outcome, RunOutcome::failed);
    EXPECT_EQ(reports.front().problem, "no worker");
    EXPECT_EQ(file.find_run("sweep")->failure, "no worker; start one");
}

} // namespace graze::run_part_test
