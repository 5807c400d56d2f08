// `graze trip`: times until motions beyond a grazing or a fold are lost.

#include "run_graze.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <filesystem>
#include <numbers>

namespace graze::testing::trip_command_test {

using ::testing::HasSubstr;

struct TripCommand : public ::testing::Test {
    std::string run_only(const std::string& study, const std::vector<std::string>& runs) {
        return testing::run_only(study, runs, folder / "results");
    }
    Csv table(std::vector<std::string> words, int code = 0) {
        words.insert(words.begin(), "trip");
        words.insert(words.end(), {"--format", "csv"});
        const Printed printed = run_graze(words);
        EXPECT_EQ(printed.code, code) << printed.err;
        return Csv(printed.out);
    }
    void expect_refusal(std::vector<std::string> words, const std::string& message) {
        words.insert(words.begin(), "trip");
        testing::expect_refusal(words, message);
    }
    Folder folder;
};

TEST_F(TripCommand, TimesOfTheSwitchMatchPublishedOnes) {
    const std::string results = run_only("mems-switch", {"free", "no_impact"});
    const Csv csv = table({results, "GR1"});
    ASSERT_EQ(csv.rows.size(), 10U);
    for (std::size_t row = 0; row < csv.rows.size(); ++row) {
        // The shipped parameter is 0.2: 1e-2 to 1e-20 of its decade.
        EXPECT_NEAR(std::log10(csv.number(row, "overshoot")), -3 - 2 * static_cast<double>(row), 1e-12);
        EXPECT_EQ(csv.text(row, "ending"), "speed");
        // Contacts shift the phase: the simulated cycle ends some hundredths of a cycle earlier or later.
        EXPECT_NEAR(csv.number(row, "end_cycles"), csv.number(row, "cycles"), 0.06);
        EXPECT_EQ(csv.text(row, "simulated_time").empty(), row > 4) << row;
    }
    // The published motion begins 1e-4 beyond a grazing known to all digits; that of the branch has fewer.
    const Csv published = table({results, "no_impact:GR1", "--overshoot", "1e-4", "--until", "end"});
    ASSERT_EQ(published.rows.size(), 1U);
    EXPECT_NEAR(published.number(0, "simulated_time"), 27.31773570163, 1e-6);
    EXPECT_EQ(published.text(0, "ending"), "singular");
    const Csv level = table({results, "GR1", "--overshoot", "1e-4", "--until", "q=0.9"});
    EXPECT_EQ(level.text(0, "ending"), "level");
    EXPECT_LT(level.number(0, "end_time"), 27.31773570163);
    const Csv speed = table({results, "GR1", "--overshoot", "1e-4", "--greatest-speed", "0.001"});
    EXPECT_NEAR(speed.number(0, "end_time"), 6.267394614702, 1e-6);
    // Disturbed towards the stop, without overshoot: the first contact is immediate and has the disturbance's speed.
    const Csv pushed = table({results, "GR1", "--overshoot", "0", "--disturbance", "v=-1e-4"});
    EXPECT_NEAR(pushed.number(0, "first_speed"), 1e-4, 1e-8);
    EXPECT_NEAR(pushed.number(0, "end_time"), pushed.number(0, "simulated_time"), 1e-3);
    const Printed json = run_graze({"trip", results, "GR1", "--overshoot", "1e-3:1e-6", "--format", "json"});
    EXPECT_THAT(json.out, HasSubstr("\"parameter\":\"V\""));
    EXPECT_EQ(table({results, "GR1", "--overshoot", "1e-3:1e-6"}).rows.size(), 4U);
}

TEST_F(TripCommand, ReportsTripsThatDoNotEnd) {
    const std::string results = run_only("mems-switch", {"free", "no_impact"});
    const Csv csv = table({results, "GR1", "--overshoot", "1e-6", "--until", "end", "--cycles", "2"}, 3);
    EXPECT_EQ(csv.text(0, "ending"), "end-time");
    EXPECT_EQ(csv.text(0, "end_time"), "");
    const Printed printed =
        run_graze({"trip", results, "GR1", "--overshoot", "1e-6", "--until", "end", "--cycles", "2"});
    EXPECT_EQ(printed.code, 3);
    EXPECT_THAT(printed.err, HasSubstr("the trip at the overshoot 1e-06 has not come to its end"));
    EXPECT_THAT(printed.err, HasSubstr("give more --cycles"));
}

TEST_F(TripCommand, RefusesPointsAndOptionsWithoutATrip) {
    const std::string results = run_only("mems-switch", {"free", "no_impact"});
    expect_refusal({results, "no_impact:EP1"}, "touches nothing");
    expect_refusal({results, "GR1", "--overshoot", "-1e-4"}, "contacts begin above: give a positive overshoot");
    expect_refusal({results, "GR1", "--overshoot", "1e-4:-1e-6"}, "not of one sign");
    expect_refusal({results, "GR1", "--overshoot", "0"}, "nothing happens");
    expect_refusal({results, "GR1", "--overshoot", "0", "--disturbance", "v=-1e-4", "--plot", folder / "none.svg"},
                   "an overshoot of zero has no place on a logarithmic axis");
    EXPECT_FALSE(std::filesystem::exists(folder / "none.svg"));
    expect_refusal({results, "GR1", "--beside", "no_impact:EP1"}, "--beside: the orbit at EP1 touches nothing");
    expect_refusal({results, "GR1", "--disturbance", "w=1"}, "'w' is not a state; choose one of q, v, theta");
    expect_refusal({results, "GR1", "--until", "q"}, "it names no level");
    expect_refusal({results, "GR1", "--until", ""}, "--until: its value is empty");
    expect_refusal({results, "GR1", "--parameter", "nope"}, "--parameter: ");
    expect_refusal({results, "GR1", "--until", "qq=1"}, "qq");
    expect_refusal({results, "GR1", "--until", "end", "--greatest-speed", "1"}, "--until");
    expect_refusal({results, "GR1", "--data", "file"}, "--plot");
    const std::string beam = run_only("microbeam", {"free", "no_contact"});
    expect_refusal({beam, "no_contact:GR1"}, "POINT: the verdict is folds: there is no trip");
}

TEST_F(TripCommand, DrawsTripTimes) {
    const std::string results = run_only("mems-switch", {"free", "no_impact"});
    done({"trip", results, "GR1", "--until", "end", "--plot", folder / "trip.svg", "--data", folder / "trip.gp"});
    EXPECT_THAT(contents(folder / "trip.svg"), HasSubstr("</svg>"));
    EXPECT_THAT(contents(folder / "trip.gp"), HasSubstr("logscale x"));
}

/// The switch at the published frequency, and at another one, at which its branch has a fold before the grazing.
const char* const two_ends = R"toml(
name = "two-ends"
model = "mems-switch"

[runs.free]
kind = "orbit"
set = { V = 0.05 }
from = { q = 0, v = 0, theta = 0 }

[runs.touching]
kind = "continue"
direction = "up"
start = { run = "free" }
along = { V = [0.01, 0.4] }

[runs.slower]
kind = "orbit"
set = { V = 0.05, omega = 0.95 }
from = { q = 0, v = 0, theta = 0 }

[runs.folding]
kind = "continue"
direction = "up"
start = { run = "slower" }
along = { V = [0.01, 0.4] }
)toml";

