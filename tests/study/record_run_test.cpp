// Records in studies against closed forms: what is taken from them, what is kept, what is refused, and what becomes of
// runs that are broken off.

#include "graze/model/catalogue.hpp"
#include "graze/results/stored_run.hpp"
#include "graze/study/stored_study.hpp"

#include "study_fixture.hpp"
#include "wave_records.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <cmath>
#include <filesystem>
#include <numbers>

namespace graze::record_run_test {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

using testing::waves;

constexpr double frequency = testing::wave_frequency;
constexpr const char* head = testing::record_head;

class RecordRunTest : public testing::StudyFixture {
protected:
    std::string study_file(const std::string& text) const { return folder_.write("s.toml", text); }
    /// Times and values of one sampling of a point: time, values, time, ...
    std::vector<std::vector<double>> samples(const std::string& sampling, std::size_t number = 0) const {
        const ResultFile file(path_, ResultFile::Access::read);
        const auto stored = file.find_run("r");
        const SampleSet set = file.point("r", number)->result.samples;
        std::vector<std::vector<double>> rows;
        for (std::size_t s = 0; s < set.size(); ++s)
            if (stored->samplings[set.samplings[s]] == sampling) {
                rows.push_back({set.times[s]});
                for (std::size_t v = 0; v < set.width; ++v)
                    rows.back().push_back(set.values[s * set.width + v]);
            }
        return rows;
    }
    void expect_same_bits(const std::string& other) const {
        EXPECT_EQ(testing::bits_of(ResultFile(path_, ResultFile::Access::read)),
                  testing::bits_of(ResultFile(other, ResultFile::Access::read)));
    }
};

TEST_F(RecordRunTest, SamplesHaveTheirClosedForm) {
    folder_.write("a.csv", waves(2, 2));
    run(std::string(head) + R"(files = "a.csv"
reference = "V"
coordinate = "V0"
values = ["V", "q", "energy = V^2 + (q - 1)^2"]
[runs.r.sample]
all = { record = true }
zero = { section = 0 }
quarter = { section = 0.25 }
image = { section = 0, image = ["q"] }
high = { maxima = "q" }
low = { minima = "q" }
range = { peak_to_peak = true }
size = { amplitude = true }
)");
    // A parabola or a cubic between samples, 200 of them a period: relative errors of about (2 pi/200)^3/20.
    constexpr double interpolation = 3e-6;
    const ResultFile file(path_, ResultFile::Access::read);
    const PointRecord point = *file.point("r", 0);
    ASSERT_EQ(point.coordinates.size(), 1);
    EXPECT_NEAR(point.coordinates[0], 2, 1e-9); // the fit of a sine to a sine
    EXPECT_EQ(point.result.label, Label::ended);
    EXPECT_NEAR(point.result.time, 2, 1e-12);
    const auto zero = samples("zero");
    ASSERT_GE(zero.size(), 8);
    for (const auto& row : zero) {
        EXPECT_NEAR(row[0] * frequency, std::round(row[0] * frequency), 1e-6);
        EXPECT_NEAR(row[1], 0, 2 * interpolation);
        EXPECT_NEAR(row[2], 4, 4 * interpolation);
        EXPECT_NEAR(row[3], 9, 20 * interpolation);
    }
    for (const auto& row : samples("quarter")) {
        EXPECT_NEAR(row[1], 2, 4 * interpolation);
        EXPECT_NEAR(row[2], 1, 4 * interpolation);
    }
    // Half a period later q is -3 + 1, and changes its sign.
    for (const auto& row : samples("image"))
        EXPECT_NEAR(row[2], 2, 4 * interpolation);
    for (const auto& row : samples("high"))
        EXPECT_NEAR(row[2], 4, 4 * interpolation);
    for (const auto& row : samples("low"))
        EXPECT_NEAR(row[2], -2, 4 * interpolation);
    for (const auto& row : samples("range")) {
        EXPECT_NEAR(row[1], 4, 8 * interpolation);
        EXPECT_NEAR(row[2], 6, 8 * interpolation);
    }
    for (const auto& row : samples("size")) {
        EXPECT_NEAR(row[1], 2, 1e-6);
        EXPECT_NEAR(row[2], 3, 1e-6);
    }
    // All rows, with their bits.
    const auto all = samples("all");
    ASSERT_EQ(all.size(), 2001);
    for (std::size_t i = 0; i < all.size(); ++i) {
        const double t = static_cast<double>(i) / 1000;
        EXPECT_EQ(all[i][0], t);
        EXPECT_EQ(all[i][1], 2 * std::sin(2 * std::numbers::pi * frequency * t + 0.0));
    }
}

TEST_F(RecordRunTest, ImpactsHaveVelocitiesBeforeAndAfter) {
    // A ball that is thrown up again and again: 1 m/s after each impact, 10 m/s^2.
    std::string text = "t,v\n";
    for (int i = 0; i < 1000; ++i) {
        const double t = 0.001 * i + 0.0005;
        text += fmt::format("{:.17g},{:.17g}\n", t, 1 - 10 * std::fmod(t, 0.2));
    }
    folder_.write("a.csv", text);
    run(std::string(head) + "files = \"a.csv\"\nsample = { impact = { impacts = \"v\" } }\n");
    const auto before = samples("impact"), after = samples("impact_after");
    ASSERT_EQ(before.size(), 4);
    ASSERT_EQ(after.size(), 4);
    for (std::size_t i = 0; i < before.size(); ++i) {
        EXPECT_NEAR(before[i][0], 0.2 * static_cast<double>(i + 1), 1e-9); // the middle between two samples
        EXPECT_EQ(before[i][0], after[i][0]);
        EXPECT_NEAR(before[i][1], -1, 1e-9); // straight lines, continued
        EXPECT_NEAR(after[i][1], 1, 1e-9);
    }
}

TEST_F(RecordRunTest, OtherChannelsAtImpactsAreThoseOfTheImpactItself) {
    // A ball that loses speed, e = 0.7, with rows at other times than impacts are: it lies at the ground at each.
    const double gravity = 9.81, e = 0.7;
    std::string text = "t [s],q [m],v [m/s],i [A]\n";
    double begin = -0.3, speed = 4; // of the flight that is on
    for (int i = 0; i < 1500; ++i) {
        const double t = 0.001 * i;
        while (t - begin > 2 * speed / gravity)
            begin += 2 * speed / gravity, speed *= e;
        const double s = t - begin;
        text += fmt::format("{:.17g},{:.17g},{:.17g},{:.17g}\n", t, speed * s - 0.5 * gravity * s * s,
                            speed - gravity * s, 1 + t);
    }
    folder_.write("a.csv", text);
    run(std::string(head) + "files = \"a.csv\"\nvalues = [\"q\", \"v\", \"i\", \"v^2\"]\n"
                            "sample = { imp = { impacts = \"v\", displacement = \"q\" } }\n");
    const auto before = samples("imp"), after = samples("imp_after");
    ASSERT_GE(before.size(), 2);
    ASSERT_EQ(before.size(), after.size());
    double touch = -0.3 + 2 * 4 / gravity, fall = 4;
    for (std::size_t i = 0; i < before.size(); ++i) {
        EXPECT_NEAR(before[i][0], touch, 1e-9); // parabolas and lines are continued as they are: rounding is left
        for (const auto* side : {&before, &after}) {
            EXPECT_NEAR((*side)[i][1], 0, 1e-8);
            EXPECT_NEAR((*side)[i][3], 1 + touch, 1e-8);
        }
        EXPECT_NEAR(before[i][2], -fall, 1e-8);
        EXPECT_NEAR(before[i][4], fall * fall, 1e-7);
        fall *= e;
        EXPECT_NEAR(after[i][2], fall, 1e-8);
        EXPECT_NEAR(after[i][4], fall * fall, 1e-7);
        touch += 2 * fall / gravity;
    }
}

TEST_F(RecordRunTest, SamplesAreTakenAfterProcessing) {
    folder_.write("a.csv", waves(2, 1));
    run(std::string(head) + R"(files = "a.csv"
channels = { U = "V", x = "q", slope = "q_rate" }
scale = { V = 0.5, q = { factor = 1e-3, offset = 1, unit = "m" } }
part = [0.25, 0.75]
derivative = "q"
)");
    const auto rows = samples("record");
    ASSERT_GT(rows.size(), 400);
    for (const auto& row : rows) {
        const double angle = 2 * std::numbers::pi * frequency * row[0];
        EXPECT_TRUE(row[0] > 0.25 && row[0] < 0.75);
        EXPECT_NEAR(row[1], std::sin(angle), 1e-12);
        EXPECT_NEAR(row[2], 1.001 + 3e-3 * std::cos(angle), 1e-12);
        // A polynomial of fourth degree over some samples: its error is far below a thousandth of the slope's size.
        EXPECT_NEAR(row[3], -3e-3 * 2 * std::numbers::pi * frequency * std::sin(angle), 1e-5);
    }
    const ResultFile file(path_, ResultFile::Access::read);
    EXPECT_EQ(file.find_run("r")->values[1].unit, "m");
}

TEST_F(RecordRunTest, OfLongRecordsSamplesAndTheHashAreStored) {
    folder_.write("a.csv", waves(2, 2));
    run(std::string(head) + "files = \"a.csv\"\nreference = \"V\"\nkeep = 2000\n");
    EXPECT_TRUE(samples("record").empty());
    EXPECT_GE(samples("section").size(), 8);
    const ResultFile file(path_, ResultFile::Access::read);
    EXPECT_THAT(file.point("r", 0)->result.outcome.detail, HasSubstr("2001 rows, which are not kept"));
    EXPECT_THAT(file.find_run("r")->settings, HasSubstr("\"hash\":\""));
}

TEST_F(RecordRunTest, ADiagramHasAPointForEachRecordAndADirection) {
    std::filesystem::create_directory(folder_ / "up");
    for (int i = 1; i <= 3; ++i) {
        folder_.write(fmt::format("up/{}.csv", i), waves(i, 1));
        folder_.write(fmt::format("d{}.csv", i), waves(4 - i, 1, 0.1));
    }
    run(std::string(head) +
        "files = { up = \"up/*.csv\", down = [\"d1.csv\", \"d2.csv\", \"d3.csv\"] }\nreference = \"V\"\n");
    const ResultFile file(path_, ResultFile::Access::read);
    const StoredRun stored(file, "r", {});
    std::vector<double> amplitudes;
    std::vector<std::string> directions;
    auto rows = stored.rows({.columns = {"direction"}, .quantities = {"amplitude"}});
    while (rows.next()) {
        directions.push_back(rows.text(0));
        amplitudes.push_back(std::round(rows.number(1) * 1e6) / 1e6);
    }
    EXPECT_THAT(amplitudes, ElementsAre(1, 2, 3, 3, 2, 1));
    EXPECT_THAT(directions, ElementsAre("up", "up", "up", "down", "down", "down"));
}

TEST(RecordRun, ChannelsOfABenchHaveTheDescriptionsOfItsModel) {
    const Study study = parse_study(R"(name = "s"
model = "ball-and-shaker"
[runs.r]
kind = "record"
reference = "s"
coordinate = "reach"
[runs.r.bench]
channels = { v = "v", s = { value = "shaker", noise = 0.1 }, twice = "2*v" }
rate = 1000
time = 1
)",
                                    "s.toml");
    const Model& model = study.runs.at(0).model; // as it is kept with the results
    ASSERT_EQ(model.states.size(), 3U);
    EXPECT_EQ(model.states[0].text, "velocity of the ball");
    EXPECT_EQ(model.states[1].text, "position of the shaker's head");
    EXPECT_EQ(model.states[2].text, "");
    EXPECT_EQ(model.parameters.at(0).text, "amplitude of s");
}

