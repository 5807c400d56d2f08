#include "graze/base/text_file.hpp"

#include "graze/base/input_error.hpp"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <filesystem>
#include <fstream>

namespace graze {
namespace {

std::string refusal(const std::string& path, std::size_t most = 1000) {
    try {
        read_text_file(path, "model file", most);
    } catch (const InputError& error) {
        return error.what();
    }
    return "";
}

TEST(TextFile, ReadsOnlyRegularFiles) {
    const auto folder = std::filesystem::temp_directory_path() / ("graze-text-file-" + std::to_string(getpid()));
    std::filesystem::create_directories(folder);
    const std::string pipe = folder / "pipe", link = folder / "link", file = folder / "file";
    ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
    std::filesystem::create_symlink(pipe, link);
    std::ofstream(file) << std::string(1000, 'x');
    EXPECT_EQ(read_text_file(file, "model file", 1000), std::string(1000, 'x'));
    EXPECT_NE(refusal(file, 999).find("more than 999 bytes"), std::string::npos);
    EXPECT_NE(refusal(pipe).find("a pipe, not a model file"), std::string::npos);
    EXPECT_NE(refusal(link).find("a pipe"), std::string::npos);
    EXPECT_NE(refusal("/dev/zero").find("a device"), std::string::npos);
    EXPECT_NE(refusal(folder).find("a directory"), std::string::npos);
    EXPECT_NE(refusal(folder / "none").find("cannot be read"), std::string::npos);
    EXPECT_NE(refusal(std::string("/tmp\0x", 6)).find("cannot be read"), std::string::npos);
    EXPECT_NE(refusal(std::string(10'000, 'x')).find("cannot be read"), std::string::npos);
    std::filesystem::remove_all(folder);
}

} // namespace
} // namespace graze
