// Models that the engine was not developed with, with answers in closed form: each kind of event, jump and guard in a
// combination that no shipped model has.

#include "simulate.hpp"

#include <gtest/gtest.h>

#include <numbers>

using namespace graze;
using namespace graze::testing;

namespace unseen_models_test {

std::vector<double> times_of(const Experiment& experiment, ContactKind kind) {
    std::vector<double> times;
    for (const auto& record : experiment.recorder.contacts())
        if (record.contact.kind == kind)
            times.push_back(record.contact.time);
    return times;
}

/// A forced oscillator with a wall, in units of length and time chosen by the model.
Model oscillator_in_units(double length, double time) {
    return model_from(fmt::format(R"toml(
parameters = {{ S = {:.17g}, rate = {:.17g} }}
states = {{ x = "-S", v = 0, phase = {{ initial = 0, period = "2*pi" }} }}
modes.free = {{ rates = {{ x = "v", v = "rate^2*(S*cos(phase) - x)", phase = "0.7*rate" }}, watch = ["wall"] }}
events = {{ wall = "0.3*S - x" }}
jumps.impact.v = "-0.8*v"
transitions = [{{ mode = "free", event = "wall", jump = "impact", next = "free" }}]
)toml",
                                  length, 1 / time));
}

TEST(UnseenModels, UnitsHaveNoEffect) {
    for (const double tolerance : {1e-8, 1e-12}) {
        Experiment reference(oscillator_in_units(1, 1), with_tolerance(tolerance));
        reference.run(140);
        const std::vector<double> expected = times_of(reference, ContactKind::crossing);
        ASSERT_GT(expected.size(), 25U);
        for (const auto& [length, time] :
             {std::pair{1.0, 0x1p-20}, {1.0, 0x1p-50}, {0x1p-40, 0x1p-30}, {0x1p50, 0x1p40}, {0x1p-40, 0x1p30}}) {
            Experiment experiment(oscillator_in_units(length, time), with_tolerance(tolerance));
            experiment.run(140 * time);
            const std::vector<double> times = times_of(experiment, ContactKind::crossing);
            ASSERT_EQ(times.size(), expected.size());
            for (std::size_t i = 0; i < times.size(); ++i)
                EXPECT_NEAR(times[i] / time, expected[i], 1e-11 * expected[i]);
            // The mass reverses far from the wall, which is no touch even in units in which its speed is a large
            // number.
            EXPECT_TRUE(times_of(experiment, ContactKind::touch).empty()) << length << ' ' << time << ' ' << tolerance;
        }
    }
}

TEST(UnseenModels, NothingIsSeenBeyondTheZeroOfARoot) {
    // Torricelli's law: the vessel is empty at t = 2, but (1 - t/2)^2 rises again and would reach 5 at t = 6.47.
    Experiment experiment(model_from(R"toml(
states = { level = 1 }
modes.draining = { rates = { level = "-level^0.5" }, watch = ["overflow"] }
events = { overflow = "5 - level" }
transitions = [{ mode = "draining", event = "overflow", next = "end" }]
)toml"));
    EXPECT_EQ(experiment.run(10).ending, Ending::undefined);
    EXPECT_NEAR(experiment.trajectory.outcome().time, 2, 1e-4);
    EXPECT_NEAR(experiment.trajectory.time(), 2, 1e-4);
    EXPECT_NEAR(experiment.trajectory.state()[0], 0, 1e-8);
    EXPECT_TRUE(experiment.recorder.contacts().empty());
    EXPECT_EQ(experiment.run(1.5).ending, Ending::end_time);
    EXPECT_NEAR(experiment.trajectory.state()[0], 0.0625, 4 * epsilon);
}

TEST(UnseenModels, CollisionsOfTwoMassesAndAWallCountTheDigitsOfPi) {
    for (const auto& [mass, collisions] : {std::pair{1.0, 3}, {1e2, 31}, {1e4, 314}, {1e6, 3141}}) {
        Experiment experiment(model_from(fmt::format(R"toml(
parameters = {{ M = {} }}
states = {{ x = 1, y = 2, u = 0, w = -1 }}
modes.free = {{ rates = {{ x = "u", y = "w", u = 0, w = 0 }}, watch = ["wall", "meet"] }}
events = {{ wall = "x", meet = "y - x" }}
jumps.wall.u = "-u"
jumps.meet = {{ u = "((1 - M)*u + 2*M*w)/(1 + M)", w = "((M - 1)*w + 2*u)/(1 + M)" }}
transitions = [
  {{ mode = "free", event = "wall", jump = "wall", next = "free" }},
  {{ mode = "free", event = "meet", jump = "meet", next = "free" }},
]
)toml",
                                                     mass)));
        ASSERT_EQ(experiment.run(100).ending, Ending::end_time);
        EXPECT_EQ(times_of(experiment, ContactKind::crossing).size(), static_cast<std::size_t>(collisions));
        const std::vector<double> state = experiment.state();
        EXPECT_NEAR(state[2] * state[2] + mass * state[3] * state[3], mass, 4 * collisions * epsilon * mass);
    }
}