TEST_F(RecordRunTest, NothingIsDrawnOverScatterPlots) {
    folder_.write("1.csv", waves(1, 1));
    EXPECT_THAT(refusal(std::string(head) + "files = \"1.csv\"\n[pictures.p]\nkind = \"scatter\"\nrun = \"r\"\n"
                                            "over = \"r\"\n"),
                HasSubstr("have no `over`"));
}

TEST_F(RecordRunTest, RecordsStayInTheFolderOfTheStudy) {
    testing::TemporaryFolder elsewhere;
    elsewhere.write("a.csv", waves(2, 1));
    std::filesystem::create_symlink(elsewhere / "a.csv", folder_ / "link.csv");
    std::filesystem::create_directory_symlink(elsewhere.path(), folder_ / "out");
    std::filesystem::create_directory(folder_ / "inside");
    mkfifo((folder_ / "pipe.csv").c_str(), 0600);
    const auto told = [&](const std::string& name) { return refusal(head + fmt::format("files = \"{}\"\n", name)); };
    EXPECT_THAT(told("../a.csv"), HasSubstr("outside of the study's folder"));
    EXPECT_THAT(told("inside/../../a.csv"), HasSubstr("outside of the study's folder"));
    EXPECT_THAT(told(elsewhere / "a.csv"), HasSubstr("outside of the study's folder"));
    EXPECT_THAT(told("link.csv"), HasSubstr("leads out of the study's folder"));
    std::filesystem::create_symlink("loop.csv", folder_ / "loop.csv");
    EXPECT_THAT(told("loop.csv"), HasSubstr("is a link that leads to no file"));
    EXPECT_LT(told(std::string(5000, 'a') + ".csv").size(), 600U);
    EXPECT_THAT(told("out/a.csv"), HasSubstr("leads out of the study's folder"));
    EXPECT_THAT(told("out/*.csv"), HasSubstr("leads out of the study's folder"));
    EXPECT_THAT(told("inside"), HasSubstr("is no plain file"));
    EXPECT_THAT(told("pipe.csv"), HasSubstr("is no plain file")); // reading it would wait for ever
    EXPECT_THAT(told("none.csv"), HasSubstr("there is no record 'none.csv'"));
    EXPECT_THAT(told("*.dat"), HasSubstr("there is no record '*.dat'"));
    EXPECT_THAT(told(""), HasSubstr("a record has no name"));
    EXPECT_THAT(told("a\\u0007.csv"), HasSubstr("s.toml:4"));
    // A link that stays inside is as good as the file.
    folder_.write("a.csv", waves(2, 1));
    std::filesystem::create_symlink(folder_ / "a.csv", folder_ / "inside/link.csv");
    EXPECT_EQ(told("inside/link.csv"), "");
}

