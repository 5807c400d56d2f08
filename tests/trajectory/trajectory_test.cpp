#include "trajectory/simulate.hpp"

#include "base/message_of.hpp"
#include "closed_form.hpp"
#include "graze/base/input_error.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstring>
#include <numbers>

namespace graze::trajectory_test {

using namespace graze::testing;
using std::numbers::pi;

// ---- closed forms

/// The motion of a linear oscillator x'' + 2 zeta x' + x = cos(omega t) between impacts, in long double.
class ClosedFormOscillator {
public:
    using Number = long double;
    Number zeta, omega, sigma, e;

    /// Returns position and velocity a time s after (x, v) at time t.
    std::pair<Number, Number> at(Number t, Number x, Number v, Number s) const {
        const auto [p0, q0] = forced(t);
        const auto [p, q] = forced(t + s);
        const Number own = std::sqrt(1 - zeta * zeta), decay = std::exp(-zeta * s);
        const Number a = x - p0, b = (v - q0 + zeta * a) / own;
        const std::complex<Number> turn = turned(own * s);
        const Number c = turn.real(), d = turn.imag();
        return {p + decay * (a * c + b * d), q + decay * ((-zeta * a + own * b) * c - (zeta * b + own * a) * d)};
    }
    /// Returns the time to the first impact after s = 0, from a motion that leaves the stop or is clear of it.
    Number flight(Number t, Number x, Number v) const {
        // Impacts here are at a speed, so that none is between points of this mesh.
        const Number mesh = 2 * std::numbers::pi_v<Number> / omega / 400;
        const auto gap = [&](Number s) {
            const auto [position, speed] = at(t, x, v, s);
            return std::pair(sigma - position, -speed);
        };
        Number low = mesh / 10000;
        while (gap(low + mesh).first > 0)
            low += mesh;
        return root_in(gap, low, low + mesh);
    }

private:
    /// Returns the forced oscillation and its rate.
    std::pair<Number, Number> forced(Number t) const {
        const Number real = 1 - omega * omega, imaginary = 2 * zeta * omega;
        const Number size = real * real + imaginary * imaginary;
        const Number a = real / size, b = imaginary / size;
        const std::complex<Number> turn = turned(omega * t);
        return {a * turn.real() + b * turn.imag(), omega * (b * turn.real() - a * turn.imag())};
    }
};

TEST(ImpactOscillator, FollowsItsClosedFormOverAThousandImpacts) {
    Model model =
        shipped_with("impact-oscillator", {{"omega", 2}, {"sigma", 0}, {"zeta", 0.05}, {"e", 0.8}, {"amplitude", 1}});
    Experiment experiment(model, with_tolerance(1e-15));
    std::vector<double> start = {-0.5, 0, 0};
    experiment.run_from(start, 0, 5000);
    // After the motion has settled on an orbit, the closed form starts from the state after an impact.
    const auto& contacts = experiment.recorder.contacts();
    ASSERT_GT(contacts.size(), 1400u);
    const std::size_t first = 300;
    const ClosedFormOscillator exact{static_cast<long double>(0.05), 2, 0, static_cast<long double>(0.8)};
    long double t = contacts[first].contact.time, x = contacts[first].after[0], v = contacts[first].after[1];
    double worst_time = 0, worst_speed = 0;
    for (std::size_t i = first + 1; i <= first + 1000; ++i) {
        ASSERT_EQ(contacts[i].contact.kind, ContactKind::crossing);
        const long double s = exact.flight(t, x, v);
        const auto [position, speed] = exact.at(t, x, v, s);
        t += s;
        x = exact.sigma;
        worst_time = std::max(worst_time, std::abs(static_cast<double>(contacts[i].contact.time - t)));
        worst_speed = std::max(worst_speed, std::abs(static_cast<double>(contacts[i].before[1] - speed)));
        v = -exact.e * speed;
    }
    // Times near 5000 have a resolution of 1e-12.
    EXPECT_LT(worst_time, 1e-11);
    EXPECT_LT(worst_speed, 1e-11);
    EXPECT_NEAR(contacts[first + 1000].before[1], contacts[first + 998].before[1], 1e-10); // the motion is periodic
}

// ---- convergence

Model from_rates(const std::string& states, const std::string& rates) {
    return model_from("[modes.only]\nrates = { " + rates + " }\n[states]\n" + states);
}

double distance(const std::vector<double>& one, const std::vector<double>& other) {
    double sum = 0;
    for (std::size_t i = 0; i < one.size(); ++i)
        sum = std::max(sum, std::abs(one[i] - other[i]));
    return sum;
}

/// Errors at decreasing tolerances must stay below `factor` times the tolerance, plus round-off.
void expect_convergence(const Model& model, double end_time, const std::vector<double>& reference, double factor,
                        double roundoff) {
    double last = 1e300;
    for (double tolerance = 1e-4; tolerance > 0.5e-15; tolerance /= 10) {
        Experiment experiment(model, with_tolerance(tolerance));
        ASSERT_EQ(experiment.run(end_time).ending, Ending::end_time);
        const double error = distance(experiment.state(), reference);
        EXPECT_LE(error, factor * tolerance + roundoff) << "at tolerance " << tolerance;
        EXPECT_LE(error, 3 * last + roundoff) << "at tolerance " << tolerance;
        last = error;
    }
}

TEST(Convergence, HoldsForAKeplerOrbit) {
    // With eccentricity 0.6, after whole periods the planet is at its perihelion again.
    const Model model = from_rates("x = 0.4\ny = 0\nu = 0\nv = 2",
                                   "x = \"u\", y = \"v\", u = \"-x/(x^2+y^2)^1.5\", v = \"-y/(x^2+y^2)^1.5\"");
    expect_convergence(model, 2 * pi * 5, {0.4, 0, 0, 2}, 3e4, 2e-12);
}

TEST(Convergence, HoldsForADuffingOscillator) {
    const Model model = from_rates("x = 1\nv = 0", "x = \"v\", v = \"-x - x^3\"");
    Experiment reference(model, with_tolerance(1e-16));
    reference.run(30);
    expect_convergence(model, 30, reference.state(), 3e3, 1e-12);
}

TEST(Convergence, HoldsThroughImpacts) {
    const Model model = shipped_with("impact-oscillator", {{"omega", 2.8}, {"sigma", 0}, {"zeta", 0.05}});
    Experiment reference(model, with_tolerance(1e-16));
    reference.run(40);
    ASSERT_GT(reference.recorder.contacts().size(), 8u);
    expect_convergence(model, 40, reference.state(), 1e3, 1e-13);
}

TEST(Convergence, HoldsForAllLargestStepsAndOrders) {
    const Model model = shipped_with("impact-oscillator", {{"omega", 2.8}, {"sigma", 0}, {"zeta", 0.05}});
    Experiment reference(model, with_tolerance(1e-16));
    reference.run(40);
    for (const int order : {8, 12, 20, 30})
        for (const double largest : {0.0, 0.1, 0.01}) {
            Experiment experiment(model, {.tolerance = 1e-14, .order = order, .largest_step = largest});
            experiment.run(40);
            EXPECT_LT(distance(experiment.state(), reference.state()), 1e-11) << order << ' ' << largest;
            EXPECT_EQ(experiment.recorder.contacts().size(), reference.recorder.contacts().size());
        }
}

TEST(Reversal, ReturnsToTheStart) {
    const Model forth = from_rates("x = 1\nv = 0.3", "x = \"v\", v = \"-x - x^3\"");
    const Model back = from_rates("x = 1\nv = 0.3", "x = \"-v\", v = \"x + x^3\"");
    Experiment one(forth, with_tolerance(1e-15)), other(back, with_tolerance(1e-15));
    one.run(100);
    other.run_from(one.state(), 0, 100);
    EXPECT_LT(distance(other.state(), {1, 0.3}), 1e-11);
}

TEST(Reversal, RetracesElasticImpacts) {
    // With reversed velocity, elastic bounces are retraced.
    Model model = shipped_with("bouncing-ball", {{"a", 0}, {"e", 1}});
    Experiment experiment(model, with_tolerance(1e-15));
    experiment.run_from({0.05, 0.1, 0}, 0, 10);
    std::vector<double> state = experiment.state();
    state[1] = -state[1];
    const std::size_t impacts = experiment.recorder.contacts().size();
    experiment.run_from(state, 0, 10);
    EXPECT_NEAR(experiment.state()[0], 0.05, 1e-11);
    EXPECT_NEAR(experiment.state()[1], -0.1, 1e-11);
    EXPECT_EQ(experiment.recorder.contacts().size(), impacts);
}

// ---- events at the same time

std::string corner(const std::string& order, const std::string& x = "0.25", const std::string& y = "0.5") {
    return fmt::format(R"(
name = "corner"
states = {{ x = {}, y = {}, u = -1, v = -2 }}
modes.free = {{ rates = {{ x = "u", y = "v", u = 0, v = 0 }}, watch = [{}] }}
events = {{ left = "x", floor = "y" }}
jumps.off_left.u = "-u"
jumps.off_floor.v = "-v"
transitions = [
  {{ label = "L", mode = "free", event = "left", jump = "off_left", next = "free" }},
  {{ label = "F", mode = "free", event = "floor", jump = "off_floor", next = "free" }},
]
)",
                       x, y, order);
}

