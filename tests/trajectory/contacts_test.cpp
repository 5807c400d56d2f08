// Motions of models with contacts, against closed forms.

#include "closed_form.hpp"
#include "simulate.hpp"
#include "woodpecker_toy.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

using namespace graze;
using namespace graze::testing;

namespace contacts_test {

/// Balls of mass 1 in a row, of which the first hits the others, which touch each other.
std::string cradle(int balls, const std::string& law) {
    std::string states, rates, velocities, mass, contacts;
    for (int i = 1; i <= balls; ++i) {
        const char* comma = i > 1 ? ", " : "";
        states += fmt::format("{3}x{0} = {1}, v{0} = {2}", i, i == 1 ? -1 : 0, i == 1 ? 1 : 0, comma);
        rates += fmt::format("{1}x{0} = \"v{0}\", v{0} = 0", i, comma);
        velocities += fmt::format("\"v{}\", ", i);
        mass += "1, ";
        if (i > 1)
            contacts += fmt::format("contacts.c{1} = {{ gap = \"x{1} - x{0}\", restitution = \"e\" }}\n", i - 1, i);
    }
    return fmt::format("parameters.e = 1\nstates = {{ {0} }}\nmodes.free.rates = {{ {1} }}\ncontacts.law = \"{2}\"\n"
                       "contacts.velocities = [{3}]\ncontacts.mass = [{4}]\n{5}",
                       states, rates, law, velocities, mass, contacts);
}

std::vector<double> velocities_after(const std::string& model, double e, double time = 2) {
    Model one = model_from(model);
    one.set_parameter("e", e);
    Experiment experiment(std::move(one));
    EXPECT_EQ(experiment.run(time).ending, Ending::end_time) << experiment.trajectory.outcome().detail;
    std::vector<double> result;
    for (std::size_t i = 1; i < experiment.state().size(); i += 2)
        result.push_back(experiment.state()[i]);
    return result;
}

void expect_near(const std::vector<double>& values, const std::vector<double>& expected, double error = 4 * epsilon) {
    ASSERT_EQ(values.size(), expected.size());
    for (std::size_t i = 0; i < values.size(); ++i)
        EXPECT_NEAR(values[i], expected[i], error) << i;
}

TEST(Contacts, TwoBallsExchangeVelocities) {
    for (const double e : {0.0, 0.3, 1.0})
        expect_near(velocities_after(cradle(2, "newton"), e), {(1 - e) / 2, (1 + e) / 2});
}

/// All contacts at once: those of Newton and Poisson agree if all have one coefficient (Glocker and Pfeiffer 1995).
TEST(Contacts, ThreeBallsAtOnce) {
    for (const char* law : {"newton", "moreau", "poisson"})
        for (const double e : {0.0, 0.5, 0.9, 1.0})
            expect_near(velocities_after(cradle(3, law), e), {1 - 2 * (1 + e) / 3, (1 + e) / 3, (1 + e) / 3});
}

/// With different coefficients the laws differ. Poisson: impulses of compression 2/3 and 1/3, and e times these in
/// expansion; if the second contact would approach again, more of it until it does not.
TEST(Contacts, LawsDifferWithTheirCoefficients) {
    const auto after = [](const std::string& law, double e, double f) {
        std::string text = cradle(3, law);
        const std::size_t last = text.rfind("\"e\"");
        text.replace(last, 3, fmt::format("{}", f));
        return velocities_after(text, e);
    };
    expect_near(after("newton", 0.5, 1), {0, 0.5, 0.5});
    expect_near(after("poisson", 0.5, 1), {0, 1.0 / 3, 2.0 / 3});
    expect_near(after("newton", 1, 0), {-1.0 / 3, 2.0 / 3, 2.0 / 3});
    expect_near(after("poisson", 1, 0), {-1.0 / 3, 2.0 / 3, 2.0 / 3});
}

/// One after another: without losses the last ball flies off, whatever their number (Newton's cradle).
TEST(Contacts, CradleOneAfterAnother) {
    for (const int balls : {2, 3, 4, 5}) {
        std::vector<double> last(static_cast<std::size_t>(balls), 0.0);
        last.back() = 1;
        expect_near(velocities_after(cradle(balls, "sequence"), 1), last);
    }
}

/// The same with losses, against collisions of pairs counted here until none approaches.
TEST(Contacts, CradleOneAfterAnotherWithLosses) {
    for (const double e : {0.5, 0.8, 0.95}) {
        std::array<double, 3> v{1, 0, 0};
        for (bool hit = true; hit;) {
            hit = false;
            for (const std::size_t i : {0U, 1U})
                if (v[i] - v[i + 1] > 1e-14) {
                    const double sum = v[i] + v[i + 1], apart = e * (v[i] - v[i + 1]);
                    v[i] = (sum - apart) / 2;
                    v[i + 1] = (sum + apart) / 2;
                    hit = true;
                }
        }
        expect_near(velocities_after(cradle(3, "sequence"), e), {v[0], v[1], v[2]}, 1e-13);
    }
}

const std::string corner = R"toml(
parameters = { e = 0.5, f = 0.25, a = 1.5 }
states = { x = 1, y = 1, u = -1, v = -1 }
modes.free.rates = { x = "u", y = "v", u = 0, v = 0 }
contacts.velocities = ["u", "v"]
contacts.mass = [1, 1]
contacts.floor = { gap = "y", restitution = "e" }
contacts.wall = { gap = "x*sin(a) - y*cos(a)", restitution = "f" }
)toml";

