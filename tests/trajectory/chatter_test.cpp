// Infinitely many contacts in a finite time: accumulations that complete, and some that do not.

#include "closed_form.hpp"
#include "simulate.hpp"

#include <gtest/gtest.h>

#include <numbers>

using namespace graze;
using namespace graze::testing;

namespace chatter_test {

using Real = long double;

/// Records the lowest value of every watched event function, sticking and releases.
struct Watcher : Observer {
    double lowest = std::numeric_limits<double>::infinity();
    std::vector<double> crossings, stickings, phases_of_release;
    std::vector<std::size_t> transitions;
    void minimum(const StepMinimum& minimum) override { lowest = std::min(lowest, minimum.minimum.value); }
    void contact(const Contact& contact) override {
        if (contact.kind == ContactKind::touch)
            return;
        (contact.kind == ContactKind::sticking ? stickings : crossings).push_back(contact.time);
        transitions.push_back(contact.transition);
    }
};

struct Watched {
    Watched(const Model& model, std::span<const double> state, double end_time, double tolerance = 1e-12,
            std::size_t mode = 0)
        : simulation(System(model), {}, {}, options(tolerance)),
          trajectory(simulation, model.parameter_values(), borrowed(watcher)), jets(simulation, LaneKind::single) {
        trajectory.start(state, mode, 0, end_time);
        graze::run(trajectory, jets);
    }
    static SimulationOptions options(double tolerance) {
        SimulationOptions result = with_tolerance(tolerance);
        result.minima = true;
        return result;
    }
    const std::string& mode() const { return simulation.model().modes[trajectory.mode()].name; }

    Watcher watcher;
    Simulation simulation;
    Trajectory trajectory;
    JetSet jets;
};

Model ball_on_floor(double e, double g = 9.81) {
    return shipped_with("bouncing-ball", {{"e", e}, {"a", 0}, {"g", g}});
}

/// Heights above a floor with x'' = -(g - b t), in closed form between impacts.
struct FadingGravity {
    Real g, b, e;
    Real time = 0, gap = 0, speed = 0; ///< just after the last impact
    /// Flight to the next impact; none when the motion is pulled away from the floor.
    bool next() {
        const Real pull = g - b * time;
        const Real discriminant = pull * pull / 4 - 2 * speed * b / 3;
        if (!(pull > 0) || discriminant < 0)
            return false;
        margin = std::min(margin, discriminant / (pull * pull));
        const Real flight = 2 * speed / (pull / 2 + std::sqrt(discriminant));
        const Real arrival = -speed + pull * flight - b * flight * flight / 2;
        time += flight;
        speed = e * arrival;
        return true;
    }
    Real margin = 1;
};

constexpr const char* fading_gravity = R"toml(
name = "fading-gravity"
parameters = { g = 1, b = 0.1, e = 0.5, height = 0 }
states = { x = "height", v = 1, clock = 0 }
modes.flight = { rates = { x = "v", v = "-(g - b*clock)", clock = 1 }, watch = ["floor"] }
modes.rest = { rates = { x = 0, v = 0, clock = 1 }, watch = ["release"] }
initial.mode = "flight"
events = { floor = "x - height", release = "g - b*clock" }
jumps.impact.v = "-e*v"
jumps.land = { x = "height", v = 0 }
transitions = [
  { mode = "flight", event = "floor", jump = "impact", next = "flight", chatter = { jump = "land", mode = "rest" } },
  { mode = "rest", event = "release", jump = "land", next = "end" },
]
)toml";

TEST(Chatter, BallsComeToRestAtTheClosedFormTime) {
    for (const double e : {0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 0.95, 0.99})
        for (const double tolerance : {1e-6, 1e-9, 1e-12, 1e-15})
            for (const double height : {1e-3, 1.0, 250.0}) {
                SCOPED_TRACE(fmt::format("e = {}, tolerance {}, height {}", e, tolerance, height));
                const double g = 9.81;
                const double rest = std::sqrt(2 * height / g) * (1 + e) / (1 - e);
                const Watched run(ball_on_floor(e), std::vector{height, 0.0, 0.0}, 5 * rest, tolerance);
                EXPECT_EQ(run.trajectory.outcome().ending, Ending::end_time) << run.trajectory.outcome().detail;
                ASSERT_EQ(run.watcher.stickings.size(), 1U);
                EXPECT_NEAR(run.watcher.stickings[0], rest, 1e-12 * rest);
                EXPECT_GE(run.watcher.lowest, -4 * epsilon * height);
                EXPECT_EQ(run.mode(), "rest");
                EXPECT_EQ(run.trajectory.state()[0], 0);
                EXPECT_EQ(run.trajectory.state()[1], 0);
                // Impact n occurs at sqrt(2 h / g) (1 + 2 e (1 - e^n) / (1 - e)).
                for (std::size_t n = 0; n < run.watcher.crossings.size(); ++n) {
                    const double fallen = std::sqrt(2 * height / g);
                    const double expected = fallen * (1 + 2 * e * (1 - std::pow(e, n)) / (1 - e));
                    ASSERT_NEAR(run.watcher.crossings[n], expected, 1e-12 * rest) << n;
                }
            }
}