TEST(Simultaneous, EventsAreHandledInTheOrderOfTheWatchList) {
    for (const auto& [order, labels] : {std::pair{"\"left\", \"floor\"", "LF"}, {"\"floor\", \"left\"", "FL"}}) {
        Experiment experiment(model_from(corner(order)));
        experiment.run(1);
        ASSERT_EQ(experiment.recorder.contacts().size(), 2u);
        EXPECT_EQ(experiment.label(0) + experiment.label(1), labels);
        const auto& first = experiment.recorder.contacts()[0].contact;
        const auto& second = experiment.recorder.contacts()[1].contact;
        EXPECT_EQ(first.time, 0.25);
        EXPECT_EQ(second.time, 0.25);
        EXPECT_FALSE(first.simultaneous);
        EXPECT_TRUE(second.simultaneous);
        EXPECT_EQ(experiment.state(), (std::vector<double>{0.75, 1.5, 1, 2}));
    }
}

TEST(Simultaneous, CornersHitWithinRoundOffReverseTheBall) {
    // In both orders of walls, with times that differ by 0, 1, 2, ... units of round-off, all impacts must reverse the
    // ball.
    for (const char* order : {"\"left\", \"floor\"", "\"floor\", \"left\""})
        for (int units = -20; units <= 20; ++units) {
            const double x = 0.3, y = 0.6 * (1 + units * epsilon);
            Experiment experiment(model_from(corner(order, fmt::format("{:.17g}", x), fmt::format("{:.17g}", y))));
            ASSERT_EQ(experiment.run(1).ending, Ending::end_time);
            ASSERT_EQ(experiment.recorder.contacts().size(), 2u) << units;
            EXPECT_NEAR(experiment.recorder.contacts()[0].contact.time, 0.3, 20 * epsilon);
            EXPECT_LE(experiment.recorder.contacts()[0].contact.time, experiment.recorder.contacts()[1].contact.time);
            EXPECT_LT(distance(experiment.state(), {0.7, 1.4, 1, 2}), 100 * epsilon);
        }
}