/// Both walls are met in the same instant, and at instants apart.
TEST(Contacts, BallInARightCorner) {
    for (const double apart : {0.0, 1e-12, 1e-3, -1e-3}) {
        Model model = model_from(corner);
        model.set_parameter("a", std::numbers::pi / 2);
        model.set_initial("x", 1 + apart);
        Experiment experiment(model);
        EXPECT_EQ(experiment.run(3).ending, Ending::end_time);
        EXPECT_NEAR(experiment.state()[2], 0.25, 4 * epsilon) << apart;
        EXPECT_NEAR(experiment.state()[3], 0.5, 4 * epsilon) << apart;
    }
}

/// In a corner of angle a both normal velocities reverse if both impulses are positive; a ball that slides along the
/// floor into an obtuse corner takes an impulse of the wall only.
TEST(Contacts, BallInAnObliqueCorner) {
    const double a = 1.2, e = 0.5, f = 0.25;
    Model model = model_from(corner);
    model.set_parameter("a", a);
    model.set_initial("x", 1 + std::cos(a) / std::sin(a)); // both gaps close at time 1
    model.set_initial("u", -1 - std::cos(a) / std::sin(a));
    Experiment experiment(model);
    EXPECT_EQ(experiment.run(2).ending, Ending::end_time);
    const auto normal = [&](double u, double v) { return u * std::sin(a) - v * std::cos(a); };
    const double u = experiment.state()[2], v = experiment.state()[3];
    EXPECT_NEAR(v, e, 8 * epsilon);
    EXPECT_NEAR(normal(u, v), -f * normal(-1 - std::cos(a) / std::sin(a), -1), 8 * epsilon);

    const double b = 2;
    Model obtuse = model_from(corner);
    obtuse.set_parameter("a", b);
    obtuse.set_initial("y", 0);
    obtuse.set_initial("v", 0);
    Experiment sliding(obtuse);
    EXPECT_EQ(sliding.simulation.model().modes[sliding.simulation.model().initial_mode].name, "free-floor");
    EXPECT_EQ(sliding.run(2).ending, Ending::end_time) << sliding.trajectory.outcome().detail;
    const double impulse = (1 + f) * std::sin(b);
    EXPECT_NEAR(sliding.state()[2], -1 + impulse * std::sin(b), 8 * epsilon);
    EXPECT_NEAR(sliding.state()[3], -impulse * std::cos(b), 8 * epsilon);
}

