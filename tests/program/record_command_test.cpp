#include "graze/study/runner.hpp"
#include "run_graze.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <fmt/format.h>
#include <optional>

namespace graze::testing::record_command_test {

using ::testing::HasSubstr;

const double turn = 2 * std::acos(-1.0);

/// A record of a sine with amplitude `size` and a period of 1 s, and of a velocity that jumps from 1 to -0.8 in each
/// period.
std::string record_text(double size) {
    std::string text = "t [s], V [V], v [mm/s]\n";
    for (int i = 0; i < 6000; ++i) {
        const double t = i / 1000.0, part = t - std::floor(t);
        text += std::to_string(t) + "," + std::to_string(size * std::sin(turn * t - 1)) + "," +
                std::to_string(-0.8 + 1.8 * part) + "\n";
    }
    return text;
}

class RecordCommand : public ::testing::Test {
protected:
    std::string file(const std::string& name, double size = 2) const {
        std::ofstream(folder / name) << record_text(size);
        return folder / name;
    }
    const Folder folder;
};

TEST_F(RecordCommand, DescribesChannels) {
    const Csv table(done("record " + file("run.csv") + " --format csv"));
    ASSERT_EQ(table.rows.size(), 2U);
    EXPECT_EQ(table.text(1, "channel"), "v");
    EXPECT_EQ(table.text(1, "unit"), "mm/s");
    EXPECT_EQ(table.number(0, "samples"), 6000);
    EXPECT_NEAR(table.number(0, "greatest"), 2, 1e-5);
    EXPECT_NEAR(table.number(0, "deviation"), std::sqrt(2.0), 1e-3);
    EXPECT_NEAR(table.number(0, "longest_step"), 0.001, 1e-9);
}

TEST_F(RecordCommand, SectionsOfSeveralRecordsHaveTheirAmplitudes) {
    const Csv table(done("record " + file("one.csv", 2) + " " + file("two.csv", 3) +
                         " --what sections --reference V --phase 0.25 --negate V --format csv"));
    ASSERT_EQ(table.rows.size(), 20U); // five periods, two records, with images
    EXPECT_NEAR(table.number(0, "V_amplitude"), 2, 1e-5);
    EXPECT_NEAR(table.number(19, "V_amplitude"), 3, 1e-5);
    EXPECT_EQ(table.text(19, "file"), folder / "two.csv");
    EXPECT_EQ(table.text(1, "image"), "yes");
    EXPECT_NEAR(table.number(0, "V"), 2, 1e-5);
    EXPECT_NEAR(table.number(1, "V"), 2, 1e-5) << "of -2 half a period later";
    EXPECT_NEAR(table.number(1, "time") - table.number(0, "time"), 0.5, 1e-5);
}

TEST_F(RecordCommand, TablesFollowTheClosedForm) {
    const std::string run = file("run.csv");
    const Csv periods(run_graze("record " + run + " --what periods --reference V --format csv").out);
    ASSERT_EQ(periods.rows.size(), 5U);
    EXPECT_NEAR(periods.number(3, "begin"), 3 + 1 / turn, 1e-5);
    EXPECT_NEAR(periods.number(3, "duration"), 1, 1e-5);
    EXPECT_NEAR(periods.number(3, "V_amplitude"), 2, 1e-5);
    const Csv extremes(run_graze("record " + run + " --what extremes --reference V --channel v --format csv").out);
    EXPECT_NEAR(extremes.number(0, "v_greatest"), 0.9982, 1e-4);
    EXPECT_NEAR(extremes.number(0, "v_peak_to_peak"), 1.7982, 1e-4);
    const Csv impacts(run_graze("record " + run + " --what impacts --channel v --format csv").out);
    ASSERT_EQ(impacts.rows.size(), 5U);
    EXPECT_NEAR(impacts.number(1, "time"), 2, 1e-3);
    EXPECT_NEAR(impacts.number(1, "ratio"), 0.8, 3e-3) << "at the middle of two samples";
    const Csv spectrum(run_graze("record " + run + " --what spectrum --channel V --format csv").out);
    ASSERT_EQ(spectrum.rows.size(), 3000U);
    EXPECT_NEAR(spectrum.number(5, "frequency"), 1, 1e-6);
    EXPECT_NEAR(spectrum.number(5, "amplitude"), 2, 1e-5);
    const Printed json = run_graze("record " + run + " --what samples --from 1 --to 1.01 --format json");
    EXPECT_TRUE(JsonCheck(json.out).valid());
    EXPECT_EQ(json.code, 0);
}

TEST_F(RecordCommand, WritesAProcessedRecord) {
    const std::string run = file("run.csv"), to = folder / "slow.h5";
    done("record " + run + " --scale V=1e3-5:mV --every 5 --derivative V --write " + to);
    const Csv table(run_graze("record " + to + " --format csv").out);
    ASSERT_EQ(table.rows.size(), 4U);
    EXPECT_EQ(table.text(0, "unit"), "mV");
    EXPECT_NEAR(table.number(0, "greatest"), 1995, 0.1);
    EXPECT_EQ(table.text(1, "channel"), "V_rate");
    EXPECT_NEAR(table.number(1, "greatest"), 2000 * turn, 1);
    EXPECT_EQ(run_graze("record " + run + " --write " + run).code, 2) << "onto itself";
}

TEST_F(RecordCommand, FindsWhatARunOfAStudyFindsToTheBit) {
    const std::string run = file("run.csv");
    std::ofstream(folder / "s.toml") << R"(name = "s"
[runs.all]
kind = "record"
files = "run.csv"
reference = "V"
[runs.all.sample]
quarter = { section = 0.25 }
image = { section = 0.25, image = ["V"] }
span = { peak_to_peak = true }
size = { amplitude = true }
hits = { impacts = "v", window = 20 }
)";
    ResultFile results(folder / "out.sqlite", ResultFile::Access::write);
    ASSERT_TRUE(run_study(read_study(folder / "s.toml"), results, {}).at(0).complete());
    const auto point = results.point("all", 0);
    ASSERT_TRUE(point);
    const SampleSet& samples = point->result.samples;
    /// Of one sampling the times, and those of one value: V or v.
    const auto column = [&](std::size_t sampling, std::optional<std::size_t> value) {
        std::vector<double> found;
        for (std::size_t s = 0; s < samples.size(); ++s)
            if (samples.samplings[s] == sampling)
                found.push_back(value ? samples.values[2 * s + *value] : samples.times[s]);
        return found;
    };
    /// Rows of the command whose cell is that text, or all.
    const auto told = [&](const std::string& what, const std::string& name, const std::string& image = "") {
        const Csv table(run_graze("record " + run + " --what " + what + " --format csv").out);
        std::vector<double> found;
        for (std::size_t row = 0; row < table.rows.size(); ++row)
            if (image.empty() || table.text(row, "image") == image)
                found.push_back(table.number(row, name));
        return found;
    };
    const std::string sections = "sections --reference V --phase 0.25 --negate V",
                      hits = "impacts --channel v --window 20";
    EXPECT_EQ(told(sections, "time", "no"), column(0, std::nullopt));
    EXPECT_EQ(told(sections, "V", "no"), column(0, 0));
    EXPECT_EQ(told(sections, "V", "yes"), column(1, 0));
    EXPECT_EQ(told(sections, "v", "yes"), column(1, 1));
    EXPECT_EQ(told(sections, "V_amplitude", "no").front(), point->coordinates.at(0));
    EXPECT_EQ(told("extremes --reference V", "v_peak_to_peak"), column(2, 1));
    EXPECT_EQ(told("periods --reference V", "V_amplitude"), column(3, 0));
    EXPECT_EQ(told(hits, "time"), column(4, std::nullopt));
    EXPECT_EQ(told(hits, "before"), column(4, 1));
    EXPECT_EQ(told(hits, "after"), column(5, 1));
    EXPECT_EQ(column(0, 0).size(), 5U);
}

