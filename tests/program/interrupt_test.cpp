// Ctrl-C, SIGTERM and other signals, sent to the program in another process.

#include "run_graze.hpp"
#include "started_process.hpp"

#include <csignal>
#include <fstream>
#include <gmock/gmock.h>
#include <unistd.h>

namespace graze::testing::interrupt_test {

class Interrupt : public ::testing::TestWithParam<int> {};
class EndingSignal : public ::testing::TestWithParam<int> {};

TEST_P(Interrupt, WritesTheTableComputedSoFar) {
    const Folder folder;
    const std::string file = folder / "run.csv", messages = folder / "messages";
    StartedProcess child(words_of("simulate electromagnetic-testbed --periods 100000000 --section phase0 --format csv "
                                  "--progress --output " +
                                  file),
                         messages);
    // Progress appears after two seconds: then it is certainly running.
    for (int i = 0; i < 600 && contents(messages).empty(); ++i)
        usleep(100'000);
    EXPECT_FALSE(std::filesystem::exists(file)) << "half a file";
    child.signal(GetParam());
    EXPECT_EQ(child.wait(), GetParam() == SIGINT ? exit_interrupted : exit_terminated);
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
    StartedProcess child({"record", record, "--derivative", "q", "--write", file}, messages);
    constexpr std::size_t with_its_own = 3; // the record, the messages, and the temporary file
    for (int i = 0; i < 10'000 && folder.files() < with_its_own; ++i)
        usleep(1000);
    child.signal(GetParam());
    EXPECT_EQ(child.wait(), GetParam() == SIGINT ? exit_interrupted : exit_terminated);
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
    done({"run", study, "--output", folder / "results", "--quiet"});
    const std::string rows =
        "WITH RECURSIVE c(x) AS (SELECT 1 UNION ALL SELECT x + 1 FROM c LIMIT 1000000000) SELECT x "
        "FROM c";
    const std::string file = folder / "out.csv", messages = folder / "messages";
    StartedProcess child({"export", folder / "results", "--sql", rows, "--format", "csv", "--output", file}, messages);
    constexpr std::size_t with_its_own = 4; // study, results, messages, and the temporary file
    for (int i = 0; i < 20'000 && folder.files() < with_its_own; ++i)
        usleep(1000);
    EXPECT_EQ(folder.files(), with_its_own);
    child.signal(GetParam());
    EXPECT_EQ(child.wait(), -GetParam()) << "the signal ends it";
    EXPECT_EQ(contents(messages), "");
    EXPECT_EQ(folder.files(), with_its_own - 1);
}

/// A motion of a study that would take years ends soon after the signal.
TEST_P(Interrupt, EndsALongMotionOfAStudy) {
    const Folder folder;
    const std::string study = folder / "stiff.toml", results = folder / "results", messages = folder / "messages";
    std::ofstream(study) << "name = \"stiff\"\nmodel = \"electromagnetic-testbed\"\nset = { R = 1.41e12 }\n"
                            "[runs.a]\nkind = \"simulate\"\ntime = 0.01\n";
    StartedProcess child({"run", study, "--output", results}, messages);
    for (int i = 0; i < 60'000 && !std::filesystem::exists(results + "/results.sqlite"); ++i)
        usleep(1000);
    usleep(300'000); // so that the motion has begun; the test holds even if it has not
    child.signal(GetParam());
    std::optional<int> code;
    for (int i = 0; i < 60'000 && !(code = child.ended()); ++i)
        usleep(1000);
    ASSERT_TRUE(code.has_value()) << "a minute later it still runs";
    EXPECT_EQ(*code, GetParam() == SIGINT ? exit_interrupted : exit_terminated);
    EXPECT_THAT(contents(messages), ::testing::HasSubstr("graze: interrupted"));
}

INSTANTIATE_TEST_SUITE_P(Signals, Interrupt, ::testing::Values(SIGINT, SIGTERM));
INSTANTIATE_TEST_SUITE_P(Signals, EndingSignal,
                         ::testing::Values(SIGINT, SIGTERM, SIGHUP, SIGQUIT, SIGPIPE, SIGALRM, SIGUSR1, SIGXCPU));

} // namespace graze::testing::interrupt_test
