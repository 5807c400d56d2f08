#include "program/run_graze.hpp"
#include "program/started_process.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <unistd.h>

#include <algorithm>
#include <cctype>
#include <chrono>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <random>
#include <set>
#include <sstream>
#include <thread>

namespace graze::testing::run_study_test {

using ::testing::HasSubstr;
using ::testing::StartsWith;

const char* const study = R"(
name = "quick"
model = "electromagnetic-testbed"
values = ["v", "I"]
[runs.sweep]
kind = "sweep"
vary = { V0 = { from = 4.82, to = 4.86, step = 0.001 } }
direction = "both"
cycles = 60
lyapunov_cycles = 40
[runs.basin]
kind = "basin"
vary = { q = { from = -0.001, to = 0.001, points = 4 }, v = { from = -0.1, to = 0.1, points = 4 } }
cycles = 60
)";

class RunStudyTest : public ::testing::Test {
protected:
    RunStudyTest() { folder.write("study.toml", study); }
    std::string path(const std::string& name) const { return folder / name; }
    Printed study_run(const std::string& output) {
        return run_graze({"run", path("study.toml"), "--output", path(output), "--no-pictures", "--format", "csv"});
    }
    std::string everything(const std::string& output) {
        std::string all;
        for (const char* what : {"points", "samples"})
            for (const char* run : {"sweep", "basin"})
                all += run_graze({"export", path(output), "--run", run, "--what", what, "--format", "csv"}).out;
        return all + run_graze({"export", path(output), "--what", "multipliers", "--format", "csv"}).out;
    }
    const Folder folder;
};