TEST_F(RecordCommand, DrawsTables) {
    if (std::system("command -v gnuplot > /dev/null") != 0)
        GTEST_SKIP() << "no gnuplot";
    const std::string run = file("run.csv"), picture = folder / "picture.svg";
    for (const std::string what : {"channels", "sections --reference V", "impacts --channel v"}) {
        done("record " + run + " --what " + what + " --plot " + picture);
        EXPECT_THAT(contents(picture), HasSubstr("</svg>"));
        std::filesystem::remove(picture);
    }
}

// Differences of such values overflow, and their ratios underflow: they are refused before drawing.
TEST_F(RecordCommand, RefusesToDrawExtremeNumbers) {
    if (std::system("command -v gnuplot > /dev/null") != 0)
        GTEST_SKIP() << "no gnuplot";
    const std::string picture = folder / "picture.svg";
    for (const std::string_view values : {"9e307,-9e307,9e307", "1.7e308,-1.7e308,0", "1e-310,2e-310,0",
                                          "1e-310,1.7e308,-1e-310", "1e300,1e300,1e300"}) {
        std::string text = "t [s], v [m/s]\n";
        int row = 0;
        for (std::size_t at = 0; at < values.size(); ++row) {
            const std::size_t end = std::min(values.find(',', at), values.size());
            text += fmt::format("{},{}\n", row, values.substr(at, end - at));
            at = end + 1;
        }
        std::ofstream(folder / "large.csv") << text;
        expect_refusal("record " + (folder / "large.csv") + " --what samples --plot " + picture, "the axis 'v' from");
        EXPECT_FALSE(std::filesystem::exists(picture));
    }
    EXPECT_EQ(folder.files(), 1U) << "parts of pictures are left";
}

