// A disk that becomes full at any point of the output: one message, exit code 2, and no incomplete file.

#include "graze/record/record_writer.hpp"
#include "run_graze.hpp"
#include "separate_run.hpp"

#include <gmock/gmock.h>

#include <cmath>

namespace graze::testing::full_disk_test {

constexpr const char* study = R"(
name = "small"
model = "impact-oscillator"
values = ["x", "v"]
[runs.motion]
kind = "simulate"
periods = 200
sample = { high = { maxima = "x" }, low = { minima = "x" } }
)";

class FullDisk : public ::testing::Test {
protected:
    FullDisk() {
        RecordWriter writer(folder / "r.csv", {{"t", "s"}, {{"x", "mm"}}});
        Samples samples;
        samples.values.resize(1);
        for (int i = 0; i < 20'000; ++i) {
            samples.times.push_back(i * 0.01);
            samples.values[0].push_back(std::sin(i * 0.01));
        }
        writer.write(samples);
        writer.close();
        std::filesystem::create_directory(folder / "out");
    }

    /// Runs a command, which writes the file `OUT`, with several size limits below the size of that file.
    void refuse(std::vector<std::string> words, const std::string& name) {
        const std::string out = folder / "out/" + name;
        for (std::string& word : words)
            if (word == "OUT")
                word = out;
        std::ofstream(out) << "old";
        for (const std::size_t size : {1, 100, 512, 2048, 4096, 8192}) {
            SeparateRunLimits limits;
            limits.file_size = size;
            const SeparateRun run = run_separately(words, limits);
            EXPECT_EQ(run.code, 2) << ::testing::PrintToString(words) << size << run.err;
            EXPECT_EQ(run.signal, 0) << ::testing::PrintToString(words) << size;
            EXPECT_EQ(std::count(run.err.begin(), run.err.end(), '\n'), 1) << run.err;
            EXPECT_THAT(run.err, ::testing::HasSubstr(out)) << "the message names the file";
            EXPECT_EQ(contents(out), "old") << ::testing::PrintToString(words) << size;
            EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder / "out"), {}), 1)
                << ::testing::PrintToString(words) << size;
        }
        EXPECT_EQ(run_graze(words).code, 0) << ::testing::PrintToString(words);
        EXPECT_GT(std::filesystem::file_size(out), 8192U) << ::testing::PrintToString(words);
        std::filesystem::remove(out);
    }

    Folder folder;
};

TEST_F(FullDisk, RecordsAreWrittenWholeOrNotAtAll) {
    for (const char* name : {"w.h5", "w.csv"})
        refuse({"record", folder / "r.csv", "--write", "OUT"}, name);
    for (const char* format : {"csv", "json", "table"})
        refuse({"record", folder / "r.csv", "--what", "samples", "--format", format, "--output", "OUT"}, "samples");
}

TEST_F(FullDisk, ResultsAreExportedWholeOrNotAtAll) {
    const std::string path = folder.write("study.toml", study);
    done({"run", path, "--output", folder / "results", "--quiet", "--no-pictures"});
    refuse({"export", folder / "results", "--format", "hdf5", "--output", "OUT"}, "x.h5");
    for (const char* format : {"csv", "json", "table"})
        refuse({"export", folder / "results", "--what", "samples", "--format", format, "--output", "OUT"}, "x");
}

TEST_F(FullDisk, TablesAndDrawingsAreWrittenWholeOrNotAtAll) {
    refuse({"simulate", "bouncing-ball", "--time", "1", "--output", "OUT"}, "t.txt");
    refuse({"layout", "mems-switch-device", "--output", "OUT", "--format", "csv"}, "d.gds");
}

} // namespace graze::testing::full_disk_test