TEST(Chatter, RandomBallsComeToRestAndNeverPassTheFloor) {
    Random random(11);
    long late = 0, below = 0, other = 0;
    double worst = 0, lowest = 0;
    for (int i = 0; i < 3000; ++i) {
        const double e = random.uniform(0, 0.95), g = random.log_uniform(1e-2, 1e3);
        const double height = random.chance(0.1) ? 0 : random.log_uniform(1e-6, 1e3), v = random.uniform(0, 10);
        const Real speed = std::sqrt(Real(v) * v + 2 * Real(g) * height);
        const Real rest = (v + speed) / g + 2 * e * speed / (g * (1 - Real(e)));
        const double scale = std::max(height, v * v / g);
        const Watched run(ball_on_floor(e, g), std::vector{height, v, 0.0}, static_cast<double>(1.5L * rest),
                          random.log_uniform(1e-15, 1e-6));
        if (run.watcher.stickings.size() + (e == 0) != 1 || run.mode() != "rest") {
            ++other;
            continue;
        }
        const double error = static_cast<double>(std::abs(run.watcher.stickings[0] - rest) / rest);
        worst = std::max(worst, error);
        lowest = std::min(lowest, run.watcher.lowest / scale);
        late += error > 1e-12;
        below += run.watcher.lowest < -8 * epsilon * scale;
    }
    EXPECT_EQ(other, 0);
    EXPECT_EQ(late, 0) << worst;
    EXPECT_EQ(below, 0) << lowest;
}

TEST(Chatter, CompletelyInelasticBallsRestAtOnce) {
    const double g = 9.81, height = 0.7;
    const Watched run(ball_on_floor(0), std::vector{height, 0.0, 0.0}, 10);
    EXPECT_EQ(run.trajectory.outcome().ending, Ending::end_time);
    EXPECT_EQ(run.mode(), "rest");
    ASSERT_EQ(run.watcher.crossings.size(), 1U);
    EXPECT_NEAR(run.watcher.crossings[0], std::sqrt(2 * height / g), 4 * epsilon);
}

TEST(Chatter, AMotionThatStartsPressedAgainstTheSurfaceSticks) {
    // A force cos(theta) presses the mass at sigma = 0.1 against the stop until it equals the spring force.
    for (const double theta : {0.0, 0.3, 1.2, 5.0}) {
        const Watched run(load_model("impact-oscillator"), std::vector{0.1, 0.0, theta}, 2);
        ASSERT_EQ(run.watcher.crossings.size(), 2U) << theta;
        EXPECT_EQ(run.watcher.crossings[0], 0);
        const double phase = theta > 3 ? theta - 2 * std::numbers::pi : theta;
        EXPECT_NEAR(run.watcher.crossings[1], (std::acos(0.1) - phase) / 2.5, 1e-14);
    }
    const Watched ball(ball_on_floor(0.5), std::vector{0.0, 0.0, 0.0}, 1);
    EXPECT_EQ(ball.mode(), "rest");
    // Without alternatives in the transition, the zero speed decides that it sticks.
    const Watched fading(model_from(fading_gravity), std::vector{0.0, 0.0, 0.0}, 20);
    EXPECT_EQ(fading.watcher.stickings, std::vector{0.0});
    EXPECT_EQ(fading.trajectory.outcome().ending, Ending::terminal);
    EXPECT_NEAR(fading.trajectory.outcome().time, 10, 1e-14);
}

