#include "base/message_of.hpp"
#include "trajectory/simulate.hpp"

#include <gmock/gmock.h>

#include <numbers>

namespace graze::probe_test {

using namespace graze::testing;
using std::numbers::pi;
using ::testing::AllOf;
using ::testing::HasSubstr;

/// Counts passages and stores only the last time and state of each probe, since runs are long.
class Counter : public Observer {
public:
    explicit Counter(std::size_t probes) : count(probes), last(probes, -1e300), state(probes) {}
    void passage(const Passage& passage) override {
        ++count[passage.probe];
        EXPECT_GT(passage.time, last[passage.probe]);
        last[passage.probe] = passage.time;
        state[passage.probe].assign(passage.state.begin(), passage.state.end());
        directions += passage.direction;
    }
    std::vector<std::size_t> count;
    std::vector<double> last;
    std::vector<std::vector<double>> state;
    long directions = 0;
};

/// Stops at each passage.
class Stopper : public Recorder {
public:
    bool stop() override { return std::exchange(stop_, false); }
    void passage(const Passage& passage) override {
        Recorder::passage(passage);
        stop_ = true;
    }

private:
    bool stop_ = false;
};

std::vector<std::size_t> passages(const Model& model, const std::vector<Probe>& probes, double end_time,
                                  SimulationOptions options = {}) {
    Simulation simulation(System(model), probes, {}, options);
    Counter counter(probes.size());
    Trajectory trajectory(simulation, model.parameter_values(), borrowed(counter));
    trajectory.start(model.initial_state(), model.initial_mode, 0, end_time);
    run(trajectory);
    EXPECT_EQ(trajectory.outcome().ending, Ending::end_time) << trajectory.outcome().detail;
    return counter.count;
}

/// A harmonic oscillation x = sin(phase) with its phase; `rate` may be negative; `other` is the rate of a second phase.
Model rotor(double rate = 1, double other = 1) {
    Model model = model_from(R"(
name = "rotor"
parameters = { rate = 1, other = 1, target = 1 }
modes.only = { rates = { x = "v", v = "-x", phase = "rate", second = "other" }, watch = [] }
sections.zero = { state = "phase", value = 0 }
sections.target = { state = "phase", value = "target" }
sections.second = { state = "second", value = 1 }
sections.up = { function = "x", direction = "rising" }
sections.down = { function = "x", direction = "falling" }
sections.both.function = "x"
[states]
x = { initial = 0 }
v = { initial = 1 }
phase = { initial = 0, period = "2*pi" }
second = { initial = 0, period = 3 }
)");
    model.set_parameter("rate", rate);
    model.set_parameter("other", other);
    return model;
}

std::vector<Probe> sections(const Model& model, std::initializer_list<const char*> names) {
    std::vector<Probe> probes;
    for (const char* name : names)
        probes.push_back(section_probe(model, name));
    return probes;
}

TEST(Probe, SectionsHaveProbes) {
    const Model model = rotor();
    EXPECT_EQ(section_probe(model, "target").kind, Probe::Kind::phase);
    EXPECT_EQ(section_probe(model, "up").direction, Direction::rising);
    EXPECT_THAT(message_of([&] { section_probe(model, "taget"); }), AllOf(HasSubstr("taget"), HasSubstr("'target'")));
}

TEST(Probe, HasOnePassageInEachPeriod) {
    const std::size_t periods = 100'000;
    const Model model = rotor();
    // The run ends half a period after the last passage. It starts on `zero`, `up` and `both`, which are not passed
    // then.
    const auto count = passages(model, sections(model, {"zero", "target", "up", "down", "both"}),
                                2 * pi * static_cast<double>(periods) + 3.5);
    EXPECT_EQ(count[0], periods);
    EXPECT_EQ(count[1], periods + 1);
    EXPECT_EQ(count[2], periods);
    EXPECT_EQ(count[3], periods + 1);
    EXPECT_EQ(count[4], 2 * periods + 1);
}

TEST(Probe, StepsThatEndOnASectionCountOnce) {
    const Model model = rotor();
    for (const int parts : {1, 2, 3, 4, 7, 8, 64}) {
        const SimulationOptions options{.largest_step = 2 * pi / parts};
        const std::size_t periods = 3000;
        const auto count = passages(model, sections(model, {"zero", "target", "up", "down", "both"}),
                                    2 * pi * static_cast<double>(periods) + 3.5, options);
        EXPECT_EQ(count[0], periods) << parts;
        EXPECT_EQ(count[1], periods + 1) << parts;
        EXPECT_EQ(count[2], periods) << parts;
        EXPECT_EQ(count[3], periods + 1) << parts;
        EXPECT_EQ(count[4], 2 * periods + 1) << parts;
    }
}

TEST(Probe, PhasesMayRunBackwards) {
    const std::size_t periods = 20'000;
    const Model model = rotor(-1, -2.5);
    const auto count =
        passages(model, sections(model, {"zero", "target", "second"}), 2 * pi * static_cast<double>(periods) + 3.5);
    EXPECT_EQ(count[0], periods); // the run starts on it
    EXPECT_EQ(count[1], periods); // the first passage is after 2 pi - 1
    EXPECT_EQ(count[2], static_cast<std::size_t>(std::floor((2.5 * (2 * pi * periods + 3.5) - 2) / 3)) + 1);
    const auto again =
        passages(model, sections(model, {"zero", "target"}), 2 * pi * 1000 + 3.5, {.largest_step = 2 * pi / 8});
    EXPECT_EQ(again[0], 1000u);
    EXPECT_EQ(again[1], 1000u);
}

TEST(Probe, PhasesMayTurnBack) {
    // theta' = cos(t): theta oscillates in [-1, 1]; sections at 0 and at 0.5.
    Model model = model_from(R"(
name = "sway"
states = { s = 0, c = 1, theta = { initial = 0, period = 1.5 } }
modes.only = { rates = { s = "c", c = "-s", theta = "c" }, watch = [] }
sections.zero = { state = "theta", value = 0 }
sections.half = { state = "theta", value = 0.5 }
)");
    Experiment experiment(model, {}, sections(model, {"zero", "half"}));
    experiment.run(2 * pi * 100 + 1);
    std::vector<double> zero, half;
    for (const auto& record : experiment.recorder.passages())
        (record.passage.probe == 0 ? zero : half).push_back(record.passage.time);
    ASSERT_EQ(zero.size(), 200u); // at pi, 2 pi, 3 pi, ...
    for (std::size_t i = 0; i < zero.size(); ++i)
        EXPECT_NEAR(zero[i], static_cast<double>(i + 1) * pi, 1e-11);
    // sin t = 0.5 at pi/6, 5 pi/6; sin t = -1, equal to 0.5 - 1.5, touches the section at the turning point: no
    // passage.
    ASSERT_GE(half.size(), 201u);
    EXPECT_NEAR(half[0], pi / 6, 1e-12);
    EXPECT_NEAR(half[1], 5 * pi / 6, 1e-12);
}

TEST(Probe, TimesAndStatesOfPassagesAreExact) {
    const Model model = rotor();
    Experiment experiment(model, with_tolerance(1e-15), sections(model, {"zero", "up"}));
    experiment.run(200 * pi + 1);
    ASSERT_EQ(experiment.recorder.passages().size(), 200u);
    for (std::size_t i = 0; i < 200; ++i) {
        const auto& [passage, state] = experiment.recorder.passages()[i];
        EXPECT_NEAR(passage.time, 2 * pi * static_cast<double>(i / 2 + 1), 1e-12);
        EXPECT_EQ(passage.direction, 1);
        EXPECT_NEAR(state[0], 0, 1e-12);
        EXPECT_GE(state[2], 0);
        EXPECT_LT(state[2], 2 * pi);
        if (passage.probe == 0) {
            EXPECT_LT(std::min(state[2], 2 * pi - state[2]), 1e-14);
        }
    }
}

TEST(Probe, ExtremaOfSmoothMotionsAreFound) {
    const Model model = rotor();
    const auto x = [&](Direction direction) {
        return Probe{"x", Probe::Kind::extremum, model.symbol("x"), direction, 0, {}};
    };
    Experiment experiment(model, with_tolerance(1e-15),
                          {x(Direction::both), x(Direction::falling), x(Direction::rising)});
    experiment.run(20 * pi + 1);
    std::vector<int> count(3);
    for (const auto& [passage, state] : experiment.recorder.passages()) {
        ++count[passage.probe];
        // Extrema are at pi/2 + n pi; the value is stationary there.
        const double n = std::round(passage.time / pi - 0.5);
        EXPECT_NEAR(passage.time, pi / 2 + n * pi, 2e-13);
        EXPECT_EQ(passage.direction, std::fmod(n, 2) == 0 ? -1 : 1);
        EXPECT_NEAR(state[0], -passage.direction, 1e-13);
        EXPECT_FALSE(passage.at_contact);
    }
    EXPECT_EQ(count, (std::vector<int>{20, 10, 10}));
}

TEST(Probe, ExtremaAtImpactsCountOnce) {
    Model model = load_model("impact-oscillator");
    model.set_parameter("omega", 2.5);
    const auto x = [&](Direction direction) {
        return Probe{"x", Probe::Kind::extremum, model.symbol("x"), direction, 0, {}};
    };
    Experiment experiment(model, with_tolerance(1e-13), {x(Direction::falling), x(Direction::rising)});
    experiment.run(500);
    std::size_t at_contact = 0, other_maxima = 0, minima = 0, crossings = 0;
    for (const auto& [passage, state] : experiment.recorder.passages()) {
        minima += passage.probe == 1;
        at_contact += passage.at_contact;
        other_maxima += passage.probe == 0 && !passage.at_contact;
        if (passage.at_contact) {
            EXPECT_EQ(passage.direction, -1);
        }
    }
    for (const auto& record : experiment.recorder.contacts())
        crossings += record.contact.kind == ContactKind::crossing &&
                     model.events[record.contact.event].name == "stop" && record.contact.rate_before < 0;
    EXPECT_GT(crossings, 50u);
    EXPECT_EQ(at_contact, crossings);
    // Maxima and minima must alternate.
    EXPECT_LE(std::max(at_contact + other_maxima, minima) - std::min(at_contact + other_maxima, minima), 1u);
}

TEST(Probe, PhasesMayBeSetByAJump) {
    // The model switches at phases 0 and pi and sets the phase there exactly; a section is at each of them.
    Model model = load_model("mems-switch");
    model.set_parameter("V", 0.1);
    model.set_initial("q", 0);
    model.set_initial("theta", 0.3);
    Probe pi_section = section_probe(model, "phase0");
    pi_section.value = model.graph->number(pi);
    Probe other = pi_section;
    other.value = model.graph->number(1);
    const double periods = 5000;
    const auto count = passages(model, {section_probe(model, "phase0"), pi_section, other}, 2 * pi * periods + 0.1);
    EXPECT_EQ(count, (std::vector<std::size_t>(3, 5000)));
}

TEST(Probe, PhasesMayJumpOntoAndPastSections) {
    // At phase 1 a jump to 2 (past the section at 1.5, which is not counted), at phase 3 back to 0 (onto a section).
    const Model model = model_from(R"(
name = "jumps"
states = { theta = { initial = 0.5, period = 4 } }
modes.low = { rates = { theta = 1 }, watch = ["at_one"] }
modes.high = { rates = { theta = 1 }, watch = ["at_three"] }
initial.mode = "low"
events = { at_one = "1 - theta", at_three = "3 - theta" }
jumps.forward.theta = 2
jumps.back.theta = 0
transitions = [
  { mode = "low", event = "at_one", jump = "forward", next = "high" },
  { mode = "high", event = "at_three", jump = "back", next = "low" },
]
sections.zero = { state = "theta", value = 0 }
sections.skipped = { state = "theta", value = 1.5 }
sections.passed = { state = "theta", value = 2.5 }
)");
    const auto count = passages(model, sections(model, {"zero", "skipped", "passed"}), 0.5 + 2 * 100 - 0.1);
    EXPECT_EQ(count, (std::vector<std::size_t>{0, 0, 100}));
}

TEST(Probe, SectionsMayCoincideWithABarrier) {
    // A ball on a floor: every impact reaches the section x = 0, falling, once; it never rises through it.
    Model model = load_model("bouncing-ball");
    model.set_parameter("a", 0);
    model.set_parameter("e", 1);
    Probe floor{"floor", Probe::Kind::crossing, model.symbol("x"), Direction::both, 0, {}};
    Experiment experiment(model, with_tolerance(1e-14), {floor});
    experiment.run(100);
    std::size_t impacts = 0;
    for (const auto& record : experiment.recorder.contacts())
        impacts += record.contact.kind == ContactKind::crossing;
    EXPECT_EQ(impacts, static_cast<std::size_t>(std::floor(100 / (2 * std::sqrt(2 * 0.05 / 9.81)) + 0.5)));
    EXPECT_EQ(experiment.recorder.passages().size(), impacts);
    for (const auto& record : experiment.recorder.passages())
        EXPECT_EQ(record.passage.direction, -1);
}

TEST(Probe, StoppingAtPassagesLosesAndRepeatsNothing) {
    const Model model = rotor();
    const auto probes = sections(model, {"zero", "target", "up", "down", "both", "second"});
    Simulation simulation(System(model), probes, {}, with_tolerance(1e-14));
    Stopper stopper;
    Trajectory trajectory(simulation, model.parameter_values(), borrowed(stopper));
    JetSet jets(simulation, LaneKind::single);
    trajectory.start(model.initial_state(), 0, 0, 1000.5);
    run(trajectory, jets);
    std::size_t stops = 0;
    while (trajectory.outcome().ending == Ending::stopped) {
        ++stops;
        // The state is exactly at the passage, to the last bit.
        EXPECT_EQ(trajectory.time(), stopper.passages().back().passage.time);
        EXPECT_EQ(trajectory.outcome().time, trajectory.time());
        EXPECT_EQ(trajectory.state()[0], stopper.passages().back().state[0]);
        trajectory.extend(1000.5);
        run(trajectory, jets);
    }
    EXPECT_EQ(trajectory.outcome().ending, Ending::end_time);
    Experiment whole(model, with_tolerance(1e-14), probes);
    whole.run(1000.5);
    const auto times = [&](const Recorder& recorder, std::size_t probe) {
        std::vector<double> result;
        for (const auto& record : recorder.passages())
            if (record.passage.probe == probe)
                result.push_back(record.passage.time);
        return result;
    };
    for (std::size_t p = 0; p < probes.size(); ++p) {
        const auto one = times(stopper, p), other = times(whole.recorder, p);
        ASSERT_EQ(one.size(), other.size()) << probes[p].name;
        for (std::size_t i = 0; i < one.size(); ++i)
            EXPECT_NEAR(one[i], other[i], 2e-11) << probes[p].name;
    }
    EXPECT_GT(stops, 700u);
}

TEST(Probe, StoppingAtAPassageBeforeAContactKeepsTheContact) {
    // Extending a run that was stopped at each turning point finds the same impacts.
    Model model = load_model("impact-oscillator");
    const std::vector<Probe> probes = {section_probe(model, "turning"), section_probe(model, "phase0")};
    Simulation simulation(System(model), probes, {}, with_tolerance(1e-14));
    Stopper stopper;
    Trajectory trajectory(simulation, model.parameter_values(), borrowed(stopper));
    JetSet jets(simulation, LaneKind::single);
    trajectory.start(model.initial_state(), 0, 0, 300);
    run(trajectory, jets);
    while (trajectory.outcome().ending == Ending::stopped) {
        trajectory.extend(300);
        run(trajectory, jets);
    }
    Experiment whole(model, with_tolerance(1e-14), probes);
    whole.run(300);
    ASSERT_EQ(stopper.contacts().size(), whole.recorder.contacts().size());
    ASSERT_EQ(stopper.passages().size(), whole.recorder.passages().size());
    for (std::size_t i = 0; i < stopper.contacts().size(); ++i)
        EXPECT_NEAR(stopper.contacts()[i].contact.time, whole.recorder.contacts()[i].contact.time, 1e-10);
}

TEST(CyclicStates, StayWithinTheirPeriodsForAMillionPeriods) {
    // Periods 2 pi and 3, forwards and backwards; the error of the phase is measured against long double arithmetic.
    class Watch : public Observer {
    public:
        void step(const Step& step) override {
            inside = inside && step.states[2][0] >= 0 && step.states[2][0] < 2 * pi && step.states[3][0] >= 0 &&
                     step.states[3][0] < 3;
        }
        bool inside = true;
    };
    for (const double rate : {1.0, -1.0}) {
        const Model model = rotor(rate, 0.37 * rate);
        Simulation simulation(System(model), {}, {}, with_tolerance(1e-14));
        Watch watch;
        Trajectory trajectory(simulation, model.parameter_values(), borrowed(watch));
        const double end = 2 * pi * 1e6 + 1;
        trajectory.start(model.initial_state(), 0, 0, end);
        run(trajectory);
        EXPECT_TRUE(watch.inside);
        const auto error = [](double phase, long double motion, double period) {
            const long double turns = (motion - static_cast<long double>(phase)) / static_cast<long double>(period);
            return static_cast<double>(std::abs(turns - std::round(turns)) * static_cast<long double>(period));
        };
        // Each step may add half a unit of round-off: 3e6 steps give 1e-12 as a random walk, 1e-9 in the worst case.
        EXPECT_LT(error(trajectory.state()[2], static_cast<long double>(rate) * static_cast<long double>(end), 2 * pi),
                  1e-11);
        const auto other = static_cast<long double>(0.37 * rate);
        EXPECT_LT(error(trajectory.state()[3], other * static_cast<long double>(end), 3), 1e-11);
    }
}

} // namespace graze::probe_test