TEST_F(RunStudyTest, IsComputedOnceAndExported) {
    const std::string first = done(study_run("a"));
    EXPECT_THAT(first, HasSubstr("sweep,sweep,82,82,"));
    EXPECT_THAT(first, HasSubstr("basin,basin,16,16,"));
    EXPECT_THAT(study_run("a").out, HasSubstr("was there"));
    const std::string points = done({"export", path("a"), "--run", "sweep", "--label", "periodic", "--format", "csv"});
    EXPECT_THAT(points, StartsWith("number,chain,direction,V0,label,period,duration,signature,"));
    const Printed query = run_graze({"export", path("a"), "--sql", "SELECT 1 + 1 AS two", "--format", "csv"});
    EXPECT_EQ(query.out, "two\n2\n");
    done({"export", path("a"), "--format", "hdf5", "--output", path("a.h5")});
    EXPECT_GT(std::filesystem::file_size(path("a.h5")), 10'000u);
    EXPECT_THAT(run_graze({"export", path("a"), "--what", "runs"}).out, HasSubstr("complete"));
}

TEST_F(RunStudyTest, MistakesAreReportedAndChangeNothing) {
    EXPECT_EQ(run_graze(std::vector<std::string>{"run"}).code, 2);
    EXPECT_THAT(run_graze("run mems-swich").err, HasSubstr("did you mean 'mems-switch'?"));
    EXPECT_THAT(run_graze("run " + path("none.toml")).err, HasSubstr("the study cannot be read"));
    EXPECT_THAT(run_graze({"run", path("study.toml"), "--only", "swep"}).err, HasSubstr("did you mean 'sweep'?"));
    EXPECT_THAT(run_graze({"run", path("study.toml"), "--output", path("study.toml")}).err,
                HasSubstr("cannot be made"));
    EXPECT_THAT(run_graze("export " + path("none")).err, HasSubstr("there is no such result file"));
    ASSERT_EQ(study_run("a").code, 0);
    EXPECT_THAT(run_graze({"export", path("a"), "--run", "swep"}).err, HasSubstr("did you mean 'sweep'?"));
    EXPECT_THAT(run_graze("export " + path("a")).err, HasSubstr("export one of them at a time"));
    EXPECT_EQ(run_graze({"export", path("a"), "--sql", "DROP TABLE runs"}).code, 2);
    EXPECT_EQ(run_graze({"export", path("a"), "--sql", "SELECT nothing FROM nowhere"}).code, 2);
    EXPECT_THAT(run_graze({"plot", path("a"), "--run", "sweep", "--y", "w", "--output", path("x.png")}).err,
                HasSubstr("has no value 'w'"));
    EXPECT_FALSE(std::filesystem::exists(path("x.png")));
}

TEST_F(RunStudyTest, DrawsPicturesOfEveryKind) {
    ASSERT_EQ(study_run("a").code, 0);
    const auto drawn = [&](std::vector<std::string> options) {
        std::vector<std::string> words{"plot", path("a"), "--output", path("p.svg")};
        words.insert(words.end(), options.begin(), options.end());
        std::filesystem::remove(path("p.svg"));
        done(words);
        return std::filesystem::exists(path("p.svg")) ? std::filesystem::file_size(path("p.svg")) : 0;
    };
    EXPECT_GT(drawn({"--run", "sweep"}), 10'000u);
    EXPECT_GT(drawn({"--run", "basin"}), 2'000u);
    EXPECT_GT(drawn({"--run", "sweep", "--kind", "portrait", "--x", "I", "--y", "v", "--at", "V0=4.85"}), 5'000u);
    EXPECT_GT(drawn({"--run", "sweep", "--kind", "history", "--y", "v", "--at", "V0=4.85"}), 5'000u);
    EXPECT_GT(drawn({"--run", "sweep", "--kind", "spectrum", "--y", "I", "--at", "V0=4.85"}), 2'000u);
    EXPECT_GT(drawn({"--run", "sweep", "--kind", "scatter", "--y", "lyapunov"}), 2'000u);
    EXPECT_GT(drawn({"--run", "sweep", "--kind", "regression", "--y", "I"}), 2'000u);
}

/// Starts the program and kills it after a time. @return true if it had finished before
bool run_and_kill(const std::vector<std::string>& words, const std::string& log, std::chrono::microseconds after) {
    StartedProcess process(words, log);
    std::this_thread::sleep_for(after);
    return process.ended() == 0;
}

using RunStudySlow = RunStudyTest;

TEST_F(RunStudyTest, OnlyDrawsPicturesOfTheChosenRuns) {
    const Printed some = run_graze({"run", path("study.toml"), "--output", path("some"), "--only", "basin"});
    EXPECT_EQ(some.code, 0) << some.err;
    EXPECT_TRUE(std::filesystem::exists(path("some/basin.png")));
    EXPECT_FALSE(std::filesystem::exists(path("some/sweep.png")));
    EXPECT_THAT(some.err, Not(HasSubstr("picture")));
}

TEST_F(RunStudySlow, HasTheSameResultsAfterAHundredKills) {
    ASSERT_EQ(study_run("whole").code, 0);
    const std::string whole = everything("whole");
    std::mt19937 random(7);
    int kills = 0;
    // When a study is complete, the next round begins in a new folder, so that kills hit all stages of a study.
    for (int round = 0; kills < 100; ++round) {
        const std::string output = "killed" + std::to_string(round);
        const std::vector<std::string> words{"run", path("study.toml"), "--output", path(output), "--jobs",
                                             "2",   "--no-pictures"};
        while (!run_and_kill(words, path("log"),
                             std::chrono::microseconds(std::uniform_int_distribution<>(2'000, 250'000)(random))))
            ++kills;
        ASSERT_EQ(everything(output), whole) << "after " << kills << " kills";
        std::filesystem::remove_all(path(output));
        ASSERT_LT(round, 200);
    }
}

TEST_F(RunStudyTest, ResultsAreContinuedAndRepeatedFromTheirFileAlone) {
    ASSERT_EQ(study_run("a").code, 0);
    const std::string before = everything("a");
    std::filesystem::remove(path("study.toml"));
    const std::string on = done({"run", path("a"), "--no-pictures", "--format", "csv"});
    EXPECT_THAT(on, HasSubstr("was there"));
    EXPECT_EQ(on.find("done"), std::string::npos);
    done({"run", path("a/results.sqlite"), "--output", path("b"), "--only", "sweep,basin"});
    EXPECT_EQ(everything("a"), before);
    EXPECT_EQ(everything("b"), before);
    done({"run", path("a")});
    EXPECT_TRUE(std::filesystem::exists(path("a/sweep.png")));
}

/// A stream buffer that interrupts the program, as Ctrl-C does, after a number of lines.
class Interrupting : public std::stringbuf {
public:
    explicit Interrupting(int lines) : left_(lines) {}

protected:
    int overflow(int c) override {
        count(static_cast<char>(c));
        return std::stringbuf::overflow(c);
    }
    std::streamsize xsputn(const char* text, std::streamsize size) override {
        for (std::streamsize i = 0; i < size; ++i)
            count(text[i]);
        return std::stringbuf::xsputn(text, size);
    }

private:
    void count(char c) {
        if (c == '\n' && --left_ == 0)
            std::raise(SIGINT);
    }
    int left_;
};

TEST_F(RunStudyTest, AnInterruptedBranchTellsHowToContinue) {
    folder.write("branch.toml", R"(
name = "b"
model = "impact-oscillator"
[runs.chain]
kind = "continue"
set = { omega = 1.2, sigma = 0.5, amplitude = 0.1 }
along = { amplitude = [0.01, 0.2] }
direction = "both"
)");
    const std::vector<std::string> command{"run",           path("branch.toml"), "--output", path("b"),
                                           "--no-pictures", "--steps",           "--format", "csv"};
    Interrupting buffer(5);
    std::ostringstream out;
    std::ostream err(&buffer);
    EXPECT_EQ(run_program(command, {out, err, false}), exit_interrupted);
    EXPECT_THAT(out.str(), HasSubstr("interrupted; the same command begins the run again"));
    EXPECT_THAT(out.str(), ::testing::Not(HasSubstr("asked for")));
    const std::string again = done(command);
    EXPECT_THAT(again, HasSubstr("amplitude = 0.2"));
    EXPECT_THAT(again, ::testing::Not(HasSubstr("interrupted")));
}

TEST_F(RunStudyTest, AMotionWithoutContactsFailsWithARemedy) {
    folder.write("wait.toml", R"(
name = "w"
model = "impact-oscillator"
[runs.wait]
kind = "simulate"
set = { amplitude = 0, sigma = 1 }
contacts = 3
)");
    const std::string run = done({"run", path("wait.toml"), "--output", path("w"), "--no-pictures", "--format", "csv"});
    EXPECT_THAT(run, HasSubstr("points_failed"));
    EXPECT_THAT(run, HasSubstr("no contact that ends the motion"));
    EXPECT_THAT(run, HasSubstr("give a time too"));
}

/// False for a user such as root, to whom permissions do not apply.
bool is_kept_out(const std::string& folder) {
    return access(folder.c_str(), W_OK) != 0;
}

TEST_F(RunStudyTest, UnwritableFoldersAreReportedInOneLine) {
    ASSERT_EQ(study_run("a").code, 0);
    using std::filesystem::perms;
    std::filesystem::create_directories(path("closed"));
    std::filesystem::permissions(path("closed"), perms::owner_read | perms::owner_exec);
    std::filesystem::permissions(path("a"), perms::owner_read | perms::owner_exec);
    std::filesystem::permissions(path("a") + "/results.sqlite", perms::owner_read);
    const bool kept_out = is_kept_out(path("closed"));
    if (kept_out)
        for (const std::string output : {"closed", "closed/below", "a"})
            expect_refusal({"run", path("study.toml"), "--output", path(output)}, path(output));
    // Reading needs no permission to write.
    done({"export", path("a"), "--run", "sweep", "--format", "csv"});
    for (const char* folder : {"closed", "a"})
        std::filesystem::permissions(path(folder), perms::owner_all);
    if (!kept_out)
        GTEST_SKIP() << "permissions do not keep this user out";
}

TEST_F(RunStudyTest, NamesOfColumnsAreUsableAsNamesOfStates) {
    folder.write("names.toml", R"toml(
name = "names"
[parameters]
T = 1
label = 2
run = 3
[states]
start = 0.5
number = { initial = 0, period = "2*pi" }
arclength = 0
[modes.only]
rates = { start = "arclength", number = "T", arclength = "cos(number) - start - 0.2*arclength" }
[sections.part]
state = "number"
value = 0
)toml");
    folder.write("study.toml", R"toml(
name = "names"
model = "names.toml"
values = ["start", "Start = 2*start", "rowid = 3*start", "period = 4*start"]
[runs.point]
kind = "sweep"
vary = { T = [1, 2] }
cycles = 60
[runs.samples]
kind = "continue"
direction = "up"
along = { T = [0.9, 1.1] }
monitors = { a = { maximum = "start" }, A = { minimum = "start" }, type = "period", parameter = { maximum = "arclength" } }
)toml");
    const Printed run =
        run_graze({"run", path("study.toml"), "--output", path("n"), "--no-pictures", "--format", "csv"});
    ASSERT_EQ(run.code, 0) << run.err << run.out;
    for (const std::string name : {"point", "samples"})
        for (const std::string what : {"points", name == "point" ? "samples" : "segments"}) {
            const std::string table = done({"export", path("n"), "--run", name, "--what", what, "--format", "csv"});
            EXPECT_GT(split(table, '\n').size(), 2u);
            std::set<std::string> columns;
            for (std::string column : split(header(table), ',')) {
                std::transform(column.begin(), column.end(), column.begin(),
                               [](unsigned char c) { return std::tolower(c); });
                EXPECT_TRUE(columns.insert(column).second) << column << " is there twice in " << table;
            }
        }
    const Csv samples(run_graze({"export", path("n"), "--run", "point", "--what", "samples", "--format", "csv"}).out);
    for (std::size_t r = 0; r < samples.rows.size(); ++r) {
        EXPECT_EQ(samples.number(r, "Start_2"), 2 * samples.number(r, "start"));
        EXPECT_EQ(samples.number(r, "rowid_2"), 3 * samples.number(r, "start"));
    }
    const Csv orbits(run_graze({"export", path("n"), "--format", "csv", "--sql",
                                "SELECT a, A_2, type_2, period FROM branch_samples"})
                         .out);
    for (std::size_t r = 0; r < orbits.rows.size(); ++r) {
        EXPECT_NEAR(orbits.number(r, "a"), -orbits.number(r, "A_2"), 1e-9);
        EXPECT_EQ(orbits.number(r, "type_2"), orbits.number(r, "period"));
    }
    done({"export", path("n"), "--format", "hdf5", "--output", path("n.h5")});
    done({"points", path("n"), "--run", "samples", "--format", "csv"});
    for (const char* view : {"all_points", "label_changes", "branch_points", "special_points", "orbits"})
        EXPECT_EQ(run_graze({"export", path("n"), "--sql", std::string("SELECT * FROM ") + view}).code, 0) << view;
    for (const std::string name : {"point", "samples"})
        EXPECT_EQ(run_graze({"plot", path("n"), "--run", name, "--output", path(name + ".svg")}).code, 0) << name;
}

TEST_F(RunStudyTest, OtherFilesAreRefused) {
    EXPECT_THAT(run_graze({"run", path("none.sqlite")}).err, HasSubstr("there is no such result file"));
    std::ofstream(path("no.sqlite")) << "this is something else, however long it may be";
    EXPECT_THAT(run_graze({"run", path("no.sqlite")}).err, HasSubstr("no result file of graze"));
    EXPECT_NE(run_graze({"run", folder.path()}).code, 0);
}

TEST_F(RunStudyTest, NamesWithoutEndingSuggestTheFile) {
    std::ofstream(path("mine.toml")) << "name = \"mine\"\n[states]\nx = 1\n[modes.m]\nrates = { x = \"-x\" }\n";
    std::ofstream(path("own.toml")) << "name = \"own\"\nmodel = \"mine\"\n[runs.a]\nkind = \"simulate\"\ntime = 1\n";
    EXPECT_THAT(run_graze({"run", path("own.toml")}).err,
                HasSubstr("there is no shipped model 'mine'; the file beside the study is called mine.toml"));
    const std::filesystem::path before = std::filesystem::current_path();
    std::filesystem::current_path(std::filesystem::path(path("own.toml")).parent_path());
    const Printed of_study = run_graze("run own"), of_model = run_graze("simulate mine");
    std::filesystem::current_path(before);
    EXPECT_THAT(of_study.err, HasSubstr("there is no study 'own'; the file is called own.toml"));
    EXPECT_THAT(of_model.err, HasSubstr("there is no shipped model 'mine'; the file is called mine.toml"));
}

} // namespace graze::testing::run_study_test