TEST_F(RecordRunTest, RowsWithMissingValuesAreLeftOutAndCounted) {
    folder_.write("nan.csv", "t,V\n0,1\n1,nan\n2,3\n");
    for (const RunReport& report : run(std::string(head) + "files = \"nan.csv\"\n"))
        EXPECT_TRUE(report.complete()) << report.problem;
    const ResultFile file(path_, ResultFile::Access::read);
    EXPECT_THAT(file.point("r", 0)->result.outcome.detail,
                HasSubstr("1 of 3 rows are left out, as a value is missing (the first in line 3)"));
    std::vector<double> times;
    for (const std::vector<double>& row : samples("record"))
        times.push_back(row[0]);
    EXPECT_EQ(times, (std::vector<double>{0, 2}));
}

TEST_F(RecordRunTest, AnInstrumentsTextIsReadFromTheGivenLines) {
    // Units above names, and a line of numbers before both, which would pass for the first row.
    std::string text = "1, 2\n3, 4\ns, mm\nt, q\n";
    for (int i = 0; i < 50; ++i)
        text += fmt::format("{}, {}\n", i, 2 * i);
    folder_.write("a.csv", text);
    run(std::string(head) + "files = \"a.csv\"\nlines = { skip = 2, names = 4, units = 3 }\n");
    const auto rows = samples("record");
    ASSERT_EQ(rows.size(), 50u);
    EXPECT_THAT(rows[7], ElementsAre(7, 14));
    const ResultFile file(path_, ResultFile::Access::read);
    const auto stored = file.find_run("r");
    ASSERT_EQ(stored->values.size(), 1u);
    EXPECT_EQ(stored->values[0].name, "q");
    EXPECT_EQ(stored->values[0].unit, "mm");
    EXPECT_THAT(refusal(std::string(head) + "files = \"a.csv\"\nlines = { names = 0 }\n"), HasSubstr("s.toml:5:"));
}

