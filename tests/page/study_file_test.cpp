#include "page/study_file.hpp"

#include "base/temporary_folder.hpp"
#include "page/error_answer.hpp"
#include "page/short_files.hpp"

#include <sys/stat.h>

#include <gtest/gtest.h>

#include <filesystem>

namespace graze {
namespace {

using testing::contents;

TEST(StudyFile, SavesAsAWholeAndKeepsPermissions) {
    const testing::TemporaryFolder folder;
    const std::string path = folder.write("a.toml", "one");
    ASSERT_EQ(::chmod(path.c_str(), 0640), 0);
    StudyFile file(path, "one");
    file.save("two", false);
    EXPECT_EQ(contents(path), "two");
    EXPECT_EQ(file.text(), "two");
    struct stat status {};
    ::stat(path.c_str(), &status);
    EXPECT_EQ(status.st_mode & 0777U, 0640U);
    EXPECT_EQ(folder.files(), 1U) << "no temporary file is left";
    EXPECT_FALSE(file.look());
}

TEST(StudyFile, OverwritesNobodysChanges) {
    const testing::TemporaryFolder folder;
    const std::string path = folder.write("a.toml", "one");
    StudyFile file(path, "one");
    folder.write("a.toml", "other");
    EXPECT_THROW(file.save("two", false), RefusedRequest);
    EXPECT_EQ(contents(path), "other");
    file.save("two", true);
    EXPECT_EQ(contents(path), "two");
    std::filesystem::remove(path);
    EXPECT_THROW(file.save("three", false), RefusedRequest);
    EXPECT_FALSE(std::filesystem::exists(path));
}

TEST(StudyFile, NoticesChanges) {
    const testing::TemporaryFolder folder;
    StudyFile file(folder.write("a.toml", "one"), "one");
    folder.write("a.toml", "longer");
    EXPECT_TRUE(file.look());
    EXPECT_EQ(file.text(), "longer");
    EXPECT_FALSE(file.look());
}

TEST(StudyFile, SavesWhereALinkLeads) {
    const testing::TemporaryFolder folder, elsewhere;
    const std::string path = elsewhere.write("real.toml", "one");
    std::filesystem::create_symlink(path, folder / "link.toml");
    StudyFile file(folder / "link.toml", "one");
    file.save("two", false);
    EXPECT_EQ(contents(path), "two");
    EXPECT_TRUE(std::filesystem::is_symlink(folder / "link.toml"));
}

TEST(StudyFile, KnowsWhetherItIsThere) {
    const testing::TemporaryFolder folder;
    const std::string path = folder.write("a.toml", "one");
    const StudyFile file(path, "one");
    EXPECT_TRUE(file.is_there());
    std::filesystem::remove(path);
    EXPECT_FALSE(file.is_there());
    ASSERT_EQ(::mkfifo(path.c_str(), 0600), 0);
    EXPECT_FALSE(file.is_there());
    EXPECT_FALSE(StudyFile().is_there());
}

TEST(StudyFile, AsksForRoomWhereThereIsNone) {
    const testing::TemporaryFolder folder;
    const std::string path = folder.write("a.toml", "one");
    StudyFile file(path, "one");
    std::string remedy;
    {
        const testing::ShortFiles limit(8);
        try {
            file.save("more than eight letters", false);
        } catch (const InputError& error) {
            remedy = error.remedy();
        }
    }
    EXPECT_EQ(remedy, "make room on the disk, and save again");
    EXPECT_EQ(contents(path), "one");
    EXPECT_EQ(folder.files(), 1U);
}

TEST(StudyFile, TakesPlainNewNamesOnly) {
    const testing::TemporaryFolder folder, elsewhere;
    StudyFile file;
    for (const char* name : {"", "a", "a.txt", "../a.toml", "/a.toml", "b/a.toml", ".toml", "-a.toml", "a\n.toml"})
        EXPECT_THROW(file.save_as("text", folder.path(), name), InputError) << name;
    folder.write("there.toml", "mine");
    EXPECT_THROW(file.save_as("text", folder.path(), "there.toml"), RefusedRequest);
    EXPECT_EQ(contents(folder / "there.toml"), "mine");
    std::filesystem::create_symlink(elsewhere / "out.toml", folder / "link.toml");
    EXPECT_THROW(file.save_as("text", folder.path(), "link.toml"), InputError);
    EXPECT_EQ(elsewhere.files(), 0U);
    EXPECT_FALSE(file.exists());
    StudyFile().save_as("text", folder / "new folder", "new.toml");
    EXPECT_EQ(contents(folder / "new folder/new.toml"), "text");
    file.save_as("text", folder.path(), "new.toml");
    EXPECT_EQ(contents(folder / "new.toml"), "text");
    file.save("more", false);
    EXPECT_EQ(contents(folder / "new.toml"), "more");
}

} // namespace
} // namespace graze