TEST_F(TripCommand, ComparesAFoldWithATouch) {
    const std::string results = run_only(folder.write("two-ends.toml", two_ends), {});
    const Csv fold = table({results, "folding:SN1", "--overshoot", "1e-2:1e-10", "--cycles", "20000"});
    ASSERT_EQ(fold.rows.size(), 9U);
    for (std::size_t row = 0; row < fold.rows.size(); ++row) {
        SCOPED_TRACE(row);
        // Cycles grow with the inverse root of the overshoot; the time is a multiple of the period.
        EXPECT_NEAR(fold.number(row, "cycles"), fold.number(0, "cycles") * std::pow(10, 0.5 * static_cast<double>(row)),
                    1e-9 * fold.number(row, "cycles"));
        EXPECT_NEAR(fold.number(row, "time") / fold.number(row, "cycles"), 2 * std::numbers::pi / 0.95, 1e-8);
        EXPECT_EQ(fold.text(row, "simulated_cycles").empty(), row > 5);
        if (row > 5)
            continue;
        // Errors of the normal form are of the next order: about one cycle from rounding to whole cycles, and a term
        // with the logarithm of the overshoot from the cubic term: at most 5 of up to 11000 cycles.
        EXPECT_NEAR(fold.number(row, "simulated_cycles"), fold.number(row, "gate_cycles"), 5);
        EXPECT_NEAR(fold.number(row, "simulated_time"),
                    fold.number(row, "simulated_cycles") * 2 * std::numbers::pi / 0.95,
                    1e-6 * fold.number(row, "simulated_time"));
    }
    const Csv both = table({results, "touching:GR1", "--beside", "folding:SN1", "--overshoot", "1e-2:1e-10"});
    const Csv touch = table({results, "touching:GR1", "--overshoot", "1e-2:1e-10"});
    ASSERT_EQ(both.rows.size(), 9U);
    for (std::size_t row = 0; row < both.rows.size(); ++row) {
        EXPECT_EQ(both.text(row, "time"), touch.text(row, "time"));
        EXPECT_EQ(both.text(row, "end_time"), touch.text(row, "end_time"));
        EXPECT_EQ(both.text(row, "beside_cycles"), fold.text(row, "cycles"));
    }
    done({"trip", results, "touching:GR1", "--beside", "folding:SN1", "--overshoot", "1e-2:1e-6", "--plot",
          folder / "both.svg", "--data", folder / "both.gp"});
    EXPECT_THAT(contents(folder / "both.gp"), HasSubstr("logscale y"));
    expect_refusal({results, "folding:SN1", "--overshoot", "-1e-3"}, "there are two orbits, and no trip");
    expect_refusal({results, "folding:SN1", "--overshoot", "0"}, "at the fold itself nothing passes");
    expect_refusal({results, "folding:SN1", "--disturbance", "v=1"}, "a passage through a fold begins before it");
    // The grazing on the other branch beyond the fold is that of an unstable orbit.
    expect_refusal({results, "folding:GR1"}, "POINT: the verdict is undecided");
}