TEST_F(RecordRunTest, RefusesWhatIsNoRecordWithItsPlace) {
    folder_.write("a.csv", waves(2, 1));
    folder_.write("word.csv", "t,V\n0,1\n1,high\n");
    folder_.write("huge.csv", "t,V\n0,1\n1,1e999\n");
    folder_.write("binary.csv", std::string("\x7f"
                                            "ELF\0\1\2\3",
                                            8));
    folder_.write("empty.csv", "");
    folder_.write("back.csv", "t,V\n0,1\n0,1\n");
    folder_.write("other.csv", "t [s], V [V], x [mm]\n0,1,2\n1,2,3\n");
    folder_.write("units.csv", "t [s], V [mV], q [mm]\n0,1,2\n1,2,3\n");
    folder_.write("names.csv", "t,2 b\n0,1\n1,2\n");
    const auto told = [&](const std::string& rest) { return refusal(head + rest); };
    EXPECT_THAT(told("files = \"word.csv\"\n"), HasSubstr("word.csv:3:"));
    EXPECT_THAT(told("files = \"huge.csv\"\n"), HasSubstr("huge.csv:3:"));
    EXPECT_THAT(told("files = \"binary.csv\"\n"), HasSubstr("binary.csv"));
    EXPECT_THAT(told("files = \"empty.csv\"\n"), HasSubstr("empty.csv"));
    EXPECT_THAT(told("files = \"back.csv\"\n"), HasSubstr("back.csv:3:"));
    EXPECT_THAT(told("files = [\"a.csv\", \"other.csv\"]\n"), HasSubstr("other.csv"));
    EXPECT_THAT(told("files = [\"a.csv\", \"units.csv\"]\n"), HasSubstr("'mV', and that of the first record in 'V'"));
    EXPECT_THAT(told("files = \"names.csv\"\n"), HasSubstr("give it one: channels = { name = \"2 b\" }"));
    EXPECT_THAT(told("files = \"a.csv\"\nchannels = [\"I\"]\n"), HasSubstr("s.toml:5:13"));
    EXPECT_THAT(told("files = \"a.csv\"\nreference = \"I\"\n"), HasSubstr("there is no channel 'I'"));
    EXPECT_THAT(told("files = \"a.csv\"\nreference = { channel = \"V\", level = 3 }\n"), HasSubstr("rise through 3"));
    EXPECT_THAT(told("files = \"a.csv\"\nvalues = [\"log(V - 9)\"]\n"), HasSubstr("has no finite value"));
    EXPECT_THAT(told("files = \"a.csv\"\nvalues = [\"I\"]\n"), HasSubstr("s.toml:5:"));
    EXPECT_THAT(told("files = \"a.csv\"\nsample = { a = { section = 0 } }\n"), HasSubstr("nothing says what begins"));
    EXPECT_THAT(told("files = \"a.csv\"\nreference = \"V\"\nsample = { a = { section = 1 } }\n"),
                HasSubstr("no part of a period"));
    EXPECT_THAT(told("files = \"a.csv\"\nseed = 3\n"), HasSubstr("the records are files"));
    EXPECT_THAT(told("files = \"a.csv\"\nbench = { rate = 3 }\n"), HasSubstr("two kinds of records"));
    EXPECT_THAT(told("text = \"nothing\"\n"), HasSubstr("has no records"));
    EXPECT_THAT(told("files = \"a.csv\"\ncycles = 3\n"), HasSubstr("runs of kind \"record\" have no `cycles`"));
    EXPECT_THAT(told("files = \"a.csv\"\npart = [5, 6]\n"), HasSubstr("a.csv"));
}

