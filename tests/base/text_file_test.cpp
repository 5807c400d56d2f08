#include "graze/base/text_file.hpp"

#include "base/message_of.hpp"
#include "base/temporary_folder.hpp"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <filesystem>

namespace graze::text_file_test {

std::string refusal(const std::string& path, std::size_t most = 1000) {
    return testing::message_of([&] { read_text_file(path, "model file", most); });
}

TEST(TextFile, ReadsOnlyRegularFiles) {
    const testing::TemporaryFolder folder;
    const std::string pipe = folder / "pipe", link = folder / "link",
                      file = folder.write("file", std::string(1000, 'x'));
    ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
    std::filesystem::create_symlink(pipe, link);
    EXPECT_EQ(read_text_file(file, "model file", 1000), std::string(1000, 'x'));
    EXPECT_NE(refusal(file, 999).find("more than 999 bytes"), std::string::npos);
    EXPECT_NE(refusal(pipe).find("a pipe, not a model file"), std::string::npos);
    EXPECT_NE(refusal(link).find("a pipe"), std::string::npos);
    EXPECT_NE(refusal("/dev/zero").find("a device"), std::string::npos);
    EXPECT_NE(refusal(folder.path()).find("a directory"), std::string::npos);
    EXPECT_NE(refusal(folder / "none").find("cannot be read"), std::string::npos);
    EXPECT_NE(refusal(std::string("/tmp\0x", 6)).find("cannot be read"), std::string::npos);
    EXPECT_NE(refusal(std::string(10'000, 'x')).find("cannot be read"), std::string::npos);
}

} // namespace graze::text_file_test
