// The program started by a shell: with closed streams, with a size limit of files, in a folder of another user.

#include "program/standard_streams.hpp"

#include "places.hpp"
#include "run_graze.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>

#include <cstdlib>
#include <fstream>
#include <sys/wait.h>

namespace graze::testing::standard_streams_test {

/// The exit code of a shell command: `before`, the program with `words`, `after`. The caller quotes them.
int exit_code_of(const std::string& before, const std::string& words, const std::string& after) {
    const int status = std::system(fmt::format("{} '{}' {} {}", before, program_file, words, after).c_str());
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

class StandardStreams : public ::testing::Test {
protected:
    /// A record with one incomplete row, which is left out with a message.
    std::string record() const {
        return folder.write("missing.csv", "t,V\n0,1\n1,2\n2,nan\n3,4\n4,2\n5,1\n6,2\n7,1\n8,8\n");
    }
    Folder folder;
};

TEST_F(StandardStreams, MessagesToAClosedStreamReachNoFile) {
    const std::string words = fmt::format("record '{}' --write '{}'", record(), folder / "out.csv");
    EXPECT_EQ(exit_code_of("", words, "2>'" + (folder / "messages") + "'"), 0);
    const std::string told = contents(folder / "out.csv");
    EXPECT_THAT(contents(folder / "messages"), ::testing::HasSubstr("left out"));
    std::filesystem::remove(folder / "out.csv");
    EXPECT_EQ(exit_code_of("", words, "2>&-"), 0);
    EXPECT_EQ(contents(folder / "out.csv"), told);
    std::filesystem::remove(folder / "out.csv");
    EXPECT_EQ(exit_code_of("", words, "<&- 2>&-"), 0);
    EXPECT_EQ(contents(folder / "out.csv"), told);
}

TEST_F(StandardStreams, ATableToAClosedStreamIsReportedAndReachesNoFile) {
    const std::string study = folder.write("s.toml", "name = \"s\"\nmodel = \"bouncing-ball\"\n[runs.r]\nkind = "
                                                     "\"simulate\"\ntime = 1\n");
    const std::string words = fmt::format("run '{}' --output '{}' --no-pictures", study, folder / "results");
    EXPECT_EQ(exit_code_of("", words, ">&- 2>'" + (folder / "messages") + "'"), 2);
    EXPECT_THAT(contents(folder / "messages"), ::testing::HasSubstr("standard output"));
    for (const auto& file : std::filesystem::directory_iterator(folder / "results")) {
        if (file.path().extension() == ".sqlite")
            continue;
        EXPECT_EQ(std::filesystem::file_size(file.path()), 0U) << file.path();
    }
}

TEST_F(StandardStreams, FilesBeyondTheSizeLimitAreReportedAndRemoved) {
    const std::string words =
        fmt::format("simulate bouncing-ball --time 100 --samples 3000 --format csv --output '{}'", folder / "out.csv");
    EXPECT_EQ(exit_code_of("ulimit -f 8;", words, "2>'" + (folder / "messages") + "'"), 2);
    EXPECT_THAT(contents(folder / "messages"), ::testing::HasSubstr("out.csv"));
    EXPECT_EQ(folder.files(), 1U) << "the messages alone";
}

/// Libraries must be loaded from folders of the system, never from the current one: an unpacked archive may contain
/// files with their names.
TEST_F(StandardStreams, NoLibraryIsLoadedFromTheCurrentFolder) {
    if (std::system("command -v readelf >/dev/null") != 0)
        GTEST_SKIP() << "readelf is missing";
    const std::string dynamic = folder / "dynamic";
    ASSERT_EQ(std::system(fmt::format("readelf -d '{}' >'{}'", program_file, dynamic).c_str()), 0);
    std::ifstream lines(dynamic);
    std::size_t needed = 0;
    for (std::string line; std::getline(lines, line);) {
        needed += line.find("(NEEDED)") != std::string::npos ? 1 : 0;
        if (line.find("PATH)") == std::string::npos)
            continue;
        const std::size_t begin = line.find('[') + 1;
        std::string paths = line.substr(begin, line.find(']') - begin) + ':';
        for (std::size_t colon = 0; (colon = paths.find(':')) != std::string::npos; paths.erase(0, colon + 1)) {
            const std::string path = paths.substr(0, colon);
            EXPECT_TRUE(path.starts_with('/') || path.starts_with("$ORIGIN")) << line;
        }
    }
    EXPECT_GT(needed, 0U);
}

} // namespace graze::testing::standard_streams_test
