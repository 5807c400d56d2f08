// Tables of `graze simulate`: columns, values, lengths of runs, endings.

#include "run_graze.hpp"

#include <cmath>
#include <gmock/gmock.h>
#include <numbers>

namespace graze::testing::simulate_test {

using ::testing::HasSubstr;

using std::numbers::pi;

/// A harmonic oscillator with the closed form x = cos(w t), v = -w sin(w t) from the initial state of the model.
const std::string oscillator = R"(
name = "oscillator"
[parameters]
w = 2
[states]
x = 1
v = 0
phase = { initial = 0, period = "2*pi" }
[modes.only]
rates = { x = "v", v = "-w^2*x", phase = "w" }
[sections.start]
state = "phase"
value = 0
[sections.middle]
function = "x"
direction = "falling"
[quantities]
energy = { value = "(v^2 + w^2*x^2)/2", unit = "J" }
)";

/// A ball whose impacts on the floor accumulate; the model does not tell what follows.
const std::string endless = R"(
name = "endless"
[states]
x = 1
v = 0
[modes.flight]
rates = { x = "v", v = -1 }
watch = ["floor"]
[events.floor]
function = "x"
[jumps.bounce]
v = "-v/2"
[[transitions]]
mode = "flight"
event = "floor"
jump = "bounce"
next = "flight"
)";

class Simulate : public ::testing::Test {
protected:
    Simulate() {
        std::ofstream(folder / "oscillator.toml") << oscillator;
        std::ofstream(folder / "endless.toml") << endless;
    }
    Printed simulate(const std::string& model, const std::string& options) const {
        return run_graze("simulate " + (folder / model) + " " + options);
    }
    Csv csv(const std::string& model, const std::string& options, int code = 0) const {
        const Printed run = simulate(model, options + " --format csv");
        EXPECT_EQ(run.code, code) << run.err;
        return Csv(run.out);
    }
    Folder folder;
};

TEST_F(Simulate, SamplesFollowTheClosedForm) {
    const Csv table = csv("oscillator.toml", "--time 3 --samples 31 --quantity energy x+w*v");
    EXPECT_THAT(table.columns, ::testing::ElementsAre("time", "mode", "x", "v", "phase", "energy", "x+w*v"));
    ASSERT_EQ(table.rows.size(), 31U);
    for (std::size_t i = 0; i < 31; ++i) {
        const double t = table.number(i, "time");
        EXPECT_NEAR(t, 0.1 * static_cast<double>(i), 1e-14);
        EXPECT_NEAR(table.number(i, "x"), std::cos(2 * t), 1e-11);
        EXPECT_NEAR(table.number(i, "v"), -2 * std::sin(2 * t), 1e-11);
        EXPECT_NEAR(table.number(i, "energy"), 2, 1e-11);
        EXPECT_NEAR(table.number(i, "x+w*v"), std::cos(2 * t) - 4 * std::sin(2 * t), 1e-10);
        EXPECT_NEAR(std::remainder(table.number(i, "phase") - 2 * t, 2 * pi), 0, 1e-12);
        EXPECT_GE(table.number(i, "phase"), 0);
        EXPECT_LE(table.number(i, "phase"), 2 * pi);
        EXPECT_EQ(table.text(i, "mode"), "only");
    }
}

TEST_F(Simulate, LengthOptionsEndTheTrajectory) {
    EXPECT_EQ(csv("oscillator.toml", "--section start").rows.size(), 20U) << "20 periods unless told";
    EXPECT_EQ(csv("oscillator.toml", "--section start --periods 3").rows.size(), 3U);
    const Csv skipped = csv("oscillator.toml", "--section start --skip 5 --periods 2");
    ASSERT_EQ(skipped.rows.size(), 2U);
    EXPECT_NEAR(skipped.number(0, "time"), 6 * pi, 1e-12);
    const Csv after = csv("oscillator.toml", "--samples 2 --after pi/w --periods 2");
    ASSERT_EQ(after.rows.size(), 2U);
    EXPECT_NEAR(after.number(0, "time"), pi / 2, 1e-12);
    EXPECT_NEAR(after.number(1, "time"), 5 * pi / 2, 1e-12);
    const Csv timed = csv("oscillator.toml", "--every 0.25 --after 1 --time 1");
    ASSERT_EQ(timed.rows.size(), 5U);
    EXPECT_NEAR(timed.number(4, "time"), 2, 1e-14);
    EXPECT_THAT(simulate("endless.toml", "").err, HasSubstr("--time"));
    EXPECT_EQ(csv("mems-switch", "", 2).rows.size(), 0U) << "a path is no shipped model";
}