/// A ball comes to rest on a floor: closed form of the accumulation; then it stays.
TEST(Contacts, BallComesToRest) {
    const std::string ball = R"toml(
parameters = { e = 0.8 }
states = { x = 1, v = 0 }
modes.free.rates = { x = "v", v = -1 }
contacts.velocities = ["v"]
contacts.mass = [2]
contacts.floor = { gap = "x", restitution = "e" }
)toml";
    Experiment experiment(model_from(ball));
    EXPECT_EQ(experiment.run(20).ending, Ending::end_time);
    EXPECT_EQ(experiment.simulation.model().modes[experiment.trajectory.mode()].name, "free-floor");
    EXPECT_NEAR(experiment.recorder.contacts().back().contact.time, std::sqrt(2.0) * 1.8 / 0.2, 1e-9);
    EXPECT_EQ(experiment.state(), (std::vector<double>{0, 0}));
}

/// A ball on a vibrating table, declared and written out with its events, jumps, modes and transitions.
TEST(Contacts, MovingTableAsWrittenOut) {
    const std::string head = R"toml(
parameters = { g = 9.81, e = 0.4, a = 0.03, omega = 20 }
states = { x = { initial = "2*a" }, v = 0, theta = { initial = 0, period = "2*pi" } }
modes.flight.rates = { x = "v", v = "-g", theta = "omega" }
initial.mode = "flight"
)toml";
    const std::string declared = head + R"toml(
contacts.velocities = ["v"]
contacts.mass = [1]
contacts.table = { gap = "x - a*sin(theta)", restitution = "e" }
)toml";
    const std::string written = head + R"toml(
modes.flight.watch = ["contact"]
modes.rest.watch = ["release"]
modes.rest.rates = { x = "velocity", v = "acceleration", theta = "omega" }
definitions = { velocity = "a*omega*cos(theta)", acceleration = "-a*omega^2*sin(theta)" }
events = { contact = "x - a*sin(theta)", release = "g + acceleration" }
jumps.impact.v = "velocity - e*(v - velocity)"
jumps.land = { x = "a*sin(theta)", v = "velocity" }
transitions = [
    { mode = "flight", event = "contact", jump = "impact", next = "flight", chatter = { jump = "land", mode = "rest" } },
    { mode = "rest", event = "release", next = "flight" },
]
)toml";
    Experiment one(model_from(declared)), other(model_from(written));
    EXPECT_EQ(one.run(5).ending, Ending::end_time);
    EXPECT_EQ(other.run(5).ending, Ending::end_time);
    EXPECT_EQ(one.recorder.contacts().size(), other.recorder.contacts().size());
    EXPECT_GT(one.recorder.contacts().size(), 200U);
    expect_near(one.state(), other.state(), 1e-9);
}

/// The shipped oscillator between two stops, which are declared contacts, against the same with modes and transitions
/// written by hand, in motions that also rest at the stops.
TEST(Contacts, TwoStopsAsWrittenByHand) {
    const std::string stops = R"toml(
parameters = { zeta = 0.02, omega = 1.2, amplitude = 1, sigma = 1, e = 0.7 }
states = { x = 0, v = 0, theta = { initial = 0, period = "2*pi" } }
definitions.force = "amplitude*cos(theta) - 2*zeta*v - x"
modes.free = { rates = { x = "v", v = "force", theta = "omega" }, watch = ["right", "left"] }
modes.stuck_right = { rates = { x = 0, v = 0, theta = "omega" }, watch = ["release_right"] }
modes.stuck_left = { rates = { x = 0, v = 0, theta = "omega" }, watch = ["release_left"] }
events = { right = "sigma - x", left = "sigma + x", release_right = "force", release_left = "-force" }
jumps = { impact = { v = "-e*v" }, stick_right = { x = "sigma", v = 0 }, stick_left = { x = "-sigma", v = 0 } }
initial.mode = "free"
transitions = [
    { mode = "free", event = "right", jump = "impact", next = [{ when = "v < 0", mode = "free" }, { when = "force > 0", mode = "stuck_right" }, { mode = "free" }], chatter = { jump = "stick_right", mode = "stuck_right" } },
    { mode = "free", event = "left", jump = "impact", next = [{ when = "v > 0", mode = "free" }, { when = "force < 0", mode = "stuck_left" }, { mode = "free" }], chatter = { jump = "stick_left", mode = "stuck_left" } },
    { mode = "stuck_right", event = "release_right", jump = "stick_right", next = "free" },
    { mode = "stuck_left", event = "release_left", jump = "stick_left", next = "free" },
]
)toml";
    for (const auto& [omega, e] : {std::pair(1.2, 0.7), std::pair(0.05, 0.7), std::pair(0.3, 0.2)}) {
        Model model = model_from(stops);
        model.set_parameter("omega", omega);
        model.set_parameter("e", e);
        Experiment one(model), other(shipped_with("impact-oscillator-two-stops", {{"omega", omega}, {"e", e}}));
        EXPECT_EQ(one.run(60).ending, Ending::end_time);
        EXPECT_EQ(other.run(60).ending, Ending::end_time);
        EXPECT_EQ(one.recorder.contacts().size(), other.recorder.contacts().size()) << omega;
        expect_near(one.state(), other.state(), 1e-8);
    }
}