TEST(Chatter, RestOnAVibratingTableEndsWhereItFallsFasterThanGravity) {
    Random random(12);
    for (int i = 0; i < 300; ++i) {
        const double g = 9.81, f = random.uniform(2, 40), omega = 2 * std::numbers::pi * f;
        const double a = g / (omega * omega) * random.uniform(1.05, 3), e = random.uniform(0.1, 0.6);
        Model model = shipped_with("bouncing-ball", {{"e", e}, {"a", a}, {"f", f}});
        SCOPED_TRACE(fmt::format("a = {}, f = {}, e = {}", a, f, e));
        Experiment experiment(model);
        const Outcome outcome = experiment.run_from({random.uniform(1, 4) * a, 0, 0}, 0, 60 / f);
        EXPECT_EQ(outcome.ending, Ending::end_time) << outcome.detail;
        for (std::size_t k = 0; k < experiment.recorder.contacts().size(); ++k) {
            const auto& contact = experiment.recorder.contacts()[k];
            if (experiment.label(k) != "release" || contact.contact.time == 0)
                continue;
            // A ball that sticks just where the table releases it rests for no time.
            const double phase = std::asin(g / (a * omega * omega));
            EXPECT_NEAR(contact.after[2], phase, 1e-11) << contact.contact.time;
        }
    }
}

TEST(Chatter, AccumulationsUnderFadingGravityAreCompletedOnlyIfReal) {
    Random random(13);
    const Model model = model_from(fading_gravity);
    std::vector<std::unique_ptr<Simulation>> simulations;
    for (const double tolerance : {1e-6, 1e-9, 1e-12, 1e-15})
        simulations.push_back(std::make_unique<Simulation>(System(model), std::vector<Probe>{},
                                                           std::vector<Expression>{}, Watched::options(tolerance)));
    int completed = 0, escaped = 0, undecided = 0;
    double worst_impact = 0;
    for (int i = 0; i < 10000; ++i) {
        const Simulation& simulation = *simulations[static_cast<std::size_t>(i % 4)];
        const double e = random.uniform(0.1, 0.9), height = i % 3 == 0 ? 0 : i % 3 == 1 ? 0.1 : 123.456;
        // Without fading, a ball thrown up at speed 1 rests at 2 / (1 - e); gravity fades near that time.
        const double b = (1 - e) / 2 *
                         (random.chance(0.5) ? 1 + random.log_uniform(1e-6, 1) * (random.chance(0.5) ? 1 : -1)
                                             : random.uniform(0.05, 0.6));
        FadingGravity reference{1, b, e, 0, 0, 1};
        std::vector<Real> impacts;
        while (reference.next() && reference.speed > 1e-18L && impacts.size() < 5000)
            impacts.push_back(reference.time);
        const bool completes = reference.speed <= 1e-18L;
        if (!completes && impacts.size() > 4000)
            continue;
        Watcher watcher;
        Trajectory trajectory(simulation, std::vector{1.0, b, e, height}, borrowed(watcher));
        trajectory.start(std::vector{height, 1.0, 0.0}, 0, 0, 3 / b);
        run(trajectory);
        const std::string label =
            fmt::format("e={} b={} height={} tol={}", e, b, height, simulation.options().tolerance);
        // Whether the last of many impacts occurs may depend on the last digit.
        if (reference.margin < 1e-4L) {
            ++undecided;
            continue;
        }
        if (completes) {
            ++completed;
            ASSERT_EQ(trajectory.outcome().ending, Ending::terminal) << label << trajectory.outcome().detail;
            ASSERT_EQ(watcher.stickings.size(), 1U) << label;
            const Real error = std::abs(watcher.stickings[0] - impacts.back()) / impacts.back();
            ASSERT_LT(error, 2e-4L * simulation.options().tolerance + 1e-15L * (10 + 3 * height)) << label;
        } else {
            ++escaped;
            ASSERT_EQ(trajectory.outcome().ending, Ending::end_time) << label << trajectory.outcome().detail;
            ASSERT_TRUE(watcher.stickings.empty()) << label;
            ASSERT_EQ(watcher.crossings.size(), impacts.size()) << label;
        }
        for (std::size_t k = 0; k + completes < watcher.crossings.size() && k < impacts.size(); ++k)
            worst_impact = std::max(worst_impact, static_cast<double>(std::abs(watcher.crossings[k] - impacts[k])));
        ASSERT_GE(watcher.lowest, -8 * epsilon * (1 + height)) << label;
    }
    EXPECT_GT(completed, 2000);
    EXPECT_GT(escaped, 2000);
    EXPECT_LT(undecided, 20);
    EXPECT_LT(worst_impact, 1e-11);
}