TEST_F(RecordRunTest, ARunIsRepeatedWhenItsRecordHasChanged) {
    folder_.write("a.csv", waves(2, 1));
    const std::string text = std::string(head) + "files = \"a.csv\"\n";
    EXPECT_EQ(run(text).front().computed, 1);
    EXPECT_EQ(run(text).front().computed, 0);
    folder_.write("a.csv", waves(2.5, 1));
    EXPECT_EQ(run(text).front().computed, 1);
    // Between reading a study and doing it.
    const Study study = read_study(study_file(text + "keep = 5000\n"));
    folder_.write("a.csv", waves(3, 1));
    ResultFile file(path_, ResultFile::Access::write);
    EXPECT_THAT(run_study(study, file, {}).front().problem, HasSubstr("has changed since"));
}

TEST_F(RecordRunTest, ResultsHoldTheWholeStudy) {
    folder_.write("a.csv", waves(2, 1));
    run(std::string(head) + "files = \"a.csv\"\nreference = \"V\"\nvalues = [\"twice = 2*q\"]\n");
    std::filesystem::remove(folder_ / "a.csv");
    {
        ResultFile file(path_, ResultFile::Access::write);
        const Study study = stored_study(file);
        EXPECT_EQ(study.runs.front().kind, RunKind::record);
        const auto reports = run_study(study, file, {});
        EXPECT_TRUE(reports.front().complete());
        EXPECT_EQ(reports.front().computed, 0);
    }
    // Where the records would be needed, they are asked for.
    ResultFile source(path_, ResultFile::Access::read);
    ResultFile other(folder_ / "other.sqlite", ResultFile::Access::write);
    EXPECT_THAT(run_study(stored_study(source), other, {}).front().problem, HasSubstr("'a.csv' is not among"));
}

