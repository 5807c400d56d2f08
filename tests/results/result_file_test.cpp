#include "graze/results/result_file.hpp"

#include "graze/base/input_error.hpp"
#include "results/schema.hpp"

#include "base/message_of.hpp"
#include "base/temporary_folder.hpp"
#include "run_of_model.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <cmath>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <random>
#include <thread>
#include <tuple>

namespace graze::result_file_test {

using ::testing::HasSubstr;

class ResultFileTest : public ::testing::Test {
protected:
    std::string path(const std::string& name = "results.sqlite") const { return folder_ / name; }

    testing::TemporaryFolder folder_;
};

RunRecord run_named(const std::string& name) {
    RunRecord run;
    run.name = name;
    run.kind = "sweep";
    run.model_name = "oscillator";
    run.model = "name = \"oscillator\"\n# 'quotes' \"and\" more";
    run.settings = "{\"cycles\":150}";
    run.fingerprint = "abc";
    run.version = "0.1.0";
    run.coordinates = {{"V", "V"}, {"label", ""}};
    run.states = {{"q", "m"}, {"v", "m/s"}};
    run.values = {{"v", "m/s"}, {"time", "s"}};
    run.samplings = {"rising", "falling"};
    run.modes = {"free", "held"};
    run.directions = {"up", "down"};
    run.points = 100;
    return run;
}

PointRecord point_numbered(std::size_t number) {
    PointRecord point;
    point.number = number;
    point.chain = number / 10;
    point.direction = number % 10 < 5 ? 0 : 1;
    point.coordinates = {4.5 + 0.001 * static_cast<double>(number), 1.0 / 3};
    PointResult& result = point.result;
    result.label = Label::periodic;
    result.period = 3;
    result.duration = 0.48;
    result.signature = "impact^4";
    result.symmetric = true;
    result.multipliers = {{0.6128, 0.1}, {0.6128, -0.1}};
    result.residual = 1e-15;
    result.lyapunov = -1.02;
    result.cycles = 56;
    result.periods_run = 70;
    result.time = 9.6;
    result.state = {0.1 + static_cast<double>(number), -0.2};
    result.mode = 1;
    result.outcome = {Ending::stopped, 9.6, "it's over"};
    result.samples.width = 2;
    for (std::size_t s = 0; s < 6; ++s) {
        result.samples.samplings.push_back(s % 2);
        result.samples.times.push_back(0.08 * static_cast<double>(s));
        result.samples.values.push_back(std::sin(static_cast<double>(number + s)));
        result.samples.values.push_back(static_cast<double>(s));
    }
    return point;
}

/// All that is stored of a point.
auto contents_of(const PointRecord& point) {
    const PointResult& r = point.result;
    return std::tuple(point.number, point.chain, point.direction, point.coordinates, r.label, r.period, r.duration,
                      r.signature, r.symmetric, r.multipliers, r.residual, r.lyapunov, r.lyapunov_error, r.cycles,
                      r.periods_run, r.time, r.state, r.mode, r.outcome.ending, r.outcome.time, r.outcome.detail,
                      r.samples.samplings, r.samples.times, r.samples.values);
}

TEST_F(ResultFileTest, OrdersRunsAsNamed) {
    ResultFile file(path(), ResultFile::Access::write);
    const auto names = [&] {
        std::string text;
        auto rows = file.query("SELECT number, name FROM runs ORDER BY number");
        while (rows.next())
            text += std::to_string(rows.integer(0)) + rows.text(1) + " ";
        return text;
    };
    for (const char* name : {"c", "a", "d", "b"}) {
        file.begin_run(run_named(name));
        file.add_point(name, point_numbered(0));
    }
    file.order_runs({"a", "b", "none", "c"});
    EXPECT_EQ(names(), "1a 2b 3c 4d ");
    auto views = file.query("SELECT DISTINCT run FROM all_points");
    std::string order;
    while (views.next())
        order += views.text(0);
    EXPECT_EQ(order, "abcd");
    file.begin_run(run_named("d")); // again
    file.order_runs({"a", "b", "c", "d"});
    EXPECT_EQ(names(), "1a 2b 3c 4d ");
    // Two runs can be written alternately.
    for (std::size_t n = 1; n < 4; ++n)
        for (const char* name : {"a", "b"})
            file.add_point(name, point_numbered(n));
    EXPECT_EQ(file.point_count("a"), 4u);
    EXPECT_EQ(file.point_count("b"), 4u);
}

TEST_F(ResultFileTest, ReadsRunsAndPointsAsWritten) {
    {
        ResultFile file(path(), ResultFile::Access::write);
        file.begin_run(run_named("sweep_6.25-Hz"));
        for (const std::size_t number : {0, 1, 7, 12})
            file.add_point("sweep_6.25-Hz", point_numbered(number));
        file.complete_run("sweep_6.25-Hz");
    }
    const ResultFile file(path(), ResultFile::Access::read);
    const auto run = file.find_run("sweep_6.25-Hz");
    ASSERT_TRUE(run);
    const RunRecord given = run_named("");
    EXPECT_EQ(run->status, RunStatus::complete);
    EXPECT_EQ(run->model, given.model);
    EXPECT_EQ(run->settings, given.settings);
    EXPECT_EQ(run->fingerprint, given.fingerprint);
    EXPECT_EQ(run->coordinates[1].name, "label");
    EXPECT_EQ(run->states[1].unit, "m/s");
    EXPECT_EQ(run->samplings, given.samplings);
    EXPECT_EQ(run->modes, given.modes);
    EXPECT_EQ(run->points, 100u);
    EXPECT_EQ(file.point_count(run->name), 4u);
    for (const std::size_t number : {0, 1, 7, 12})
        EXPECT_EQ(contents_of(*file.point(run->name, number)), contents_of(point_numbered(number)));
    EXPECT_FALSE(file.point(run->name, 2));
    // The folder contains only the file and its lock.
    EXPECT_FALSE(std::filesystem::exists(path() + "-wal"));
}

TEST_F(ResultFileTest, WritesNonFiniteNumbersAsNull) {
    ResultFile file(path(), ResultFile::Access::write);
    file.begin_run(run_named("r"));
    PointRecord point = point_numbered(0);
    point.result.label = Label::singular;
    point.result.state[0] = std::nan("");
    point.result.samples.values[0] = INFINITY;
    file.add_point("r", point);
    file.flush();
    auto rows = file.query("SELECT end_q, period FROM points_r");
    ASSERT_TRUE(rows.next());
    EXPECT_TRUE(rows.is_null(0));
    EXPECT_TRUE(rows.is_null(1));
    EXPECT_TRUE(std::isnan(file.point("r", 0)->result.state[0]));
}

TEST_F(ResultFileTest, FindsNearestAndLastPoints) {
    ResultFile file(path(), ResultFile::Access::write);
    file.begin_run(run_named("r"));
    for (const std::size_t number : {0, 1, 2, 3, 4, 5, 6, 10, 11})
        file.add_point("r", point_numbered(number));
    EXPECT_EQ(file.nearest_point("r", "V", 4.5021, {})->number, 2u);
    EXPECT_EQ(file.nearest_point("r", "V", 4.5, 1)->number, 5u);
    EXPECT_EQ(file.nearest_point("r", "V", 99, {})->number, 11u);
    EXPECT_FALSE(file.nearest_point("r", "W", 1, {}));
    const auto next = file.last_points("r", 10);
    EXPECT_EQ(next()->number, 6u);
    const auto last = next();
    ASSERT_TRUE(last);
    EXPECT_EQ(last->number, 11u);
    EXPECT_EQ(last->result.state, point_numbered(11).result.state);
    EXPECT_FALSE(next());
    const auto next_number = file.point_numbers("r");
    for (const std::size_t number : {0, 1, 2, 3, 4, 5, 6, 10, 11})
        EXPECT_EQ(next_number(), number);
    EXPECT_FALSE(next_number());
}

TEST_F(ResultFileTest, ARunBegunAgainReplacesTheOldOne) {
    ResultFile file(path(), ResultFile::Access::write);
    for (const char* name : {"a", "b"}) {
        file.begin_run(run_named(name));
        file.add_point(name, point_numbered(3));
    }
    file.begin_run(run_named("a"));
    EXPECT_EQ(file.point_count("a"), 0u);
    EXPECT_EQ(file.point_count("b"), 1u);
    {
        auto rows = file.query("SELECT count(*) FROM multipliers");
        ASSERT_TRUE(rows.next());
        EXPECT_EQ(rows.integer(0), 2);
    }
    file.remove_run("b");
    EXPECT_EQ(file.runs().size(), 1u);
}

TEST_F(ResultFileTest, ViewsListChangesOfLabels) {
    ResultFile file(path(), ResultFile::Access::write);
    file.begin_run(run_named("r"));
    for (std::size_t number = 0; number < 5; ++number) {
        PointRecord point = point_numbered(number);
        if (number >= 3)
            point.result.label = Label::chaotic;
        file.add_point("r", point);
    }
    auto rows = file.query("SELECT coordinate_before, coordinate, label_before, label FROM label_changes");
    ASSERT_TRUE(rows.next());
    EXPECT_EQ(rows.number(0), 4.502);
    EXPECT_EQ(rows.number(1), 4.503);
    EXPECT_EQ(rows.text(2), "periodic");
    EXPECT_EQ(rows.text(3), "chaotic");
    EXPECT_FALSE(rows.next());
}

std::string refusal(const std::string& path, ResultFile::Access access) {
    return testing::message_of([&] { ResultFile(path, access); });
}

TEST_F(ResultFileTest, RefusesUnreadableFiles) {
    EXPECT_THAT(refusal(path(), ResultFile::Access::read), HasSubstr("there is no such result file"));
    std::ofstream(path("text")) << std::string(5000, 'x');
    EXPECT_THAT(refusal(path("text"), ResultFile::Access::read), HasSubstr("no result file of graze"));
    EXPECT_THAT(refusal(path("text"), ResultFile::Access::write), HasSubstr("no result file of graze"));
    // Results are stored in files only.
    std::filesystem::remove(":memory:.lock");
    for (const auto access : {ResultFile::Access::read, ResultFile::Access::write})
        for (const char* name : {"", ":memory:"})
            EXPECT_THAT(refusal(name, access), HasSubstr("names no file to keep results in")) << name;
    EXPECT_FALSE(std::filesystem::exists(":memory:.lock"));
    EXPECT_THAT(refusal(path("none/results.sqlite"), ResultFile::Access::write), HasSubstr("cannot be written"));
    { ResultFile file(path(), ResultFile::Access::write); }
    testing::change(path(), "PRAGMA user_version = 99; DELETE FROM meta");
    for (const auto access : {ResultFile::Access::read, ResultFile::Access::write})
        EXPECT_THAT(refusal(path(), access),
                    HasSubstr(fmt::format("format 99, this version of graze knows formats {} to {}",
                                          oldest_result_format, result_format)));
}

TEST_F(ResultFileTest, ATextThatIsTooLongIsRefusedAndWhatIsThereStays) {
    ResultFile file(path(), ResultFile::Access::write);
    file.set_note("study", "short");
    const std::string message = testing::message_of([&] { file.set_note("study", std::string(70'000'000, 'x')); });
    EXPECT_THAT(message, ::testing::HasSubstr("a text of 70 MB"));
    EXPECT_EQ(file.note("study"), "short");
}

TEST_F(ResultFileTest, OneProcessWritesAndOthersRead) {
    ResultFile file(path(), ResultFile::Access::write);
    file.begin_run(run_named("r"));
    file.add_point("r", point_numbered(0));
    file.flush();
    EXPECT_THAT(refusal(path(), ResultFile::Access::write), HasSubstr("another graze writes to this result file"));
    const ResultFile reader(path(), ResultFile::Access::read);
    EXPECT_EQ(reader.point_count("r"), 1u);
}

TEST_F(ResultFileTest, AFileThatIsBeingCreatedIsFoundWholeOrNotAtAll) {
    EXPECT_FALSE(ResultFile::find(path("none.sqlite")));
    constexpr int files = 100;
    const auto name = [](int i) { return fmt::format("{}.sqlite", i); };
    std::jthread writer([&] {
        for (int i = 0; i < files; ++i)
            ResultFile(path(name(i)), ResultFile::Access::write).begin_run(run_named("r"));
    });
    for (int i = 0; i < files; ++i) {
        std::optional<ResultFile> found;
        while (!found)
            ASSERT_NO_THROW(found = ResultFile::find(path(name(i))));
        EXPECT_EQ(found->path(), path(name(i)));
    }
}

TEST_F(ResultFileTest, AFullDiskIsReportedAndLosesNothing) {
    {
        ResultFile file(path(), ResultFile::Access::write);
        file.begin_run(run_named("r"));
        for (std::size_t number = 0; number < 10; ++number)
            file.add_point("r", point_numbered(number));
        file.flush();
    }
    const pid_t child = fork();
    ASSERT_GE(child, 0);
    if (child == 0) {
        // A limit on the size of files has the same effect as a full disk.
        std::signal(SIGXFSZ, SIG_IGN);
        const rlimit limit{300'000, 300'000};
        setrlimit(RLIMIT_FSIZE, &limit);
        int code = 1;
        try {
            ResultFile file(path(), ResultFile::Access::write);
            for (std::size_t number = 10; number < 100'000; ++number)
                file.add_point("r", point_numbered(number));
            file.flush();
        } catch (const InputError& error) {
            code = std::string(error.what()).find("make room on the disk") != std::string::npos ? 0 : 2;
        }
        _exit(code);
    }
    int status = 0;
    waitpid(child, &status, 0);
    EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 0) << status;
    ResultFile file(path(), ResultFile::Access::write);
    EXPECT_GE(file.point_count("r"), 10u);
    for (std::size_t number = 0; number < 10; ++number)
        EXPECT_EQ(contents_of(*file.point("r", number)), contents_of(point_numbered(number)));
}

TEST_F(ResultFileTest, KilledWritersLeaveCompletePoints) {
    std::mt19937 random(1);
    std::size_t before = 0;
    int longest = 12'000; // microseconds; increased on slow disks until points have been written
    {
        ResultFile file(path(), ResultFile::Access::write);
        file.begin_run(run_named("r"));
    }
    for (int round = 0; round < 100; ++round) {
        const pid_t child = fork();
        ASSERT_GE(child, 0);
        if (child == 0) {
            try {
                ResultFile file(path(), ResultFile::Access::write);
                for (std::size_t number = file.point_count("r"); number < 1'000'000; ++number) {
                    file.add_point("r", point_numbered(number));
                    if (number % 16 == 0)
                        file.flush();
                }
            } catch (...) {
                _exit(1);
            }
            _exit(0);
        }
        std::this_thread::sleep_for(std::chrono::microseconds(std::uniform_int_distribution<>(500, longest)(random)));
        kill(child, SIGKILL);
        waitpid(child, nullptr, 0);
        const ResultFile file(path(), ResultFile::Access::read);
        const std::size_t count = file.point_count("r");
        ASSERT_GE(count, before);
        if (count > 0) {
            EXPECT_EQ(contents_of(*file.point("r", count - 1)), contents_of(point_numbered(count - 1)));
        }
        auto rows = file.query("SELECT count(*), (SELECT count(*) FROM multipliers) FROM samples_r");
        ASSERT_TRUE(rows.next());
        ASSERT_EQ(rows.integer(0), static_cast<std::int64_t>(6 * count));
        ASSERT_EQ(rows.integer(1), static_cast<std::int64_t>(2 * count));
        if (count == before)
            longest = std::min(longest + 2000, 100'000);
        before = count;
    }
    EXPECT_GT(before, 100u);
}

} // namespace graze::result_file_test
