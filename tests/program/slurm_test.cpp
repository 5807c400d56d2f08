// Jobs of SLURM, with sbatch and squeue replaced by small scripts; tests/cluster/ has tests with SLURM itself.

#include "graze/base/input_error.hpp"
#include "program/slurm_jobs.hpp"
#include "program/slurm_script.hpp"
#include "run_graze.hpp"
#include "started_process.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>

namespace graze::testing::slurm_test {

using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::StartsWith;

const char* const study = R"(
name = "quick"
model = "impact-oscillator"
set = { sigma = 0.5, omega = 1.2, amplitude = 0.1 }
[runs.sweep]
kind = "sweep"
vary = { amplitude = { from = 0.1, to = 0.3, points = 3 }, omega = { from = 1.1, to = 1.3, points = 5 } }
cycles = 30
[runs.after]
kind = "sweep"
start = { run = "sweep" }
vary = { amplitude = { from = 0.3, to = 0.4, points = 4 } }
cycles = 30
)";

/// Keeps each call in FOLDER/calls. Computes the tasks of the array at once, but for those that FOLDER/lost names,
/// whose states are FAILED, and those in FOLDER/queued, which wait.
const char* const sbatch = R"sh(#!/bin/sh
cd "$(dirname "$0")" || exit
echo "$@" >>calls
[ ! -e refuse ] || { cat refuse; exit 1; }
for script; do :; done
job=$(($(cat jobs 2>/dev/null || echo 0) + 1))
echo $job >jobs
echo "sbatch: a remark of the cluster"
echo $job
numbers=$(sed -n 's/^#SBATCH --array=//p' "$script" | tr , ' ')
for range in $numbers; do
    for number in $(seq "${range%-*}" "${range#*-}"); do
        if grep -qx "$number" lost 2>/dev/null; then
            echo "${job}_$number FAILED NonZeroExitCode" >>states
        elif grep -qx "$number" queued 2>/dev/null; then
            echo "${job}_$number PENDING Resources" >>states
        else
            SLURM_ARRAY_TASK_ID=$number sh "$script" >>messages 2>&1
            echo "${job}_$number COMPLETED None" >>states
        fi
    done
done
)sh";
const char* const squeue = R"sh(#!/bin/sh
cd "$(dirname "$0")" || exit
[ ! -e deaf ] || { echo "slurm_load_jobs error: Unable to contact slurm controller"; exit 1; }
job=$(echo "$@" | sed 's/.*--jobs=\([0-9]*\).*/\1/')
grep "^${job}_" states && exit
echo "slurm_load_jobs error: Invalid job id specified"
exit 1
)sh";

class Slurm : public ::testing::Test {
protected:
    Slurm() : path_(std::getenv("PATH")) {
        folder.write("study.toml", study);
        std::filesystem::create_directory(folder / "bin");
        for (const auto& [name, text] : {std::pair("sbatch", sbatch), {"squeue", squeue}}) {
            folder.write("bin/" + std::string(name), text);
            std::filesystem::permissions(bin(name), std::filesystem::perms::owner_all);
        }
        setenv("PATH", (bin("") + ":" + path_).c_str(), 1);
    }
    ~Slurm() override { setenv("PATH", path_.c_str(), 1); }

    std::string bin(const std::string& name) const { return folder / ("bin/" + name); }
    void remove(const std::string& name) const { std::filesystem::remove(bin(name)); }
    std::vector<std::string> words(std::vector<std::string> more = {}) const {
        more.insert(more.begin(),
                    {"run", folder / "study.toml", "--output", folder / "a", "--no-pictures", "--slurm", "3"});
        return more;
    }
    /// The program in a process of its own: its own path is in the script.
    Printed started(const std::vector<std::string>& arguments) const {
        StartedProcess process(arguments, folder / "log");
        const int code = process.wait();
        return {code, "", process.printed()};
    }
    std::string points(const std::string& output) const {
        std::string all;
        for (const char* run : {"sweep", "after"})
            all += done({"export", folder / output, "--run", run, "--format", "csv"});
        return all;
    }
    void expect_as_one_process(const std::string& output) const {
        done({"run", folder / "study.toml", "--output", folder / "whole", "--no-pictures"});
        EXPECT_EQ(points(output), points("whole"));
    }
    const Folder folder;

private:
    std::string path_;
};

