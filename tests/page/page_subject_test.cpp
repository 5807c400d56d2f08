#include "page/page_subject.hpp"

#include "base/temporary_folder.hpp"
#include "graze/base/input_error.hpp"
#include "graze/results/result_file.hpp"

#include <gtest/gtest.h>

namespace graze {
namespace {

TEST(PageSubject, TellsFilesByWhatIsInThem) {
    const testing::TemporaryFolder folder;
    const std::string study = folder.write("a.toml", "name = \"a\"\n[runs.b]\n");
    const std::string model = folder.write("b.toml", "name = \"b\"\n");
    { const ResultFile made(folder / "results.sqlite", ResultFile::Access::write); }
    EXPECT_EQ(page_subject(study).kind, PageSubject::Kind::study);
    EXPECT_EQ(page_subject(study).text, "name = \"a\"\n[runs.b]\n");
    EXPECT_EQ(page_subject(model).kind, PageSubject::Kind::model);
    EXPECT_EQ(page_subject(folder / "results.sqlite").kind, PageSubject::Kind::results);
    EXPECT_EQ(page_subject(folder.path()).path, folder / "results.sqlite");
}

TEST(PageSubject, KnowsWhatComesWithGraze) {
    EXPECT_EQ(page_subject("microbeam").kind, PageSubject::Kind::study);
    EXPECT_EQ(page_subject("microbeam", true).kind, PageSubject::Kind::model);
    EXPECT_EQ(page_subject("bouncing-ball").kind, PageSubject::Kind::model);
    EXPECT_EQ(page_subject("microbeam-3").kind, PageSubject::Kind::model);
    EXPECT_EQ(page_subject("bouncing-ball").path, "");
    EXPECT_NE(page_subject("bouncing-ball").text, "");
}

TEST(PageSubject, SaysWhatIsMissing) {
    const testing::TemporaryFolder folder;
    const auto refused = [](const std::string& given, const std::string& part) {
        try {
            page_subject(given);
            ADD_FAILURE() << given;
        } catch (const InputError& error) {
            EXPECT_NE(std::string(error.what()).find(part), std::string::npos) << error.what();
        }
    };
    refused(folder.path(), "there are no results in this folder");
    refused(folder / "no.toml", "no.toml");
    refused("bouncing-bal", "bouncing-ball");
    refused(folder.write("wrong.toml", "[[["), "wrong.toml");
    refused(folder.write("picture.png", std::string("\x89PNG\r\n\x1a\n\0\0\0\rIHDR", 16)), "this is not a text file");
}

} // namespace
} // namespace graze