TEST(Simultaneous, EarlierEventsComeFirstIfTimesAreResolved) {
    for (const double offset : {1e-13, 1e-12, 1e-10}) {
        for (const bool left_first : {true, false}) {
            const double x = left_first ? 0.25 : 0.25 + offset, y = left_first ? 0.5 + 2 * offset : 0.5;
            for (const char* order : {"\"left\", \"floor\"", "\"floor\", \"left\""}) {
                Experiment experiment(model_from(corner(order, fmt::format("{:.17g}", x), fmt::format("{:.17g}", y))));
                experiment.run(1);
                ASSERT_EQ(experiment.recorder.contacts().size(), 2u);
                EXPECT_EQ(experiment.label(0), left_first ? "L" : "F") << offset;
                EXPECT_FALSE(experiment.recorder.contacts()[1].contact.simultaneous);
            }
        }
    }
}

// ---- the start

Model floor_model(const std::string& x, const std::string& v, const std::string& force, const std::string& extra = "") {
    return model_from(fmt::format(R"(
name = "floor"
states = {{ x = {}, v = {} }}
modes.flight = {{ rates = {{ x = "v", v = "{}" }}, watch = ["floor"] }}
modes.rest = {{ rates = {{ x = 0, v = 0 }} }}
initial.mode = "flight"
events = {{ floor = "x" }}
jumps.impact.v = "-0.5*v"
jumps.land = {{ x = 0, v = 0 }}
transitions = [{{ mode = "flight", event = "floor", jump = "impact", next = "flight"{} }}]
)",
                                  x, v, force, extra));
}