/// A disc that is thrown along a floor slips, then rolls: two sevenths of the speed are lost if I = 2/5 m r^2.
TEST(Contacts, DiscRolls) {
    const std::string disc = R"toml(
parameters = { mu = 0.3, g = 9.81, r = 0.5 }
states = { x = 0, y = "r", phi = 0, u = 7, v = 0, w = 0 }
modes.free.rates = { x = "u", y = "v", phi = "w", u = 0, v = "-g", w = 0 }
contacts.velocities = ["u", "v", "w"]
contacts.mass = [1, 1, "0.4*r^2"]
contacts.floor = { gap = "y - r", restitution = 0.5, friction = "mu", slip = "u + r*w" }
)toml";
    Experiment experiment(model_from(disc));
    const Model& model = experiment.simulation.model();
    EXPECT_EQ(model.modes[model.initial_mode].name, "free-floor-forward");
    EXPECT_EQ(experiment.run(3).ending, Ending::end_time) << experiment.trajectory.outcome().detail;
    EXPECT_EQ(model.modes[experiment.trajectory.mode()].name, "free-floor-stick");
    EXPECT_NEAR(experiment.recorder.contacts().back().contact.time, 2.0 / (0.3 * 9.81), 1e-13);
    EXPECT_NEAR(experiment.state()[3], 5, 1e-13);
    EXPECT_NEAR(experiment.state()[5], -10, 1e-13);
}

/// A rod of length 2 falls flat: both ends hit at once and come to rest at once. With one end heavier in restitution,
/// both normal velocities still reverse by their own coefficients.
TEST(Contacts, RodFallsFlat) {
    const std::string flat = R"toml(
parameters = { e = 0.5, f = 0.5 }
states = { y = 1, phi = 0, v = 0, w = 0 }
modes.free.rates = { y = "v", phi = "w", v = -1, w = 0 }
contacts.velocities = ["v", "w"]
contacts.mass = [1, "1/3"]
contacts.left = { gap = "y - sin(phi)", restitution = "e" }
contacts.right = { gap = "y + sin(phi)", restitution = "f" }
)toml";
    Model model = model_from(flat);
    Experiment experiment(model);
    EXPECT_EQ(experiment.run(10).ending, Ending::end_time) << experiment.trajectory.outcome().detail;
    EXPECT_EQ(experiment.simulation.model().modes[experiment.trajectory.mode()].name, "free-left-right");
    EXPECT_NEAR(experiment.recorder.contacts().back().contact.time, std::sqrt(2.0) * 1.5 / 0.5, 1e-9);
    model.set_parameter("f", 0.25);
    Experiment unequal(model);
    unequal.run(std::sqrt(2.0) * (1 + 1e-9));
    const double speed = std::sqrt(2.0);
    EXPECT_NEAR(unequal.state()[2], 0.375 * speed, 1e-8);
    EXPECT_NEAR(unequal.state()[3], -0.125 * speed, 1e-8);
}

const std::string rod = R"toml(
parameters = { mu = 2, g = 9.81, tilt = 1 }
states = { x = 0, y = "sin(tilt)", phi = "tilt", u = 1, v = 0, w = 0 }
modes.free.rates = { x = "u", y = "v", phi = "w", u = 0, v = "-g", w = 0 }
contacts.velocities = ["u", "v", "w"]
contacts.mass = [1, 1, "1/3"]
contacts.tip = { gap = "y - sin(phi)", restitution = 0, friction = "mu", slip = "u + w*sin(phi)" }
)toml";