TEST_F(RecordCommand, MistakesAreOneLineWithARemedy) {
    const std::string run = file("run.csv");
    std::ofstream(folder / "header.csv") << "t [s], V [V]\n";
    std::ofstream(folder / "two.csv") << std::string("\xff\xfet\0,\0v\0\n\0", 10);
    std::ofstream(folder / "wrong.csv") << "t [s], V [V], v [mm/s]\n0,1,2\n1,one,2\n";
    const std::vector<std::pair<std::string, std::string>> mistakes{
        {folder / "none.csv", "none.csv: the record cannot be read"},
        {folder / "wrong.csv", "wrong.csv:3:3: 'one' is not a finite number"},
        {run + " " + (folder / "wrong.csv"), "wrong.csv:3:3: 'one'"},
        {run + " --what sections", "name the channel of the input by --reference"},
        {run + " --what sections --reference W", "--reference: the record has no channel 'W'"},
        {run + " --what sections --reference V --level 7", "does not rise through 7 twice"},
        {run + " --what sections --reference V --phase 1", "--phase 1: it is no part of a period"},
        {run + " --phase 0.5", "--phase has no effect without --what"},
        {run + " --what impacts", "name it by --channel"},
        {run + " --what impact", "did you mean 'impacts'?"},
        {run + " --what impacts --channel v --phase 0.5", "--phase has no effect beside --what impacts"},
        {run + " --scale v", "write NAME=FACTOR"},
        {run + " --scale y=2 --what samples", "--scale: the record has no channel 'y'"},
        {run + " --derivative y --write " + (folder / "w.csv"), "--derivative: the record has no channel 'y'"},
        {run + " --scale v=2x", "'2x' is no number"},
        {run + " --pass 1e9", "cannot be resolved"},
        {run + " --what samples --from 2 --to 1", "give the earlier one first"},
        {run + " --write " + (folder / "no/such.csv"), "cannot be written"},
        {folder / "header.csv", "header.csv: the record has no rows"},
        {(folder / "header.csv") + " --what samples --plot " + (folder / "none.svg"),
         "header.csv: the record has no rows"},
        {(folder / "header.csv") + " --write " + (folder / "none.csv"), "header.csv: the record has no rows"},
        {run + " --what samples --from 1e9", "run.csv: the record has no rows"},
        {folder / "two.csv", "two.csv:1:1: this text is in UTF-16"},
        {run + " --columns t,v", "the file has a header of its own"},
    };
    for (const auto& [line, message] : mistakes)
        expect_refusal("record " + line, message);
}

} // namespace graze::testing::record_command_test