const std::string sticks = R"(, chatter = { jump = "land", mode = "rest" })";

TEST(Start, OnABarrierMovingOutIsNoContact) {
    Experiment experiment(floor_model("0", "1", "-2", sticks));
    experiment.run(0.9);
    EXPECT_TRUE(experiment.recorder.contacts().empty());
    EXPECT_NEAR(experiment.state()[0], 0.9 - 0.81, 1e-15);
    experiment.run(1.1); // returns at 1
    ASSERT_EQ(experiment.recorder.contacts().size(), 1u);
    EXPECT_NEAR(experiment.recorder.contacts()[0].contact.time, 1, 4 * epsilon);
}

TEST(Start, OnABarrierMovingInIsAContactAtOnce) {
    Experiment experiment(floor_model("0", "-1", "0", sticks));
    experiment.run(1);
    ASSERT_EQ(experiment.recorder.contacts().size(), 1u);
    EXPECT_EQ(experiment.recorder.contacts()[0].contact.time, 0);
    EXPECT_EQ(experiment.recorder.contacts()[0].contact.rate_before, -1);
    EXPECT_EQ(experiment.recorder.contacts()[0].contact.rate_after, 0.5);
    EXPECT_EQ(experiment.state(), (std::vector<double>{0.5, 0.5}));
}

TEST(Start, OnABarrierGrazingIsNoContact) {
    Experiment experiment(floor_model("0", "0", "2", sticks));
    experiment.run(1);
    for (const auto& record : experiment.recorder.contacts())
        EXPECT_EQ(record.contact.kind, ContactKind::touch);
    EXPECT_NEAR(experiment.state()[0], 1, 2 * epsilon);
}

TEST(Start, PressedOntoABarrierSticks) {
    Experiment experiment(floor_model("0", "0", "-2", sticks));
    EXPECT_EQ(experiment.run(1).ending, Ending::end_time);
    EXPECT_EQ(experiment.trajectory.mode(), 1u);
    EXPECT_EQ(experiment.state(), (std::vector<double>{0, 0}));
    ASSERT_FALSE(experiment.recorder.contacts().empty());
    EXPECT_EQ(experiment.recorder.contacts().back().contact.kind, ContactKind::sticking);
    EXPECT_EQ(experiment.recorder.contacts().back().contact.time, 0);
}

TEST(Start, AtRestOnABarrierWithoutForceStays) {
    Experiment experiment(floor_model("0", "0", "0", sticks));
    EXPECT_EQ(experiment.run(1).ending, Ending::end_time);
    EXPECT_EQ(experiment.state(), (std::vector<double>{0, 0}));
}

TEST(Start, RepeatedGivesTheSameBits) {
    const Model model = load_model("electromagnetic-testbed");
    Experiment experiment(model, {}, {section_probe(model, "phase0")});
    experiment.run(3);
    const auto state = experiment.state();
    std::vector<double> times;
    for (const auto& record : experiment.recorder.contacts())
        times.push_back(record.contact.time);
    const std::size_t steps = experiment.trajectory.steps();
    experiment.run(1.7); // another run in between
    experiment.run(3);
    EXPECT_EQ(std::memcmp(experiment.state().data(), state.data(), state.size() * sizeof(double)), 0);
    EXPECT_EQ(experiment.trajectory.steps(), steps);
    ASSERT_EQ(experiment.recorder.contacts().size(), times.size());
    for (std::size_t i = 0; i < times.size(); ++i)
        EXPECT_EQ(experiment.recorder.contacts()[i].contact.time, times[i]);
}