/// A slender rod of length 2 that slides on its lower end: the contact force is g/(1 + 3 cos^2 - 3 mu sin cos) at
/// first. Beyond mu = 4/3 there are angles at which the denominator is negative; at tan = 2 exactly from there on
/// (Génot and Brogliato 1999).
TEST(Contacts, PainlevesRod) {
    for (const double mu : {0.5, 1.2, 4.0 / 3 - 1e-6, 4.0 / 3 + 1e-6, 2.0}) {
        const double tilt = std::atan(2.0);
        Model model = model_from(rod);
        model.set_parameter("mu", mu);
        model.set_parameter("tilt", tilt);
        Experiment forward(model);
        model.set_initial("u", -1);
        Experiment backward(model);
        EXPECT_EQ(model.modes[model.initial_mode].name, "free-tip-backward");
        const auto ending = [](Experiment& one) { return one.run(1e-9).ending; };
        // Only slip in the direction in which the rod digs in is paradoxical.
        EXPECT_EQ(ending(forward), Ending::end_time) << mu << forward.trajectory.outcome().detail;
        EXPECT_EQ(ending(backward), mu < 4.0 / 3 ? Ending::end_time : Ending::painleve)
            << mu << backward.trajectory.outcome().detail;
        if (mu < 4.0 / 3) {
            const Model& derived = backward.simulation.model();
            const std::size_t mode = *derived.find_mode("free-tip-backward");
            const double s = std::sin(tilt), c = std::cos(tilt);
            std::vector<double> inputs = derived.initial_state();
            for (const double value : derived.parameter_values())
                inputs.push_back(value);
            const std::vector<double> rates = derived.function_of(derived.modes[mode].rates)(inputs);
            const double force = 9.81 / (1 + 3 * c * c - 3 * mu * s * c);
            EXPECT_NEAR(rates[3], mu * force, 1e-9 * force);
            EXPECT_NEAR(rates[5], 3 * (mu * s - c) * force, 1e-8 * force);
        }
    }
}

/// A rod that slides fast enough runs into the point at which the determinant and the acceleration without a force
/// vanish together: tan^2 - 3 mu tan + 4 = 0 and w^2 sin = g (Génot and Brogliato 1999).
TEST(Contacts, PainlevesRodIsDrawnIntoTheSingularPoint) {
    const double mu = 1.7, tangent = (3 * mu - std::sqrt(9 * mu * mu - 16)) / 2, angle = std::atan(tangent);
    for (const double tilt : {0.6, 0.7}) {
        Model model = model_from(rod);
        model.set_parameter("mu", mu);
        model.set_parameter("tilt", tilt);
        model.set_initial("u", -20);
        Experiment experiment(model);
        EXPECT_EQ(experiment.run(2).ending, Ending::painleve);
        EXPECT_NEAR(experiment.state()[2], angle, 1e-6);
        EXPECT_NEAR(experiment.state()[5], std::sqrt(9.81 / std::sin(angle)), 1e-4);
    }
}

const std::string block = R"toml(
parameters = { h = 1, b = 0.3, g = 9.81, mu = 5, tilt = 0.1 }
states = { x = 0, y = "h*cos(tilt) + b*sin(tilt)", phi = "tilt", u = 0, v = 0, w = 0 }
modes.free.rates = { x = "u", y = "v", phi = "w", u = 0, v = "-g", w = 0 }
contacts.velocities = ["u", "v", "w"]
contacts.mass = [1, 1, "(h^2 + b^2)/3"]
contacts.left = { gap = "y - h*cos(phi) - b*sin(phi)", restitution = 0, friction = "mu", slip = "u + w*(h*cos(phi) + b*sin(phi))" }
contacts.right = { gap = "y - h*cos(phi) + b*sin(phi)", restitution = 0, friction = "mu", slip = "u + w*(h*cos(phi) - b*sin(phi))" }
)toml";

