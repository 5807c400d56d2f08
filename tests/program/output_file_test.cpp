#include "program/output_file.hpp"

#include "graze/base/input_error.hpp"
#include "run_graze.hpp"

#include <gmock/gmock.h>

namespace graze::testing::output_file_test {

using std::filesystem::perms;

perms permissions_of(const std::string& path) {
    return std::filesystem::status(path).permissions();
}

TEST(OutputFile, ReplacesTheWholeFileOrNothing) {
    const Folder folder;
    const std::string path = folder / "table.csv";
    write_file(path, "old and long");
    {
        const FileReplacement abandoned(path);
        std::ofstream(abandoned.temporary_path()) << "half";
        EXPECT_TRUE(abandoned.temporary_path().ends_with(".csv"));
    }
    EXPECT_EQ(contents(path), "old and long");
    write_file(path, "new");
    EXPECT_EQ(contents(path), "new");
    EXPECT_EQ(folder.files(), 1U);
}

TEST(OutputFile, KeepsPermissions) {
    const Folder folder;
    const std::string path = folder / "private.csv";
    write_file(path, "old");
    for (const perms permissions : {perms(0600), perms(0664)}) {
        std::filesystem::permissions(path, permissions);
        write_file(path, "new");
        EXPECT_EQ(permissions_of(path), permissions);
    }
}

TEST(OutputFile, FollowsLinks) {
    const Folder folder;
    const std::string path = folder / "table.csv", link = folder / "link";
    write_file(path, "old");
    std::filesystem::create_symlink("table.csv", link);
    write_file(link, "new");
    EXPECT_TRUE(std::filesystem::is_symlink(link));
    EXPECT_EQ(contents(path), "new");
}

/// Other users may write to the same folder.
TEST(OutputFile, TemporaryNamesAreNotForeseeable) {
    const Folder folder;
    const std::string path = folder / "table.csv";
    const FileReplacement one(path), other(path);
    EXPECT_NE(one.temporary_path(), other.temporary_path());
    EXPECT_EQ(one.temporary_path().find(std::to_string(getpid())), std::string::npos);
    for (const FileReplacement* file : {&one, &other})
        EXPECT_TRUE(std::filesystem::is_regular_file(std::filesystem::symlink_status(file->temporary_path())));
}

TEST(OutputFile, AReplacedTemporaryFileIsNotUsed) {
    const Folder folder;
    const std::string path = folder / "table.csv", precious = folder.write("precious", "precious");
    write_file(path, "old");
    FileReplacement file(path);
    std::filesystem::remove(file.temporary_path());
    std::filesystem::create_symlink(precious, file.temporary_path());
    file.write("new");
    EXPECT_EQ(contents(precious), "precious");
    EXPECT_THROW(file.commit(), InputError);
    EXPECT_EQ(contents(path), "old");
}

TEST(OutputFile, NamesMayBeAsLongAsTheSystemTakes) {
    const Folder folder;
    const std::string path = folder / (std::string(251, 'a') + ".csv");
    write_file(path, "new");
    EXPECT_EQ(contents(path), "new");
    EXPECT_THROW(write_file(folder / (std::string(252, 'a') + ".csv"), "new"), InputError);
    EXPECT_EQ(folder.files(), 1U);
}

TEST(OutputFile, RefusesUnwritablePaths) {
    const Folder folder;
    EXPECT_THROW(require_writable(""), InputError);
    EXPECT_THROW(require_writable(folder / "."), InputError);
    EXPECT_THROW(require_writable(folder / "missing/table.csv"), InputError);
    EXPECT_THROW(write_file("/dev/full", "x"), InputError);
    EXPECT_NO_THROW(write_file("/dev/null", "x"));
    EXPECT_EQ(folder.files(), 0U);
}

} // namespace graze::testing::output_file_test