TEST(Start, RefusesInvalidInput) {
    const Model model = load_model("bouncing-ball");
    Experiment experiment(model);
    const double nan = std::numeric_limits<double>::quiet_NaN();
    EXPECT_THAT(message_of([&] {
                    experiment.trajectory.start(std::vector<double>{1, nan, 0}, 0, 0, 1);
                }),
                ::testing::HasSubstr("'v'"));
    experiment.run(1);
    EXPECT_THROW(experiment.trajectory.extend(nan), InputError);
    EXPECT_THROW(experiment.trajectory.extend(0.5), InputError);
    EXPECT_EQ(experiment.go_on(2).ending, Ending::end_time);
}

TEST(Extend, ContinuesWithoutAnyEffectOnTheMotion) {
    const Model model = shipped_with("impact-oscillator", {{"omega", 2}, {"sigma", 0}, {"zeta", 0.05}});
    Experiment whole(model, with_tolerance(1e-15), {section_probe(model, "phase0")}),
        parts(model, with_tolerance(1e-15), {section_probe(model, "phase0")});
    whole.run(60);
    parts.run(0.1);
    for (int i = 2; i <= 600; ++i)
        ASSERT_EQ(parts.go_on(0.1 * i).ending, Ending::end_time);
    ASSERT_EQ(parts.recorder.contacts().size(), whole.recorder.contacts().size());
    ASSERT_EQ(parts.recorder.passages().size(), whole.recorder.passages().size());
    for (std::size_t i = 0; i < whole.recorder.contacts().size(); ++i)
        EXPECT_NEAR(parts.recorder.contacts()[i].contact.time, whole.recorder.contacts()[i].contact.time, 1e-11);
    EXPECT_LT(distance(parts.state(), whole.state()), 1e-11);
}

TEST(Extend, FromAnEndAtAContactRepeatsNoContact) {
    // The end is exactly the time of an impact, which must occur once.
    Experiment experiment(floor_model("1", "-1", "0", sticks));
    experiment.run(1);
    experiment.go_on(1);
    experiment.go_on(2);
    ASSERT_EQ(experiment.recorder.contacts().size(), 1u);
    EXPECT_EQ(experiment.recorder.contacts()[0].contact.time, 1);
    EXPECT_EQ(experiment.state(), (std::vector<double>{0.5, 0.5}));
}

// ---- guards

std::string guarded(const std::string& next) {
    return fmt::format(R"(
name = "guarded"
parameters = {{ limit = 1 }}
states = {{ x = 1, v = {{ initial = -1 }} }}
modes.flight = {{ rates = {{ x = "v", v = 0 }}, watch = ["floor"] }}
modes.slow = {{ rates = {{ x = 0, v = 0 }}, watch = [] }}
initial.mode = "flight"
events.floor.function = "x"
jumps.impact.v = "-v"
transitions = [{{ label = "landing", mode = "flight", event = "floor", jump = "impact", next = {} }}]
)",
                       next);
}

TEST(Guards, ChooseTheFirstAlternativeWhoseConditionsHold) {
    // Conditions are evaluated after the jump: v = 1.
    struct Case {
        const char* next;
        const char* mode;
    };
    const Case cases[] = {
        {R"([{ when = "v > limit", mode = "slow" }, { mode = "flight" }])", "flight"}, // strict
        {R"([{ when = "v >= limit", mode = "slow" }, { mode = "flight" }])", "slow"},  // not strict
        {R"([{ when = "v > 0 and x < 0.5", mode = "slow" }, { mode = "flight" }])", "slow"},
        {R"([{ when = "v > 0 and v < 0.5", mode = "slow" }, { mode = "flight" }])", "flight"},
        {R"([{ mode = "flight" }, { when = "v > 0", mode = "slow" }])", "flight"},
    };
    for (const Case& one : cases) {
        Experiment experiment(model_from(guarded(one.next)));
        experiment.run(2);
        EXPECT_EQ(experiment.simulation.model().modes[experiment.trajectory.mode()].name, one.mode) << one.next;
    }
}

// ---- endings