TEST_F(Simulate, SectionsAndExtremaFollowTheClosedForm) {
    const Csv sections = csv("oscillator.toml", "--section middle --periods 3 --from x=2 --set w=3,");
    EXPECT_THAT(sections.columns, ::testing::ElementsAre("section", "time", "direction", "mode", "x", "v", "phase"));
    ASSERT_EQ(sections.rows.size(), 3U);
    EXPECT_EQ(sections.text(1, "section"), "middle");
    EXPECT_EQ(sections.text(1, "direction"), "-1");
    EXPECT_NEAR(sections.number(1, "time"), (0.5 + 2) * pi / 3, 1e-12);
    EXPECT_EQ(csv("oscillator.toml", "--table sections --periods 3").rows.size(), 6U) << "all sections unless told";
    const Csv extrema = csv("oscillator.toml", "--extrema x^2 --time 3");
    EXPECT_THAT(extrema.columns,
                ::testing::ElementsAre("expression", "time", "kind", "value", "mode", "at_contact", "x", "v", "phase"));
    ASSERT_EQ(extrema.rows.size(), 3U);
    EXPECT_EQ(extrema.text(0, "kind"), "minimum");
    EXPECT_NEAR(extrema.number(0, "time"), pi / 4, 1e-11);
    EXPECT_NEAR(extrema.number(1, "value"), 1, 1e-11);
}

TEST_F(Simulate, DerivativesMatchTheClosedForm) {
    const Csv table = csv("oscillator.toml", "--time 3 --derivatives all");
    EXPECT_THAT(table.columns, ::testing::ElementsAre("state", "value", "d_x", "d_v", "d_phase", "d_w"));
    EXPECT_NEAR(table.number(0, "d_x"), std::cos(6.0), 1e-11);
    EXPECT_NEAR(table.number(0, "d_v"), std::sin(6.0) / 2, 1e-11);
    EXPECT_NEAR(table.number(0, "d_w"), -3 * std::sin(6.0), 1e-10);
    EXPECT_NEAR(table.number(1, "d_w"), -std::sin(6.0) - 6 * std::cos(6.0), 1e-10);
    EXPECT_NEAR(table.number(2, "d_w"), 3, 1e-13);
    EXPECT_THAT(csv("oscillator.toml", "--time 3 --derivatives w,x").columns,
                ::testing::ElementsAre("state", "value", "d_w", "d_x"));
}

TEST_F(Simulate, ContactsOfTheSwitchHavePublishedTimes) {
    const Printed run = run_graze("simulate mems-switch --contacts --event stop --format csv");
    EXPECT_EQ(run.code, 0);
    const Csv table(run.out);
    EXPECT_THAT(table.columns, ::testing::ElementsAre("time", "kind", "event", "transition", "mode_before",
                                                      "mode_after", "rate_before", "rate_after", "q", "v", "theta",
                                                      "q_after", "v_after", "theta_after"));
    const double times[] = {6.267394614702, 12.444019629629, 18.420333867640, 24.195342497066};
    ASSERT_EQ(table.rows.size(), 4U);
    for (std::size_t i = 0; i < 4; ++i) {
        EXPECT_NEAR(table.number(i, "time"), times[i], 1e-9);
        EXPECT_NEAR(table.number(i, "v_after"), -0.8 * table.number(i, "v"), 1e-15);
        EXPECT_EQ(table.text(i, "kind"), "crossing");
    }
    EXPECT_EQ(table.text(3, "transition"), "impact_off");
    EXPECT_THAT(run.err, HasSubstr("snap-through/singularity at time 27.317735701"));
}

TEST_F(Simulate, EndsAfterANumberOfContacts) {
    const Csv table(run_graze("simulate mems-switch --contacts 2 --event stop --format csv").out);
    EXPECT_EQ(table.rows.size(), 2U);
    const Printed sections = run_graze("simulate mems-switch --contacts 2 --event stop --section phase0 --format csv");
    EXPECT_EQ(header(sections.out), "section,time,direction,mode,q,v,theta") << "a number only ends the run";
    const Printed samples =
        run_graze("simulate mems-switch --contacts 2 --event stop --table samples --format csv --samples 100");
    const Csv sampled(samples.out);
    EXPECT_GE(sampled.rows.size(), 50U);
    EXPECT_LE(sampled.rows.size(), 101U);
    EXPECT_NEAR(sampled.number(sampled.rows.size() - 1, "time"), 12.444019629629, 1e-9);
    EXPECT_EQ(run_graze("simulate --contacts mems-switch").code, 0) << "needs no number before the model";
}