TEST_F(Slurm, ComputesAndMergesUntilNothingWaits) {
    const Printed printed = started(words({"--", "--mem", "4 G"}));
    EXPECT_EQ(printed.code, exit_success) << printed.err;
    EXPECT_THAT(printed.err, HasSubstr("job 1 of SLURM computes all 3 parts\n"));
    EXPECT_THAT(printed.err, HasSubstr("job 2 of SLURM computes all 3 parts\n"))
        << "`after` begins when all of `sweep` is there";
    EXPECT_THAT(contents(bin("calls")), StartsWith("--parsable --mem 4 G " + (folder / "a/parts/slurm.sh") + "\n"));
    expect_as_one_process("a");
    const Printed again = started(words());
    EXPECT_EQ(again.code, exit_success);
    EXPECT_THAT(again.err, Not(HasSubstr("job"))) << "nothing is left";
}

TEST_F(Slurm, SubmitsWhatIsLeft) {
    folder.write("bin/lost", "2\n");
    const Printed printed = started(words());
    EXPECT_EQ(printed.code, exit_irregular);
    EXPECT_THAT(printed.err, HasSubstr("run 'sweep': 6 of 15 points are missing"));
    EXPECT_THAT(printed.err, HasSubstr("not there: part 2 of 3"));
    EXPECT_THAT(printed.err,
                HasSubstr("SLURM has ended a task: FAILED 2; what they say is in " + (folder / "a/parts/2-of-3.log")));
    remove("lost");
    const Printed again = started(words());
    EXPECT_EQ(again.code, exit_success) << again.err;
    EXPECT_THAT(again.err, HasSubstr("job 2 of SLURM computes part 2 of 3; 2 ended before\n"));
    expect_as_one_process("a");
}

TEST_F(Slurm, JobsInTheQueueAreNotSubmittedAgain) {
    folder.write("bin/queued", "1\n3\n");
    const Printed printed = started(words({"--no-wait"}));
    EXPECT_EQ(printed.code, exit_success);
    EXPECT_THAT(printed.err, HasSubstr("when the jobs have ended, type: graze merge " + (folder / "a") + "\n"));
    EXPECT_THAT(printed.err, HasSubstr("wait for all parts: after\n"));
    const Printed again = started(words({"--no-wait"}));
    EXPECT_THAT(again.err, HasSubstr("2 of 3 parts are in SLURM's queue already\n"));
    EXPECT_THAT(again.err, Not(HasSubstr("computes")));
    // One of them was cancelled; the other one remains.
    folder.write("bin/states", "1_1 CANCELLED None\n1_2 COMPLETED None\n1_3 RUNNING None\n");
    remove("queued");
    EXPECT_THAT(started(words({"--no-wait"})).err, HasSubstr("job 2 of SLURM computes part 1 of 3; 1 ended before\n"));
    folder.write("bin/deaf", "");
    const Printed deaf = started(words({"--no-wait"}));
    EXPECT_EQ(deaf.code, exit_bad_input);
    EXPECT_THAT(deaf.err, HasSubstr("squeue does not answer"));
}