/// Runs to the end, broken off after every record or at any other question.
void run_in_pieces(const Study& study, const std::string& path, int questions) {
    for (int trial = 0; trial < 1000; ++trial) {
        ResultFile file(path, ResultFile::Access::write);
        int left = questions + trial; // so that it ends
        const auto reports = run_study(study, file, {.interrupted = [&] { return left-- <= 0; }});
        if (reports.size() == study.runs.size() && reports.back().complete())
            return;
    }
    FAIL() << "it never ends";
}

TEST_F(RecordRunTest, AnInterruptedRunContinuesToTheSameBits) {
    for (int i = 1; i <= 6; ++i)
        folder_.write(fmt::format("{}.csv", i), waves(i, 1));
    const std::string text = std::string(head) + "files = \"*.csv\"\nreference = \"V\"\n";
    run(text);
    run_in_pieces(read_study(study_file(text)), folder_ / "pieces.sqlite", 2);
    expect_same_bits(folder_ / "pieces.sqlite");
}

const char* const bench = R"#(name = "s"
model = "impact-oscillator"
[runs.r]
kind = "record"
set = { omega = 2.8 }
vary = { amplitude = { from = 0.8, to = 1, step = 0.1 } }
direction = "both"
reference = "F"
coordinate = "amplitude"
seed = 7
[runs.r.bench]
channels = { F = "amplitude*sin(omega*t_)", x = { value = "x", noise = 0.01 } }
rate = 20
settle = 30
time = 20
)#";