TEST(Endings, HaveStableNames) {
    EXPECT_EQ(name_of(Ending::end_time), "end-time");
    EXPECT_EQ(name_of(Ending::singular), "singular");
    EXPECT_EQ(name_of(Ending::no_separation), "no-separation");
    EXPECT_TRUE(is_regular(Ending::singular));
    EXPECT_FALSE(is_regular(Ending::undefined));
}

TEST(Endings, TerminalTransitionsEndTheMotion) {
    Experiment experiment(model_from(guarded("\"end\"")));
    const Outcome outcome = experiment.run(5);
    EXPECT_EQ(outcome.ending, Ending::terminal);
    EXPECT_EQ(outcome.time, 1);
    EXPECT_EQ(outcome.detail, "");
    EXPECT_EQ(experiment.state(), (std::vector<double>{0, 1}));
    EXPECT_EQ(experiment.recorder.contacts().size(), 1u);
}

void expect_ending(const Model& model, Ending ending, double time, std::initializer_list<const char*> words,
                   double accuracy = 1e-12, SimulationOptions options = {}) {
    Experiment experiment(model, options);
    const Outcome outcome = experiment.run(10);
    EXPECT_EQ(outcome.ending, ending) << name_of(outcome.ending) << ": " << outcome.detail;
    EXPECT_NEAR(outcome.time, time, accuracy);
    for (const char* word : words)
        EXPECT_NE(outcome.detail.find(word), std::string::npos) << "no " << word << " in: " << outcome.detail;
    for (const double x : experiment.state())
        EXPECT_TRUE(std::isfinite(x));
}

TEST(Endings, NoConditionHoldsAfterAnEvent) {
    expect_ending(model_from(guarded(R"([{ when = "v > 3", mode = "slow" }])")), Ending::no_transition, 1,
                  {"landing", "flight", "floor"});
}

TEST(Endings, ViolatedBarriersAreInadmissible) {
    expect_ending(floor_model("-0.1", "1", "-2"), Ending::inadmissible, 0, {"floor", "flight"});
    // By a jump beyond the barrier.
    Model model = floor_model("1", "-1", "0", sticks);
    model.jumps[model.find_jump("impact").value()].map[0] = model.graph->number(-0.25);
    expect_ending(model, Ending::inadmissible, 1, {"floor", "-0.25"});
}

TEST(Endings, BarriersStillApproachedAreReported) {
    Model model = floor_model("1", "-1", "0", sticks);
    model.jumps[model.find_jump("impact").value()].map[1] = model.symbol("v") * 0.5; // does not reverse the speed
    expect_ending(model, Ending::no_separation, 1, {"floor", "flight"});
}

TEST(Endings, ChatterWithoutASticking) {
    // Heights 1, 1/4, ...: falls with g = 2 from 1, at rest after 1 + 2 (1/2 + 1/4 + ...) = 3.
    expect_ending(floor_model("1", "0", "-2"), Ending::chatter, 3, {"floor", "flight", "chatter"}, 1e-9);
    Experiment sticking(floor_model("1", "0", "-2", sticks));
    EXPECT_EQ(sticking.run(10).ending, Ending::end_time);
    EXPECT_NEAR(sticking.recorder.contacts().back().contact.time, 3, 1e-11);
}

TEST(Endings, EndlessEventsAtOneTimeMakeNoProgress) {
    const Model model = model_from(R"(
name = "circle"
states = { x = 1 }
modes.one = { rates = { x = -1 }, watch = ["zero"] }
modes.other = { rates = { x = -1 }, watch = ["zero_too"] }
initial.mode = "one"
events = { zero = "x", zero_too = "x" }
transitions = [
  { mode = "one", event = "zero", next = "other" },
  { mode = "other", event = "zero_too", next = "one" },
]
)");
    expect_ending(model, Ending::no_progress, 1, {"one", "circle"});
    Experiment experiment(model);
    experiment.run(10);
    EXPECT_EQ(experiment.recorder.contacts().size(), 101u); // all are reported to the observer
}