TEST(Chatter, WithoutAStickingModeTheTrajectoryEndsAtTheAccumulation) {
    const Model model = model_from(R"toml(
name = "ball"
parameters = { e = 0.7 }
states = { x = 1, v = 0 }
modes.flight = { rates = { x = "v", v = -2 }, watch = ["floor"] }
events = { floor = "x" }
jumps.impact.v = "-e*v"
transitions = [{ mode = "flight", event = "floor", jump = "impact", next = "flight" }]
)toml");
    for (const double tolerance : {1e-6, 1e-12}) {
        const Watched run(model, std::vector{1.0, 0.0}, 100, tolerance);
        EXPECT_EQ(run.trajectory.outcome().ending, Ending::chatter);
        EXPECT_NEAR(run.trajectory.outcome().time, 1.7 / 0.3, 1e-13);
        EXPECT_NE(run.trajectory.outcome().detail.find("chatter = {"), std::string::npos);
    }
}

TEST(Chatter, OtherEventsBetweenContactsDoNotHideAnAccumulation) {
    // After each impact a second mode governs for a time proportional to the speed, like a frame that slips after an
    // impact. The flights are those of a plain ball.
    const Model model = model_from(R"toml(
name = "ball-with-slip"
parameters = { e = 0.7, friction = 5 }
states = { x = 1, v = 0, slip = 0, path = 0 }
modes.flight = { rates = { x = "v", v = -2, slip = 0, path = 0 }, watch = ["floor"] }
modes.slipping = { rates = { x = "v", v = -2, slip = "-friction", path = "slip" }, watch = ["floor", "stop"] }
modes.rest = { rates = { x = 0, v = 0, slip = 0, path = 0 } }
initial.mode = "flight"
events = { floor = "x", stop = "slip" }
jumps.impact = { v = "-e*v", slip = "slip - v" }
jumps.stop.slip = 0
jumps.land = { x = 0, v = 0, slip = 0 }
transitions = [
  { mode = "flight", event = "floor", jump = "impact", next = "slipping", chatter = { jump = "land", mode = "rest" } },
  { mode = "slipping", event = "floor", jump = "impact", next = "slipping" },
  { mode = "slipping", event = "stop", jump = "stop", next = "flight" },
]
)toml");
    for (const double tolerance : {1e-6, 1e-9, 1e-12, 1e-15}) {
        SCOPED_TRACE(tolerance);
        const Watched run(model, std::vector{1.0, 0.0, 0.0, 0.0}, 100, tolerance);
        EXPECT_EQ(run.trajectory.outcome().ending, Ending::end_time) << run.trajectory.outcome().detail;
        EXPECT_EQ(run.mode(), "rest");
        ASSERT_EQ(run.watcher.stickings.size(), 1U);
        EXPECT_NEAR(run.watcher.stickings[0], 1.7 / 0.3, 1e-12);
        // Impact n at the speed 2 e^n causes a slip of (2 e^n)^2 / 10.
        EXPECT_NEAR(run.trajectory.state()[3], 0.4 / (1 - 0.49), 0.1 * tolerance + 1e-13);
    }
}