TEST_F(Slurm, InterruptedWaitingLeavesTheJobs) {
    folder.write("bin/queued", "1\n2\n3\n");
    StartedProcess process(words({"--progress"}), folder / "log");
    for (int i = 0; i < 1000 && process.printed().find("wait (Resources)") == std::string::npos; ++i)
        usleep(10'000);
    process.signal(SIGINT);
    EXPECT_EQ(process.wait(), exit_interrupted);
    EXPECT_THAT(process.printed(), HasSubstr("0 of 3 parts have ended, 0 run, 3 wait (Resources)"));
    EXPECT_THAT(process.printed(), HasSubstr("interrupted; the jobs go on"));
    EXPECT_THAT(process.printed(), HasSubstr("scancel 1 "));
}

TEST_F(Slurm, OptionsThatWereGivenReachTheTasks) {
    folder.write("bin/queued", "1\n2\n3\n");
    const std::string values = folder.write("values.toml", "[set]\nzeta = 0.02\n");
    done(words({"--no-wait", "--set", "omega=1.25,@" + values, "--only", "sweep", "--steps"}));
    EXPECT_THAT(contents(folder / "a/parts/slurm.sh"),
                HasSubstr("run " + (folder / "study.toml") + " --output " + (folder / "a") +
                          " --set omega=1.25 --set @" + values + " --only sweep --steps \\\n"));
    EXPECT_THAT(contents(folder / "a/parts/slurm.sh"), StartsWith("#!/bin/sh\n#SBATCH --job-name=graze-quick\n"
                                                                  "#SBATCH --array=1-3\n"));
    // Parts of other values do not mix with them.
    std::filesystem::remove(folder / "a/parts/slurm-jobs-of-3");
    done({"run", folder / "study.toml", "--output", folder / "a", "--part", "1/3", "--quiet"});
    expect_refusal(words({"--set", "zeta=0.02"}), "zeta=0.02");
}

TEST_F(Slurm, MistakesAreReported) {
    expect_refusal(words({"--part", "1/2"}), "--part has no effect beside --slurm; leave one of them out");
    expect_refusal(words({"--jobs", "2"}), "--jobs has no effect beside --slurm; tell SLURM instead");
    expect_refusal(words({"--", "--array=1"}), "--array=1: the array has one task for each part");
    const std::vector<std::string> plain{"run", folder / "study.toml", "--output", folder / "b"};
    std::vector<std::string> wrong = plain;
    wrong.emplace_back("--no-wait");
    expect_refusal(wrong, "--no-wait has no effect without --slurm");
    wrong.back() = "--";
    wrong.emplace_back("--mem=4G");
    expect_refusal(wrong, "what follows -- has no effect without --slurm");
    folder.write("bin/refuse",
                 "sbatch: error: invalid partition specified: x\nsbatch: error: Batch job submission failed\n");
    expect_refusal(words(),
                   "sbatch refuses the jobs: sbatch: error: invalid partition specified: x / sbatch: error: Batch");
    EXPECT_FALSE(std::filesystem::exists(folder / "a/parts/slurm-jobs-of-3"));
    setenv("PATH", "/nonexistent", 1);
    expect_refusal(words(), "there is no sbatch on this machine");
}

TEST(SlurmScript, QuotesWhatShellsWouldRead) {
    EXPECT_EQ(shell_word("/plain/path-1_2.toml"), "/plain/path-1_2.toml");
    EXPECT_EQ(shell_word(""), "''");
    EXPECT_EQ(shell_word("it's $HOME"), "'it'\\''s $HOME'");
    const std::string script = slurm_script({.name = "s",
                                             .folder = "/a \"b\"/100%/parts",
                                             .count = 8,
                                             .numbers = {1, 3, 4, 5, 8},
                                             .command = {"/bin/my graze", "run", "it's.toml", "--set", "k=2*pi"}});
    EXPECT_THAT(script, HasSubstr("\n#SBATCH --array=1,3-5,8\n"));
    EXPECT_THAT(script, HasSubstr("\n#SBATCH --output=\"/a \\\"b\\\"/100%%/parts/%a-of-8.log\"\n"));
    EXPECT_THAT(script, HasSubstr("\nexec '/bin/my graze' run 'it'\\''s.toml' --set 'k=2*pi' \\\n"));
    EXPECT_THROW(slurm_script({.name = "s", .folder = "/a\nb", .numbers = {1}}), InputError);
}

TEST(SlurmJobs, AreReadFromLinesOfSbatch) {
    EXPECT_EQ(text_of(slurm_job("12").value()), "12");
    EXPECT_EQ(slurm_job("12;big").value().cluster, "big");
    for (const char* wrong : {"", "0", "12 ", "x", "12;--all;", "-1", "12;a b"})
        EXPECT_FALSE(slurm_job(wrong)) << wrong;
}

} // namespace graze::testing::slurm_test
