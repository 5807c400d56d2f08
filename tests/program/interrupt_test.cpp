// Ctrl-C, SIGTERM and other signals, sent to the program in another process.

#include "places.hpp"
#include "run_graze.hpp"

#include <csignal>
#include <fcntl.h>
#include <fstream>
#include <gmock/gmock.h>
#include <spawn.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

extern char** environ;

namespace graze::testing {

namespace {

/// Starts a program. @param messages file for its standard error. @return its process, 0 if it cannot be started
pid_t started(std::vector<std::string> words, const std::string& messages) {
    std::vector<char*> pointers;
    for (std::string& word : words)
        pointers.push_back(word.data());
    pointers.push_back(nullptr);
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, "/dev/null", O_WRONLY, 0666);
    posix_spawn_file_actions_addopen(&actions, STDERR_FILENO, messages.c_str(), O_WRONLY | O_CREAT, 0666);
    pid_t child = 0;
    const int problem = posix_spawn(&child, pointers[0], &actions, nullptr, pointers.data(), environ);
    posix_spawn_file_actions_destroy(&actions);
    return problem == 0 ? child : 0;
}

} // namespace

class Interrupt : public ::testing::TestWithParam<int> {};
class EndingSignal : public ::testing::TestWithParam<int> {};

TEST_P(Interrupt, WritesTheTableComputedSoFar) {
    const Folder folder;
    const std::string file = folder / "run.csv", messages = folder / "messages";
    std::vector<std::string> words{program_file, "simulate",  "electromagnetic-testbed",
                                   "--periods",  "100000000", "--section",
                                   "phase0",     "--format",  "csv",
                                   "--output",   file,        "--progress"};
    const pid_t child = started(words, messages);
    ASSERT_GT(child, 0);
    // Progress appears after two seconds: then it is certainly running.
    for (int i = 0; i < 600 && contents(messages).empty(); ++i)
        usleep(100'000);
    EXPECT_FALSE(std::filesystem::exists(file)) << "half a file";
    kill(child, GetParam());
    int status = 0;
    waitpid(child, &status, 0);
    ASSERT_TRUE(WIFEXITED(status));
    EXPECT_EQ(WEXITSTATUS(status), GetParam() == SIGINT ? exit_interrupted : exit_terminated);
    EXPECT_THAT(contents(messages), ::testing::HasSubstr("graze: interrupted at time"));
    EXPECT_GT(Csv(contents(file)).rows.size(), 100U);
    EXPECT_EQ(folder.files(), 2U);
}

/// The program is interrupted while it writes a record.
TEST_P(Interrupt, LeavesNoIncompleteRecord) {
    const Folder folder;
    const std::string record = folder / "in.csv", file = folder / "out.csv", messages = folder / "messages";
    {
        std::ofstream rows(record);
        rows << "t,q\n";
        for (int i = 0; i < 1'000'000; ++i)
            rows << i << ',' << i % 1000 << '\n';
    }
    std::vector<std::string> words{program_file, "record", record, "--derivative", "q", "--write", file};
    const pid_t child = started(words, messages);
    ASSERT_GT(child, 0);
    constexpr std::size_t with_its_own = 3; // the record, the messages, and the temporary file
    for (int i = 0; i < 10'000 && folder.files() < with_its_own; ++i)
        usleep(1000);
    kill(child, GetParam());
    int status = 0;
    waitpid(child, &status, 0);
    ASSERT_TRUE(WIFEXITED(status));
    EXPECT_EQ(WEXITSTATUS(status), GetParam() == SIGINT ? exit_interrupted : exit_terminated);
    EXPECT_THAT(contents(messages), ::testing::HasSubstr("is not written"));
    EXPECT_EQ(folder.files(), 2U);
}

/// `graze export` ends at once, and its temporary file is removed.
TEST_P(EndingSignal, LeavesNoIncompleteExport) {
    const rlimit no_core{0, 0}; // some of these signals would write a core file
    setrlimit(RLIMIT_CORE, &no_core);
    const Folder folder;
    const std::string study = folder.write("s.toml", "name = \"s\"\nmodel = \"bouncing-ball\"\n[runs.r]\nkind = "
                                                     "\"simulate\"\ntime = 1\n");
    ASSERT_EQ(run_graze({"run", study, "--output", folder / "results", "--quiet"}).code, 0);
    const std::string rows =
        "WITH RECURSIVE c(x) AS (SELECT 1 UNION ALL SELECT x + 1 FROM c LIMIT 1000000000) SELECT x "
        "FROM c";
    const std::string file = folder / "out.csv", messages = folder / "messages";
    const pid_t child = started(
        {program_file, "export", folder / "results", "--sql", rows, "--format", "csv", "--output", file}, messages);
    ASSERT_GT(child, 0);
    constexpr std::size_t with_its_own = 4; // study, results, messages, and the temporary file
    for (int i = 0; i < 20'000 && folder.files() < with_its_own; ++i)
        usleep(1000);
    EXPECT_EQ(folder.files(), with_its_own);
    kill(child, GetParam());
    int status = 0;
    waitpid(child, &status, 0);
    EXPECT_TRUE(WIFSIGNALED(status) && WTERMSIG(status) == GetParam());
    EXPECT_EQ(contents(messages), "");
    EXPECT_EQ(folder.files(), with_its_own - 1);
}

/// A motion of a study that would take years ends soon after the signal.
TEST_P(Interrupt, EndsALongMotionOfAStudy) {
    const Folder folder;
    const std::string study = folder / "stiff.toml", results = folder / "results", messages = folder / "messages";
    std::ofstream(study) << "name = \"stiff\"\nmodel = \"electromagnetic-testbed\"\nset = { R = 1.41e12 }\n"
                            "[runs.a]\nkind = \"simulate\"\ntime = 0.01\n";
    std::vector<std::string> words{program_file, "run", study, "--output", results};
    const pid_t child = started(words, messages);
    ASSERT_GT(child, 0);
    for (int i = 0; i < 60'000 && !std::filesystem::exists(results + "/results.sqlite"); ++i)
        usleep(1000);
    usleep(300'000); // so that the motion has begun; the test holds even if it has not
    kill(child, GetParam());
    int status = 0;
    pid_t ended = 0;
    for (int i = 0; i < 60'000 && (ended = waitpid(child, &status, WNOHANG)) == 0; ++i)
        usleep(1000);
    if (ended == 0) {
        kill(child, SIGKILL);
        waitpid(child, &status, 0);
    }
    ASSERT_EQ(ended, child) << "a minute later it still runs";
    ASSERT_TRUE(WIFEXITED(status));
    EXPECT_EQ(WEXITSTATUS(status), GetParam() == SIGINT ? exit_interrupted : exit_terminated);
    EXPECT_THAT(contents(messages), ::testing::HasSubstr("graze: interrupted"));
}

INSTANTIATE_TEST_SUITE_P(Signals, Interrupt, ::testing::Values(SIGINT, SIGTERM));
INSTANTIATE_TEST_SUITE_P(Signals, EndingSignal,
                         ::testing::Values(SIGINT, SIGTERM, SIGHUP, SIGQUIT, SIGPIPE, SIGALRM, SIGUSR1, SIGXCPU));

} // namespace graze::testing