TEST_F(TripCommand, FindsTheDelayOfARamp) {
    const std::string results = run_only(folder.write("two-ends.toml", two_ends), {});
    const Csv touch = table({results, "touching:GR1", "--ramp", "1e-5:1e-10"});
    ASSERT_EQ(touch.rows.size(), 6U);
    for (std::size_t row = 0; row < touch.rows.size(); ++row) {
        const double rate = touch.number(row, "rate"), delay = touch.number(row, "delay");
        EXPECT_NEAR(touch.number(row, "value") - 0.2013662121541341, delay, 1e-11);
        EXPECT_NEAR(touch.number(row, "from") + rate * touch.number(row, "time"), touch.number(row, "value"), 1e-13);
        EXPECT_NEAR(delay, touch.number(row, "delay_cycles") * rate * 2 * std::numbers::pi, 1e-9 * delay);
        EXPECT_GT(touch.number(row, "delay_cycles"), 3);
        EXPECT_LT(touch.number(row, "delay_cycles"), 10);
    }
    const Csv fold = table({results, "folding:SN1", "--ramp", "1e-6,1e-8", "--until", "q+delta=0"});
    for (std::size_t row = 0; row < 2; ++row) // the stop is reached about 20 cycles before the normal form diverges
        EXPECT_NEAR(fold.number(row, "delay"), fold.number(row, "predicted_delay"),
                    30 * fold.number(row, "rate") * 2 * std::numbers::pi / 0.95);
    const Csv late = table({results, "folding:SN1", "--ramp", "1e-8", "--until", "q+delta=0", "--cycles", "10"}, 3);
    EXPECT_EQ(late.text(0, "ending"), "end-time");
    EXPECT_EQ(late.text(0, "value"), "");
    expect_refusal({results, "touching:GR1", "--ramp", "-1e-5"}, "give a positive rate");
    expect_refusal({results, "touching:GR1", "--ramp", "0"}, "give a positive rate");
    expect_refusal({results, "touching:GR1", "--ramp", "1e-5", "--at", "0.21"},
                   "--at: V = 0.21 is not before the point");
    expect_refusal({results, "touching:GR1", "--ramp", "1"}, "--ramp: the ramp would begin at V = -");
    const Printed words =
        run_graze({"trip", results, "folding:SN1", "--ramp", "1e-8", "--until", "q+delta=0", "--cycles", "10"});
    EXPECT_THAT(words.err, HasSubstr("the ramp of 1e-08 has not come to its end"));
    expect_refusal({results, "touching:GR1", "--at", "0.19"}, "nothing changes in time");
    expect_refusal({results, "folding:SN1", "--ramp", "1e-6"}, "give --until EXPR=LEVEL or --until end");
    expect_refusal({results, "folding:SN1", "--ramp", "1e-6", "--greatest-speed", "1"}, "a fold has no contact");
}