/// Falling balls have no acceleration relative to each other but round-off, and other contacts lie between theirs.
TEST(Chatter, ElasticBallsAboveEachOtherKeepTheirEnergy) {
    Random random(15);
    for (int i = 0; i < 40; ++i) {
        const int balls = random.integer(2, 4);
        std::string states = "[states]\n", rates, velocities, masses, contacts;
        std::vector<double> mass;
        double height = 0, energy = 0;
        for (int k = 0; k < balls; ++k) {
            height += random.uniform(0.1, 1);
            mass.push_back(random.log_uniform(0.1, 10));
            energy += mass.back() * height;
            states += fmt::format("q{0} = {1:.17g}\nv{0} = 0\n", k, height);
            rates +=
                fmt::format("{1}q{0} = \"v{0}\", v{0} = \"-{2:.17g}/{2:.17g}\"", k, k > 0 ? ", " : "", mass.back());
            velocities += fmt::format("{1}\"v{0}\"", k, k > 0 ? ", " : "");
            masses += fmt::format("{1}{0:.17g}", mass.back(), k > 0 ? ", " : "");
            contacts += fmt::format("[contacts.c{0}]\ngap = \"q{0}{1}\"\nrestitution = 1\n", k,
                                    k > 0 ? fmt::format(" - q{}", k - 1) : "");
        }
        const char* const laws[] = {"newton", "moreau", "sequence", "poisson"};
        Experiment experiment(model_from(fmt::format(
            "name = \"column\"\n{}[modes.free]\nrates = {{ {} }}\n[contacts]\nvelocities = [{}]\nmass = [{}]\nlaw = "
            "\"{}\"\n{}[initial]\nmode = \"free\"\n",
            states, rates, velocities, masses, laws[balls == 4 ? i % 3 : i % 4], contacts)));
        const Outcome outcome = experiment.run(8);
        ASSERT_EQ(outcome.ending, Ending::end_time) << i << outcome.detail;
        double now = 0;
        for (std::size_t k = 0; k < mass.size(); ++k) {
            const double q = experiment.state()[2 * k], v = experiment.state()[2 * k + 1];
            now += mass[k] * (q + 0.5 * v * v);
            EXPECT_GE(q, k > 0 ? experiment.state()[2 * k - 2] - 1e-12 : -1e-12) << i;
        }
        EXPECT_NEAR(now, energy, 1e-9 * energy) << i;
        for (const auto& one : experiment.recorder.contacts())
            EXPECT_NE(one.contact.kind, ContactKind::sticking) << i << " at " << one.contact.time;
    }
}

TEST(Chatter, ImpactsOnAVibratingTableEqualAnIndependentSimulation) {
    Random random(14);
    const Real pi = std::numbers::pi_v<Real>;
    int compared = 0, rests = 0;
    double worst = 0, worst_rest = 0;
    for (int i = 0; i < 400; ++i) {
        const double g = 9.81, f = random.uniform(5, 20), e = random.uniform(0.2, 0.6);
        const Real omega = 2 * pi * f;
        const double a = static_cast<double>(g / (omega * omega)) * random.uniform(0.1, 0.8);
        const double x0 = a * random.uniform(2, 10);
        Experiment experiment(shipped_with("bouncing-ball", {{"e", e}, {"a", a}, {"f", f}}), with_tolerance(1e-15));
        experiment.run_from({x0, 0, 0}, 0, 20 / f);
        // Parabolas have more curvature than the table: each meets it just once after its top.
        Real t = 0, x = x0, v = 0;
        for (const auto& record : experiment.recorder.contacts()) {
            if (record.contact.kind == ContactKind::sticking) {
                ++rests;
                // The remaining time is less than a few flights at the last speed, which the table hardly changes.
                const Real pull = g - a * omega * omega * std::sin(omega * t);
                const Real speed = v - a * omega * std::cos(omega * t);
                const Real rest = t + 2 * speed / (pull * (1 - e));
                // Flights as low as the round-off of the table's height take this long.
                const double shortest = std::sqrt(8 * epsilon * a / static_cast<double>(pull));
                worst_rest = std::max(worst_rest, static_cast<double>(std::abs(record.contact.time - rest)) / shortest);
                break;
            }
            const auto gap = [&](Real s) {
                return std::pair(x + v * s - g * s * s / 2 - a * std::sin(omega * (t + s)),
                                 v - g * s - a * omega * std::cos(omega * (t + s)));
            };
            const Real speed = v - a * omega * std::cos(omega * t);
            Real high = 0.1L / f;
            while (gap(high).first > 0)
                high *= 1.2L;
            Real low = high;
            while (low > 0 && gap(low).first <= 0)
                low *= 0.97L;
            if (t > 0 && low < speed / (g * 10))
                break; // the reference is no more accurate than the engine here
            const Real s = root_in(
                [&](Real r) {
                    const auto [y, slope] = gap(r);
                    return std::pair(-y, -slope);
                },
                low, high);
            const Real table = a * omega * std::cos(omega * (t + s));
            v = table - e * (v - g * s - table);
            t += s;
            x = a * std::sin(omega * t);
            ++compared;
            // Round-off of the table's height displaces an impact more, the slower it is.
            const double known = 1e-14 + 16 * epsilon * a / std::abs(record.contact.rate_before);
            worst = std::max(worst, static_cast<double>(std::abs(record.contact.time - t)) / known);
        }
    }
    EXPECT_LT(worst, 1);
    EXPECT_LT(worst_rest, 1);
    EXPECT_GT(compared, 2000);
    EXPECT_GT(rests, 300);
}

} // namespace chatter_test