TEST(UnseenModels, RockingBlockComesToRest) {
    Experiment experiment(model_from(R"toml(
parameters = { alpha = 0.3, r = 0.85 }
states = { angle = 0, rate = 0.4 }
modes.right = { rates = { angle = "rate", rate = "4*(angle - alpha)" }, watch = ["right"] }
modes.left = { rates = { angle = "rate", rate = "4*(angle + alpha)" }, watch = ["left"] }
modes.rest = { rates = { angle = 0, rate = 0 } }
initial.mode = "right"
events = { right = "angle", left = "-angle" }
jumps.impact = { angle = 0, rate = "r*rate" }
jumps.settle = { angle = 0, rate = 0 }
transitions = [
  { mode = "right", event = "right", jump = "impact", next = "left", chatter = { jump = "settle", mode = "rest" } },
  { mode = "left", event = "left", jump = "impact", next = "right", chatter = { jump = "settle", mode = "rest" } },
]
)toml"));
    ASSERT_EQ(experiment.run(30).ending, Ending::end_time);
    // From rate w the block returns after (2/p) atanh(w/(p alpha)), p = 2.
    const std::vector<double> times = times_of(experiment, ContactKind::crossing);
    double time = 0;
    std::size_t impact = 0;
    for (double rate = 0.4; rate > 1e-30; rate *= 0.85, ++impact) {
        time += std::atanh(rate / 0.6);
        if (impact < 40) {
            EXPECT_NEAR(times.at(impact), time, 1e-13 * time);
        }
    }
    const std::vector<double> rests = times_of(experiment, ContactKind::sticking);
    ASSERT_EQ(rests.size(), 1U);
    EXPECT_NEAR(rests[0], time, 1e-12 * time);
}

TEST(UnseenModels, APhaseThatRunsBackwardsPassesEachSection) {
    Model model = model_from(R"toml(
modes.only = { rates = { a = -1, b = 0.7, s = "0.1 + cos(b)" }, watch = ["tick"] }
events = { tick = { function = "sin(2*pi*a/3 - 1)", kind = "section" } }
transitions = [{ mode = "only", event = "tick", next = "only" }]
[states]
a = { initial = 0.5, period = 3 }
b = { initial = 0.5, period = "2*pi" }
s = { initial = 0, drifting = true }
)toml");
    Probe probe;
    probe.name = "one";
    probe.kind = Probe::Kind::phase;
    probe.state = 0;
    probe.value = model.graph->number(1);
    Experiment experiment(model, {}, {probe});
    ASSERT_EQ(experiment.run(12345.678).ending, Ending::end_time);
    const auto& passages = experiment.recorder.passages();
    ASSERT_EQ(passages.size(), 4115U);
    for (std::size_t i = 0; i < passages.size(); ++i) {
        const double expected = 2.5 + 3 * static_cast<double>(i);
        EXPECT_NEAR(passages[i].passage.time, expected, 2 * epsilon * expected);
        EXPECT_EQ(passages[i].passage.direction, -1);
    }
    const std::vector<double> ticks = times_of(experiment, ContactKind::crossing);
    ASSERT_EQ(ticks.size(), 4116U);
    for (std::size_t i = 0; i < ticks.size(); ++i)
        EXPECT_NEAR(ticks[i], 0.5 - 1.5 / std::numbers::pi + 3 * static_cast<double>(i), 1e-11);
    const double angle = 0.5 + 0.7 * 12345.678;
    EXPECT_NEAR(experiment.state()[2], 1234.5678 + (std::sin(angle) - std::sin(0.5)) / 0.7, 1e-9);
}

} // namespace unseen_models_test