TEST_F(TripCommand, FindsTripsUnderWavesAndNoise) {
    const std::string results = run_only("mems-switch", {"free", "no_impact"});
    const Csv wave = table({results, "GR1", "--wave", "1e-3,3e-3", "--at", "0.199"});
    EXPECT_EQ(wave.text(0, "trips"), "no");
    EXPECT_EQ(wave.text(1, "trips"), "yes");
    const std::vector<std::string> words{results, "GR1",       "--noise", "0.002,0.004", "--at",
                                         "0.199", "--motions", "100",     "--cycles",    "50"};
    const auto with = [&](std::vector<std::string> further) {
        further.insert(further.begin(), words.begin(), words.end());
        return further;
    };
    const Csv noise = table(with({"--jobs", "1"}));
    ASSERT_EQ(noise.rows.size(), 2U);
    for (std::size_t row = 0; row < 2; ++row) {
        EXPECT_EQ(noise.number(row, "probability"), noise.number(row, "trips") / 100);
        EXPECT_LE(noise.number(row, "low"), noise.number(row, "probability"));
        EXPECT_GE(noise.number(row, "high"), noise.number(row, "probability"));
        EXPECT_EQ(noise.text(row, "failed"), "0");
    }
    EXPECT_LT(noise.number(0, "trips"), noise.number(1, "trips"));
    EXPECT_EQ(table(with({"--jobs", "3"})).rows, noise.rows);
    EXPECT_NE(table(with({"--memory", "3"})).rows, noise.rows);
    std::vector<std::string> drawn = with({"--plot", folder / "noise.svg", "--data", folder / "noise.gp"});
    drawn.insert(drawn.begin(), "trip");
    done(drawn);
    EXPECT_THAT(contents(folder / "noise.gp"), HasSubstr("probability of a trip"));
    expect_refusal({results, "GR1", "--noise", "0.002"}, "give the value of V that is disturbed: --at VALUE");
    expect_refusal({results, "GR1", "--noise", "-1", "--at", "0.199"}, "--noise: the level of noise -1");
    expect_refusal({results, "GR1", "--wave", "1", "--noise", "1", "--at", "0.199"}, "only one of them");
    expect_refusal({results, "GR1", "--wave", "1", "--at", "0.199", "--memory", "2"}, "nothing is random");
    expect_refusal({results, "GR1", "--noise", "1", "--at", "0.199", "--overshoot", "1"}, "changes in time here");
}

} // namespace graze::testing::trip_command_test