/// A block rocks from corner to corner; each impact keeps 1 - 3/2 sin^2(alpha) of its speed (Housner 1963).
TEST(Contacts, BlockRocks) {
    Experiment experiment(model_from(block));
    experiment.run(3);
    EXPECT_EQ(experiment.trajectory.outcome().ending, Ending::end_time) << experiment.trajectory.outcome().detail;
    const double ratio = 1 - 1.5 * 0.09 / 1.09;
    int impacts = 0;
    for (const Recorder::RecordedContact& one : experiment.recorder.contacts()) {
        if (one.contact.kind != ContactKind::crossing || std::abs(one.before[2]) > 1e-9)
            continue;
        ++impacts;
        EXPECT_NEAR(one.after[5] / one.before[5], ratio, 1e-9) << one.contact.time;
    }
    EXPECT_GT(impacts, 3);
    // It comes to rest on both corners, which stick together.
    EXPECT_EQ(experiment.go_on(6).ending, Ending::end_time) << experiment.trajectory.outcome().detail;
    EXPECT_EQ(experiment.simulation.model().modes[experiment.trajectory.mode()].name, "free-left-stick-right-stick");
    EXPECT_NEAR(experiment.state()[2], 0, 1e-12);
}

/// The published orbit (Leine, Glocker and van Campen 2001) passes phiS = -0.2788 with v = -0.3411 and wS = -7.4583, by
/// time stepping; time stepping with steps of 1e-6 s gives the period 0.14598 s, v = -0.3395 and wS = -7.4620.
TEST(Contacts, WoodpeckerPecks) {
    Model model = model_from(woodpecker_toy);
    Experiment experiment(model, {},
                          {Probe{.name = "down",
                                 .expression = model.symbol("phiS") + 0.2788,
                                 .direction = Direction::falling,
                                 .value = {}}});
    EXPECT_EQ(experiment.simulation.model().modes[model.initial_mode].name, "free-lower-backward");
    EXPECT_EQ(experiment.run(20).ending, Ending::end_time) << experiment.trajectory.outcome().detail;
    const auto& passages = experiment.recorder.passages();
    ASSERT_GT(passages.size(), 100U);
    const std::size_t last = passages.size() - 1;
    EXPECT_NEAR(passages[last].passage.time - passages[last - 1].passage.time, 0.145976, 2e-6);
    EXPECT_NEAR(passages[last].state[3], -0.3395, 1e-4);
    EXPECT_NEAR(passages[last].state[5], -7.4620, 2e-4);
    EXPECT_NEAR(passages[last].state[3], -0.3411, 0.01 * 0.3411);
    EXPECT_NEAR(passages[last].state[5], -7.4583, 0.001 * 7.4583);
}

/// A block that slides along a floor is wedged under a slope. Both normal velocities follow from the law, so that the
/// mean slip along the slope is zero whatever friction does; with the slope's own coefficient e the block returns with
/// e times its speed. In exact arithmetic v' = -10 mu until the impact after the distance 1, and mu = 0.2.
TEST(Contacts, BlockIsWedgedUnderASlope) {
    for (const double angle : {0.88, 0.95, 1.1})
        for (const double e : {0.2, 0.8}) {
            Experiment experiment(model_from(fmt::format(R"toml(
states = {{ x = 1, y = 0, u = -4, v = 0 }}
modes.free.rates = {{ x = "u", y = "v", u = 0, v = -10 }}
contacts.law = "moreau"
contacts.velocities = ["u", "v"]
contacts.mass = [1, 1]
contacts.floor = {{ gap = "y", restitution = 0.5, friction = 0.2, slip = "u" }}
contacts.slope = {{ gap = "{0:.17g}*x - {1:.17g}*y", restitution = {2}, friction = 0.5, slip = "{1:.17g}*u + {0:.17g}*v" }}
)toml",
                                                         std::cos(angle), std::sin(angle), e)));
            const double speed = std::sqrt(16.0 - 4), after = e * speed, time = (4 - speed) / 2;
            EXPECT_EQ(experiment.run(2.5).ending, Ending::end_time) << experiment.trajectory.outcome().detail;
            const auto& [hit, before, after_hit] = experiment.recorder.contacts().front();
            EXPECT_NEAR(hit.time, time, 1e-14);
            EXPECT_NEAR(after_hit[2], after, 1e-13);
            EXPECT_NEAR(after_hit[3], 0, 1e-15);
            EXPECT_NEAR(experiment.state()[0],
                        after < 2 * (2.5 - time) ? after * after / 4
                                                 : after * (2.5 - time) - (2.5 - time) * (2.5 - time),
                        1e-13);
        }
}