TEST_F(Simulate, MinimaLieAboveTheirLowerBounds) {
    const Csv table(run_graze("simulate mems-switch --minima --event stop --format csv").out);
    EXPECT_THAT(table.columns,
                ::testing::ElementsAre("arc", "mode", "start", "end", "event", "time", "value", "lower_bound"));
    ASSERT_GT(table.rows.size(), 4U);
    for (std::size_t i = 0; i < table.rows.size(); ++i) {
        EXPECT_LE(table.number(i, "lower_bound"), table.number(i, "value"));
        EXPECT_GE(table.number(i, "time"), table.number(i, "start") - 1e-12);
        EXPECT_LE(table.number(i, "time"), table.number(i, "end") + 1e-12);
        EXPECT_GE(table.number(i, "value"), -1e-14);
        EXPECT_NEAR(table.number(i, "start"), i > 0 ? table.number(i - 1, "end") : 0, 1e-12);
    }
}

TEST_F(Simulate, IrregularEndingKeepsTheTable) {
    const Printed run = simulate("endless.toml", "--time 10 --contacts --format csv");
    EXPECT_EQ(run.code, exit_irregular);
    EXPECT_THAT(run.err, HasSubstr("graze: chatter at time"));
    const Csv table(run.out);
    ASSERT_GT(table.rows.size(), 10U);
    EXPECT_NEAR(table.number(0, "time"), std::sqrt(2.0), 1e-11);
    EXPECT_NEAR(table.number(1, "time"), 2 * std::sqrt(2.0), 1e-11);
    const Csv summary = csv("endless.toml", "--time 10 --table summary", exit_irregular);
    EXPECT_EQ(summary.text(0, "ending"), "chatter");
    EXPECT_NEAR(summary.number(0, "ending_time"), 3 * std::sqrt(2.0), 1e-10);
    EXPECT_EQ(csv("endless.toml", "--time 10 --steps 3", exit_irregular).rows.size() > 0, true);
}

TEST_F(Simulate, JsonHasModelSettingsAndUnits) {
    const std::string run = done("simulate electromagnetic-testbed --set V0=4.8 --from I=V0/48 theta=pi/2 --periods 2 "
                                 "--section phase0 --format json");
    EXPECT_TRUE(JsonCheck(run).valid()) << run;
    for (const std::string part :
         {R"("model":"electromagnetic-testbed")", R"("V0":4.7999999999999998)", R"("I":0.099999999999999992)",
          R"("theta":1.5707963267948966)", R"("tolerance":9.9999999999999998e-13)", R"("outcome":{"ending":"stopped")",
          R"("columns":["section","time","direction","mode","q","v","I","theta"])",
          R"("units":["","s","","","m","m/s","A","rad"])"})
        EXPECT_THAT(run, HasSubstr(part));
}

TEST_F(Simulate, QuantitiesWithoutAValueAreEmptyAndReported) {
    const Printed run = simulate("oscillator.toml", "--time 3 --samples 10 --quantity log(x) --format json");
    EXPECT_EQ(run.code, 0);
    EXPECT_TRUE(JsonCheck(run.out).valid());
    EXPECT_THAT(run.out, HasSubstr("null]"));
    EXPECT_THAT(run.err, HasSubstr("log(x) has no finite value"));
}

TEST_F(Simulate, OutputIsCompleteOrMissing) {
    const std::string file = folder / "run.csv";
    const std::size_t before = folder.files();
    EXPECT_EQ(done(simulate("oscillator.toml", "--format csv --output " + file)), "");
    EXPECT_EQ(Csv(contents(file)).rows.size(), 500U);
    EXPECT_EQ(folder.files(), before + 1) << "something was left behind";
    expect_refusal(simulate("oscillator.toml", "--steps 1000000000 --time 1e6 --output " + (folder / "no/such/file")),
                   "cannot be written");
    EXPECT_EQ(simulate("oscillator.toml", "--output /dev/null").code, 0);
    EXPECT_TRUE(std::filesystem::is_character_file("/dev/null"));
}

} // namespace graze::testing::simulate_test