TEST(Endings, UndefinedRatesAtTheStartAreReported) {
    expect_ending(from_rates("x = 0\ny = 1", "x = 1, y = \"1/x\""), Ending::undefined, 0, {"'y'", "only"});
    expect_ending(from_rates("x = -1\ny = 1", "x = 1, y = \"log(x)\""), Ending::undefined, 0, {"'y'", "only"});
    expect_ending(from_rates("x = -1\ny = 1", "x = 1, y = \"sqrt(x)\""), Ending::undefined, 0, {"'y'", "only"});
    expect_ending(from_rates("x = 2\ny = 1", "x = \"asin(x)\", y = 1"), Ending::undefined, 0, {"'x'", "only"});
}

TEST(Endings, UndefinedEventFunctionsAreReported) {
    Model model = floor_model("1", "-1", "0", sticks);
    model.events[0].function = log(model.symbol("x") - 2);
    expect_ending(model, Ending::undefined, 0, {"'floor'", "flight"});
}

TEST(Endings, UndefinedRatesInTheModeAfterAJumpAreReported) {
    // The contact is reported nevertheless.
    Model model = floor_model("1", "-1", "0", sticks);
    model.jumps[model.find_jump("impact").value()].map[0] = model.graph->number(0.5);
    model.modes[0].rates[1] = log(-model.symbol("v"));
    expect_ending(model, Ending::undefined, 1, {"'v'", "flight"}, 1);
}

TEST(Endings, UndefinedStatesAfterAJumpAreReported) {
    Model model = floor_model("1", "-1", "0", sticks);
    model.jumps[model.find_jump("impact").value()].map[1] = 1 / model.symbol("x");
    Experiment experiment(model);
    const Outcome outcome = experiment.run(10);
    EXPECT_TRUE(outcome.ending == Ending::undefined || !std::isfinite(1 / experiment.state()[0]))
        << name_of(outcome.ending);
    Model log_model = floor_model("1", "-1", "0", sticks);
    log_model.jumps[log_model.find_jump("impact").value()].map[1] = log(log_model.symbol("v"));
    expect_ending(log_model, Ending::undefined, 1, {"impact", "'v'"});
}

TEST(Endings, PolesAreSingular) {
    // x' = x^2 from 1: x = 1/(1 - t).
    expect_ending(from_rates("x = 1\ny = 0", "x = \"x^2\", y = 1"), Ending::singular, 1, {}, 1e-12);
    // y = -log(1 - t) through 1/x with x = 1 - t.
    expect_ending(from_rates("x = 1\ny = 0", "x = -1, y = \"1/x\""), Ending::singular, 1, {}, 1e-12);
}

TEST(Endings, UndefinedRatesBeyondAZeroAreSingular) {
    expect_ending(from_rates("x = 1\ny = 0", "x = -1, y = \"log(x)\""), Ending::singular, 1, {}, 1e-12);
    // Where rates stay finite the solution does not end, but the model is undefined beyond.
    expect_ending(from_rates("x = 1\ny = 0", "x = -1, y = \"sqrt(x)\""), Ending::undefined, 1, {"'y'", "root"}, 1e-12);
    expect_ending(from_rates("x = 1\ny = 0", "x = -1, y = \"x^1.5\""), Ending::undefined, 1, {"'y'", "power"}, 1e-12);
    expect_ending(from_rates("x = 1\ny = 0", "x = \"-1/x\", y = \"sqrt(x)\""), Ending::singular, 0.5, {}, 1e-12);
    // x^2 = 1 - 2 t has an infinite rate at t = 1/2.
    expect_ending(from_rates("x = 1", "x = \"-1/x\""), Ending::singular, 0.5, {}, 1e-12);
}