/// A block slides along one of two planes at right angles until it sticks in the impact with another one: Moreau's law
/// reverses its velocity, which stays along the plane that it touches.
TEST(Contacts, SlidesAfterAStickingImpactAtAnotherContact) {
    const double a = 2.05, e = 0.55;
    Experiment experiment(model_from(fmt::format(R"toml(
states = {{ x = 1, y = 0, u = -1, v = 0 }}
modes.free.rates = {{ x = "u", y = "v", u = 0, v = -1 }}
contacts.law = "moreau"
contacts.velocities = ["u", "v"]
contacts.mass = [[1.2, 0], [0, 1.2]]
contacts.floor = {{ gap = "y", restitution = 0, friction = 0.1, slip = "u" }}
contacts.slope = {{ gap = "{0:.17g}*x - ({1:.17g})*y", restitution = {2}, friction = 3, slip = "({1:.17g})*u + {0:.17g}*v" }}
)toml",
                                                 std::sin(a), std::cos(a), e)));
    EXPECT_EQ(experiment.run(1.2).ending, Ending::end_time) << experiment.trajectory.outcome().detail;
    const auto& [hit, before, after_hit] = experiment.recorder.contacts().front();
    const double speed = std::sqrt(1 - 0.2);
    EXPECT_NEAR(hit.time, (1 - speed) / 0.1, 1e-13);
    EXPECT_NEAR(after_hit[2], e * speed, 1e-13);
    EXPECT_NEAR(after_hit[3], 0, 1e-15);
    EXPECT_EQ(experiment.simulation.model().modes[hit.mode_after].name, "free-floor-forward");
}

/// A rod that lies down while it slides: its corners come to rest together, in normal direction only, and the slip of
/// both ends u/(mu g) later.
TEST(Contacts, RodLiesDownAndSlides) {
    for (const char* law : {"newton", "moreau"})
        for (const double mu : {0.05, 0.067, 0.1}) {
            SCOPED_TRACE(fmt::format("{}, mu = {}", law, mu));
            Experiment experiment(model_from(fmt::format(
                "parameters = {{ g = 9.81, mu = {} }}\nstates = {{ x = 0, y = 1, phi = 0, u = 1.899, v = 0.018, w = "
                "2.528 }}\n"
                "modes.free.rates = {{ x = \"u\", y = \"v\", phi = \"w\", u = 0, v = \"-g\", w = 0 }}\n"
                "contacts.law = \"{}\"\ncontacts.velocities = [\"u\", \"v\", \"w\"]\ncontacts.mass = [1, 1, 1.909]\n"
                "contacts.left = {{ gap = \"y - sin(phi) - 0.2*cos(phi)\", restitution = 0, friction = \"mu\", slip = "
                "\"u + "
                "w*y\" }}\n"
                "contacts.right = {{ gap = \"y + sin(phi) - 0.2*cos(phi)\", restitution = 0, friction = \"mu\", slip = "
                "\"u "
                "+ w*y\" }}\ninitial.mode = \"free\"\n",
                mu, law)));
            const Outcome& outcome = experiment.run(20);
            ASSERT_EQ(outcome.ending, Ending::end_time) << outcome.detail;
            const Model& model = experiment.simulation.model();
            EXPECT_EQ(model.modes[experiment.trajectory.mode()].name, "free-left-stick-right-stick");
            double lies = -1, slip = 0, stops = -1;
            for (const auto& one : experiment.recorder.contacts()) {
                const std::string& after = model.modes[one.contact.mode_after].name;
                if (after == "free-left-forward-right-forward") {
                    lies = one.contact.time;
                    slip = one.after[3];
                }
                if (after == "free-left-stick-right-stick" && stops < 0)
                    stops = one.contact.time;
            }
            if (lies < 0)
                continue; // it sticks at once
            EXPECT_NEAR(stops, lies + slip / (mu * 9.81), 1e-11);
        }
}

} // namespace contacts_test