TEST_F(RecordRunTest, ABenchGivesTheSameRecordsWheneverItIsInterrupted) {
    std::string text = bench;
    const Model model = load_model("impact-oscillator");
    std::string phase;
    for (const State& state : model.states)
        if (state.period)
            phase = state.name;
    ASSERT_FALSE(phase.empty());
    text.replace(text.find("amplitude*sin(omega*t_)"), 23, fmt::format("amplitude*sin({})", phase));
    const auto reports = run(text);
    ASSERT_TRUE(reports.front().complete()) << reports.front().problem;
    EXPECT_EQ(reports.front().points, 6);
    run_in_pieces(read_study(study_file(text)), folder_ / "pieces.sqlite", 3);
    expect_same_bits(folder_ / "pieces.sqlite");
    const ResultFile file(path_, ResultFile::Access::read);
    std::vector<double> levels;
    for (std::size_t n = 0; n < 6; ++n)
        levels.push_back(std::round(1e6 * file.point("r", n)->coordinates[0]) / 1e6);
    EXPECT_THAT(levels, ElementsAre(0.8, 0.9, 1, 1, 0.9, 0.8));
}

TEST_F(RecordRunTest, RefusesInvalidBenches) {
    const auto told = [&](const std::string& rest, const std::string& bench_keys) {
        return refusal("name = \"s\"\nmodel = \"impact-oscillator\"\n[runs.r]\nkind = \"record\"\n" + rest +
                       "[runs.r.bench]\n" + bench_keys);
    };
    const std::string fine = "channels = { x = \"x\" }\nrate = 20\ntime = 20\n";
    EXPECT_EQ(told("", fine), "");
    EXPECT_THAT(told("", "rate = 20\ntime = 20\n"), HasSubstr("measures nothing"));
    EXPECT_THAT(told("", "channels = { x = \"y\" }\nrate = 20\ntime = 20\n"), HasSubstr("s.toml:6:"));
    EXPECT_THAT(told("", "channels = { x = \"x\" }\nrate = 20\n"), HasSubstr("how many samples"));
    EXPECT_THAT(told("", "channels = { x = \"x\" }\nrate = 1e9\ntime = 1e9\n"), HasSubstr("how many samples"));
    EXPECT_THAT(told("vary = { amplitude = [0.001, 1] }\n", fine), HasSubstr("1/200 of the largest"));
    EXPECT_EQ(told("vary = { amplitude = [0.001, 1] }\ncarry = false\n", fine), "");
    EXPECT_THAT(told("vary = { amplitude = [0.5, 1] }\n", fine + "repeats = 2\n"), HasSubstr("recorded once"));
    EXPECT_THAT(told("vary = { x = [0.5, 1] }\n", fine), HasSubstr("the values of one parameter"));
    EXPECT_THAT(
        told("vary = { amplitude = { from = 1, to = 2, points = 1000 } }\ncarry = false\n", fine + "repeats = 10000\n"),
        HasSubstr("more than 1000000 records"));
    const auto channel = [&](const std::string& text) {
        return told("", "channels = { x = " + text + " }\nrate = 20\ntime = 20\n");
    };
    EXPECT_THAT(channel(R"({ value = "x", noise = -1 })"), HasSubstr("s.toml:6:41: "));
    EXPECT_THAT(channel(R"({ value = "x", range = 0 })"), HasSubstr("s.toml:6:41: "));
    EXPECT_THAT(channel("\"sqrt(-1 - x^2)\""), HasSubstr("s.toml:6:14: runs.r.bench.channels.x has no finite value"));
    // What would settle for ever can be broken off.
    const Study study =
        read_study(study_file("name = \"s\"\nmodel = \"impact-oscillator\"\n[runs.r]\nkind = \"record\"\n"
                              "[runs.r.bench]\nsettle = 1e300\n" +
                              fine));
    ResultFile file(folder_ / "settling.sqlite", ResultFile::Access::write);
    int left = 20;
    const auto reports = run_study(study, file, {.interrupted = [&] { return left-- <= 0; }});
    EXPECT_EQ(reports.front().outcome, RunOutcome::interrupted);
}

} // namespace graze::record_run_test
