// Promises of docs/security.md that no other test checks; tests/documentation/promises.txt lists all.

#include "graze/record/record_writer.hpp"
#include "run_graze.hpp"

#include <gmock/gmock.h>

namespace graze::testing::promises_test {

using ::testing::HasSubstr;

TEST(Promises, ResultFilesAreNotWrittenThroughLinks) {
    const Folder folder;
    const std::string study = folder.write("s.toml", "name = \"s\"\nmodel = \"bouncing-ball\"\n[runs.r]\nkind = "
                                                     "\"simulate\"\ntime = 1\n");
    for (const char* name : {"results.sqlite", "results.sqlite.lock"}) {
        const std::string out = folder / (std::string("of-") + name), precious = folder.write("precious", "precious");
        std::filesystem::create_directory(out);
        for (const std::string& target : {precious, folder / "new"}) {
            const std::string link = out + "/" + name;
            std::filesystem::remove(link);
            std::filesystem::create_symlink(target, link);
            const Printed printed = run_graze({"run", study, "--output", out, "--no-pictures"});
            EXPECT_EQ(printed.code, 2) << link;
            EXPECT_EQ(std::count(printed.err.begin(), printed.err.end(), '\n'), 1) << printed.err;
        }
        EXPECT_EQ(contents(precious), "precious");
        EXPECT_FALSE(std::filesystem::exists(folder / "new"));
    }
}

/// Sparse files, which take no space on the disk.
TEST(Promises, TextFilesHaveASizeLimit) {
    const Folder folder;
    const std::string model = folder / "m.toml", table = folder / "o.csv";
    for (const std::string& path : {model, table})
        std::ofstream(path) << "x";
    std::filesystem::resize_file(model, (std::uintmax_t{16} << 20) + 1);
    std::filesystem::resize_file(table, (std::uintmax_t{256} << 20) + 1);
    for (const std::vector<std::string>& words : std::vector<std::vector<std::string>>{
             {"check", model}, {"run", model}, {"design", model}, {"acquire", model}, {"layout", model}}) {
        expect_refusal(words, "16777216 bytes");
    }
    const std::string study = folder.write("s.toml", "name = \"s\"\nmodel = \"bouncing-ball\"\n[runs.r]\nkind = "
                                                     "\"orbit\"\ntable = \"o.csv\"\n");
    EXPECT_THAT(run_graze({"run", study, "--output", folder / "out", "--no-pictures"}).err,
                HasSubstr("268435456 bytes"));
}

TEST(Promises, TablesOfRecordsHaveASizeLimit) {
    const Folder folder;
    const std::string path = folder / "r.h5";
    {
        RecordWriter writer(path, {{"t", "s"}, {{"x", ""}}});
        Samples samples;
        samples.values.resize(1);
        for (int i = 0; i < 4'200'000; ++i) {
            samples.times.push_back(i);
            samples.values[0].push_back(i < 10 ? 0 : 1); // rises only once, so that its period does not end
        }
        writer.write(samples);
        writer.close();
    }
    const std::vector<std::pair<std::vector<std::string>, const char*>> cases{
        {{"--what", "samples"}, "more than 2000000 rows"},
        {{"--what", "spectrum", "--channel", "x"}, "more than 4000000 samples"},
        {{"--what", "periods", "--reference", "x", "--level", "0.5"}, "for more than 4000000 samples"}};
    for (const auto& [options, problem] : cases) {
        std::vector<std::string> words{"record", path};
        words.insert(words.end(), options.begin(), options.end());
        expect_refusal(words, problem);
    }
}

} // namespace graze::testing::promises_test