TEST(Endings, RootsThatReachZeroSmoothlyAreDetected) {
    // The series of (1 - t/2)^2 does not show that the rate -sqrt(x) is undefined after t = 2.
    const Model model = from_rates("x = 1\ny = 0", "x = \"-sqrt(x)\", y = \"cos(y)\"");
    Experiment experiment(model);
    const Outcome outcome = experiment.run(100);
    EXPECT_EQ(outcome.ending, Ending::undefined);
    EXPECT_NE(outcome.detail.find("'x'"), std::string::npos) << outcome.detail;
    EXPECT_NEAR(outcome.time, 2, 1e-11);
    EXPECT_EQ(experiment.run(1.9).ending, Ending::end_time);
    EXPECT_EQ(experiment.run(2.1).ending, Ending::undefined);
    // Roots of positive radicands have no effect.
    for (const double tolerance : {1e-2, 1e-4, 1e-9, 1e-16}) {
        Experiment pendulum(from_rates("x = 1\nv = 0", "x = \"v\", v = \"-x*sqrt(1 + x^2) - x*(2 + v)^0.3\""),
                            with_tolerance(tolerance));
        EXPECT_EQ(pendulum.run(300).ending, Ending::end_time) << tolerance;
    }
}

TEST(Endings, AnEventBeforeTheSingularityEndsTheMotion) {
    // Draining a tank: x = (1 - t/2)^2 while x > 0; the event at the bottom ends the motion.
    const Model model = model_from(R"toml(
name = "tank"
states = { x = 1 }
modes.draining = { rates = { x = "-sqrt(x)" }, watch = ["low"] }
events = { low = "x - 1e-6" }
transitions = [{ mode = "draining", event = "low", next = "end" }]
)toml");
    expect_ending(model, Ending::terminal, 2 * (1 - 1e-3), {}, 1e-11);
}

TEST(Endings, TooManyStepsReachTheLimit) {
    Experiment experiment(from_rates("x = 1\nv = 0", "x = \"v\", v = \"-x\""), {.step_limit = 20});
    const Outcome outcome = experiment.run(1e6);
    EXPECT_EQ(outcome.ending, Ending::step_limit);
    EXPECT_EQ(experiment.trajectory.steps(), 20u);
    EXPECT_NE(outcome.detail.find("20 steps"), std::string::npos);
}

TEST(Endings, TheObserverCanStopTheMotion) {
    class Stopper : public Observer {
    public:
        void contact(const Contact&) override { ++contacts; }
        bool stop() override { return contacts >= 3; }
        int contacts = 0;
    } stopper;
    const Model model = shipped_with("impact-oscillator", {{"omega", 2.8}, {"sigma", 0}});
    Simulation simulation{System(model)};
    Trajectory trajectory(simulation, model.parameter_values(), borrowed(stopper));
    trajectory.start(model.initial_state(), 0, 0, 1000);
    run(trajectory);
    EXPECT_EQ(trajectory.outcome().ending, Ending::stopped);
    EXPECT_EQ(stopper.contacts, 3);
    Experiment whole(model);
    whole.run(1000);
    EXPECT_EQ(trajectory.time(), whole.recorder.contacts()[2].contact.time); // the next arc has not begun
    EXPECT_EQ(trajectory.state()[1], whole.recorder.contacts()[2].after[1]);
}

// ---- singular ends

TEST(Singular, TimesOfKnownBlowUpsAreExact) {
    // x' = 1 + x^2 has the solution tan t, singular at pi/2. Also far from t = 0, where the resolution of time is
    // lower.
    for (const double start : {0.0, 1000.0}) {
        const Model model = from_rates("x = 0", "x = \"1 + x^2\"");
        Simulation simulation(System(model), {}, {}, with_tolerance(1e-14));
        Trajectory trajectory(simulation, model.parameter_values());
        trajectory.start(std::vector<double>{0}, 0, start, start + 10);
        run(trajectory);
        EXPECT_EQ(trajectory.outcome().ending, Ending::singular);
        EXPECT_NEAR(trajectory.outcome().time, start + pi / 2, 1e-13 * (1 + start));
    }
}

TEST(Singular, FastMotionAtALateTimeIsNotSingular) {
    // Steps are short relative to the time, but do not shrink.
    const Model model = from_rates("x = 1\nv = 0", "x = \"1e6*v\", v = \"-1e6*x\"");
    Simulation simulation(System(model), {}, {}, with_tolerance(1e-14));
    Trajectory trajectory(simulation, model.parameter_values());
    trajectory.start(std::vector<double>{1, 0}, 0, 1e9, 1e9 + 1e-4);
    run(trajectory);
    EXPECT_EQ(trajectory.outcome().ending, Ending::end_time);
}

} // namespace graze::trajectory_test
