// Motions in modes that slides and frictions make: closed forms, models that are written by hand, two-folds, surfaces
// that meet.

#include "closed_form.hpp"
#include "model_parts.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>
#include <vector>

namespace graze::sliding_modes_test {

using namespace graze::testing;

/// The parts of two fields on both sides of x = 0.
std::string two_sides(const std::string& states, const std::string& negative, const std::string& positive) {
    return "name = \"sides\"\n[states]\n" + states + "[modes.left]\nrates = { " + negative +
           " }\n[modes.right]\nrates = { " + positive +
           " }\n[events]\nsurface = \"x\"\n[slides.along]\nsurface = \"surface\"\nbetween = [\"left\", \"right\"]\n"
           "[initial]\nmode = \"right\"\n";
}

/// y' = (3 - 2y)/(2 - y) while sliding on x = 0, which ends where x' = y - 1 on the right vanishes.
TEST(SlidingModes, EndWhereTheFieldIsTangent) {
    for (const double start : {-2.0, 0.0, 0.5, 0.9}) {
        Experiment experiment(model_from(two_sides("x = 0\ny = 0\n", "x = 1, y = 2", "x = \"y - 1\", y = 1")),
                              with_tolerance(1e-14));
        const auto sliding = *experiment.simulation.model().find_mode("along");
        const double time = (1 - start) / 2 + std::log(3 - 2 * start) / 4;
        EXPECT_EQ(experiment.run_from({0, start}, sliding, time + 0.5).ending, Ending::end_time);
        ASSERT_EQ(experiment.recorder.contacts().size(), 1U);
        const auto& exit = experiment.recorder.contacts()[0];
        EXPECT_EQ(experiment.label(0), "along:right");
        EXPECT_EQ(exit.after[0], 0);
        EXPECT_NEAR(exit.after[1], 1, 8 * epsilon);
        EXPECT_NEAR(exit.contact.time, time, 64 * epsilon * (1 + time));
        // Beyond, x = s^2/2 on the right.
        EXPECT_NEAR(experiment.state()[0], 0.125, 1e-13);
        EXPECT_NEAR(experiment.state()[1], 1.5, 1e-13);
    }
}

/// x'' = -u with u = sign(x' + x/2): along the line x decays exponentially, and stays on it to the last digits.
TEST(SlidingModes, FollowTheSwitchingLineOfALinearRelay) {
    Experiment experiment(model_from(R"toml(name = "relay"
[states]
x = 1
v = 1
[modes.pull]
rates = { x = "v", v = 1 }
[modes.push]
rates = { x = "v", v = -1 }
[events]
line = "v + x/2"
[slides.line-motion]
surface = "line"
between = ["pull", "push"]
[initial]
mode = "push"
)toml"),
                          with_tolerance(1e-14));
    experiment.run(30);
    ASSERT_EQ(experiment.recorder.contacts().size(), 1U);
    const double met = -1 + std::sqrt(7.0), there = 1 + met - met * met / 2;
    EXPECT_NEAR(experiment.recorder.contacts()[0].contact.time, met, 8 * epsilon * met);
    const double x = there * std::exp(-(30 - met) / 2);
    EXPECT_NEAR(experiment.state()[0], x, 1e-12 * x);
    EXPECT_NEAR(experiment.state()[1], -x / 2, 1e-12 * x);
}

/// Constant fields: sliding with (2 * 3 + 1 * 1)/(1 + 2) along a slanted surface.
TEST(SlidingModes, CombineConstantFields) {
    Experiment experiment(model_from(R"toml(name = "constant"
[states]
x = 2
y = 0
[modes.left]
rates = { x = 2, y = 1 }
[modes.right]
rates = { x = -1, y = 3 }
[events]
surface = "x - 0.25*y"
[slides.along]
surface = "surface"
between = ["left", "right"]
[initial]
mode = "right"
)toml"));
    experiment.run(20);
    // The rates of x - y/4 are 1.75 and -1.75: half of each.
    const double met = 2 / 1.75, y = 3 * met + 2 * (20 - met);
    EXPECT_NEAR(experiment.state()[1], y, 8 * epsilon * y);
    EXPECT_NEAR(experiment.state()[0], y / 4, 8 * epsilon * y);
}

/// A crossing where the other side does not push back, in both directions; an escaping surface is never entered.
TEST(SlidingModes, CrossWhereBothSidesGoOn) {
    Experiment crossing(model_from(two_sides("x = 1\ny = 0\n", "x = -2, y = 1", "x = -1, y = 0")));
    crossing.run(3);
    EXPECT_NEAR(crossing.state()[0], -4, 1e-15);
    EXPECT_EQ(crossing.label(0), "right:surface");
    Experiment back(model_from(two_sides("x = 1\ny = 0\n", "x = 1, y = 1", "x = 3, y = 0")));
    back.run_from({-1, 0}, 0, 2);
    EXPECT_NEAR(back.state()[0], 3, 1e-15);
    Experiment escaping(model_from(two_sides("x = 0\ny = 0\n", "x = -1, y = 1", "x = 1, y = 0")));
    EXPECT_EQ(escaping.run(2).ending, Ending::end_time);
    EXPECT_EQ(escaping.state()[0], 2);
    const Outcome outcome = escaping.run_from({0, 0}, 2, 1);
    EXPECT_EQ(outcome.ending, Ending::inadmissible);
    EXPECT_NE(outcome.detail.find("barrier 'along-left' is already violated"), std::string::npos) << outcome.detail;
}

TEST(SlidingModes, BeginOnTheirSurface) {
    Experiment experiment(model_from(two_sides("x = 0\ny = 0\n", "x = 1, y = 1", "x = -1, y = 0")));
    EXPECT_EQ(experiment.run_from({1e-12, 0}, 2, 1).ending, Ending::end_time); // round-off of an earlier motion
    const Outcome outcome = experiment.run_from({0.5, 0}, 2, 1);
    EXPECT_EQ(outcome.ending, Ending::inadmissible);
    EXPECT_NE(outcome.detail.find("moves along the surface of the event 'surface', whose function is 0.5 and not 0"),
              std::string::npos)
        << outcome.detail;
}

/// With x' = -y on the right and z on the left, y' = -(2y - z)/(y + z) and z' = -(2z - y)/(y + z) while sliding: y + z
/// falls at the rate 1, to the two-fold y = z = 0.
TEST(SlidingModes, EndAtATwoFold) {
    const std::string states = "x = 0\ny = 1\nz = 1.3\n";
    const auto outcome_of = [](const std::string& text) {
        Experiment experiment(model_from(text));
        return experiment.run_from(experiment.simulation.model().initial_state(), 2, 20);
    };
    const Outcome outcome = outcome_of(two_sides(states, "x = \"z\", y = -2, z = 1", "x = \"-y\", y = 1, z = -2"));
    EXPECT_EQ(outcome.ending, Ending::two_fold);
    EXPECT_NEAR(outcome.time, 2.3, 1e-11);
    EXPECT_NE(outcome.detail.find("reaches a two-fold in mode 'along'"), std::string::npos) << outcome.detail;
    EXPECT_NE(outcome.detail.find("'along-left' and 'along-right' happen at once"), std::string::npos);
    // With other exponents the motion is not analytic there.
    EXPECT_EQ(outcome_of(two_sides(states, "x = \"z\", y = -2.3, z = 0.7", "x = \"-y\", y = 1, z = -1.9")).ending,
              Ending::two_fold);
    // Both rates vanish at once without a singular field: x' = (1 - y) to both sides.
    EXPECT_EQ(
        outcome_of(two_sides("x = 0\ny = 0\nz = 0\n", "x = \"1 - y\", y = 1, z = 1", "x = \"y - 1\", y = 1, z = 0"))
            .ending,
        Ending::two_fold);
    // Beside the two-fold sliding ends as usual.
    EXPECT_EQ(
        outcome_of(two_sides("x = 0\ny = 0\nz = 0\n", "x = \"1.001 - y\", y = 1, z = 1", "x = \"y - 1\", y = 1, z = 0"))
            .ending,
        Ending::end_time);
}

/// A mass on a belt is pulled off where the force grows slowly beyond friction. The velocity relative to the belt then
/// has the rate zero but for round-off of forces that cancel, of either sign; the mass is back after three times the
/// time to the greatest force.
TEST(SlidingModes, AreLeftSlowlyForAShortTime) {
    const double nu = 1, amplitude = 1.8, theta = -std::asin(1 / (nu * amplitude)),
                 a = amplitude * nu * nu * std::cos(theta);
    const Model model = shipped_with("belt-oscillator", {{"nu", nu}, {"amplitude", amplitude}});
    for (int i = 0; i < 200; ++i) {
        const double depth = std::pow(10.0, -4 - i / 50.0), time = std::sqrt(2 * depth / a);
        Experiment experiment(model, with_tolerance(1e-15));
        // On the belt, with the phase of the greatest force reached in 10 times that time.
        const double before = 10 * time;
        const std::vector<double> state{amplitude * std::cos(theta) - 1.5 - depth - before, 1,
                                        theta - before + 2 * std::numbers::pi};
        ASSERT_EQ(experiment.run_from(state, *model.find_mode("stick"), 20 * time).ending, Ending::end_time) << i;
        const auto& contacts = experiment.recorder.contacts();
        ASSERT_EQ(contacts.size(), 2U) << i;
        EXPECT_NEAR((contacts[0].contact.time - before) / time, -1, 4 * time) << i;
        EXPECT_NEAR((contacts[1].contact.time - before) / time, 2, 8 * time) << i;
    }
}

/// The four fields are not f + u g + v h, so that the motion along both surfaces is not unique.
TEST(SlidingModes, EndWhereSurfacesMeet) {
    std::string text = "name = \"quadrants\"\n[states]\nx = 1\ny = 3\n[events]\nfront = \"x\"\nside = \"y\"\n";
    for (const auto& [name, rates] : {std::pair("pp", "x = -1, y = -1"), std::pair("pm", "x = -1, y = 1"),
                                      std::pair("mp", "x = 1, y = -1"), std::pair("mm", "x = 1, y = 2")})
        text += fmt::format("[modes.{}]\nrates = {{ {} }}\n", name, rates);
    text += slides_between_quadrants();
    Experiment experiment(model_from(text));
    const Outcome outcome = experiment.run(10);
    EXPECT_EQ(outcome.ending, Ending::no_transition);
    EXPECT_NEAR(outcome.time, 3, 1e-15);
    EXPECT_EQ(outcome.detail,
              "in mode 'upper' at time 3: sliding meets the surface of 'side', of another slide, and no "
              "rule says how the motion goes on: add [[transitions]] with mode = \"upper\" and event = "
              "\"side\"");
    Experiment goes_on(
        model_from(text + "[modes.rest]\nrates = { x = 0, y = 0 }\n" + transition("upper", "side", "rest")));
    EXPECT_EQ(goes_on.run(10).ending, Ending::end_time);
}

void expect_same_contacts(const Experiment& made, const Experiment& written, double tolerance) {
    const auto &one = made.recorder.contacts(), &other = written.recorder.contacts();
    ASSERT_EQ(one.size(), other.size());
    for (std::size_t i = 0; i < one.size(); ++i) {
        EXPECT_LE(std::abs(one[i].contact.time - other[i].contact.time), tolerance * other[i].contact.time) << i;
        for (std::size_t k = 0; k < one[i].after.size(); ++k)
            EXPECT_LE(std::abs(one[i].after[k] - other[i].after[k]), tolerance) << i;
    }
}

/// The shipped oscillator, which is equations and a law, with its modes and transitions written by hand.
const char* const oscillator = R"toml(name = "oscillator"
[parameters]
zeta = 0.01
omega = 0.4
amplitude = 1
friction_static = 0.4
friction_dynamic = 0.3
[states]
x = "amplitude"
v = 0
theta = { initial = 0, period = "2*pi" }
[definitions]
force = "amplitude*cos(theta) - 2*zeta*v - x"
[modes.slip_plus]
rates = { x = "v", v = "force - friction_dynamic", theta = "omega" }
watch = ["stop_plus"]
[modes.slip_minus]
rates = { x = "v", v = "force + friction_dynamic", theta = "omega" }
watch = ["stop_minus"]
[modes.stick]
rates = { x = 0, v = 0, theta = "omega" }
watch = ["break_plus", "break_minus"]
[events]
stop_plus = "v"
stop_minus = "-v"
break_plus = "friction_static - force"
break_minus = "friction_static + force"
[jumps.stop]
v = 0
[initial]
mode = "stick"
)toml";

TEST(Friction, GivesTheMotionOfTheModelThatIsWrittenByHand) {
    const Model by_hand = model_from(
        oscillator +
        transition("slip_plus", "stop_plus",
                   "[{ when = 'friction_static + force >= 0', mode = 'stick' }, { mode = 'slip_minus' }]", "stop") +
        transition("slip_minus", "stop_minus",
                   "[{ when = 'friction_static - force >= 0', mode = 'stick' }, { mode = 'slip_plus' }]", "stop") +
        transition("stick", "break_plus", "slip_plus") + transition("stick", "break_minus", "slip_minus"));
    for (const double omega : {0.15, 0.4, 0.7, 1.3})
        for (const double friction : {0.1, 0.3}) {
            const Settings settings{
                {"omega", omega}, {"friction_dynamic", friction}, {"friction_static", 1.3 * friction}};
            Model hand = by_hand;
            for (const auto& [name, value] : settings)
                hand.set_parameter(name, value);
            Experiment made(started(shipped_with("dry-friction-oscillator", settings), {{"x", 3}})), written(hand);
            made.run(200);
            written.run_from({3, 0, 0}, *written.simulation.model().find_mode("slip_minus"), 200);
            expect_same_contacts(made, written, 0);
            EXPECT_GT(made.recorder.contacts().size(), 10U);
        }
}

/// It sticks at x until A cos(theta) - x reaches static friction.
TEST(Friction, HoldsUntilStaticFrictionGivesWay) {
    Experiment experiment(model_from(R"toml(name = "held"
[states]
x = 0.2
v = 0
theta = { initial = "pi/2", period = "2*pi" }
[modes.free]
rates = { x = "v", v = "cos(theta) - x - rub", theta = 1 }
[friction.rub]
velocity = "v"
normal = 2
coefficient = 0.15
static = 0.3
[initial]
mode = "free"
)toml"),
                          with_tolerance(1e-15));
    experiment.run(10);
    const auto& first = experiment.recorder.contacts().at(0);
    EXPECT_EQ(experiment.label(0), "free-stick:backward");
    EXPECT_NEAR(first.contact.time, std::acos(-0.4) - std::numbers::pi / 2, 16 * epsilon);
    EXPECT_EQ(first.after[0], 0.2);
}

/// A block that is thrown comes to rest after v/(mu g), if the slope is not too steep.
TEST(Friction, StopsABlockAfterTheTimeOfTheClosedForm) {
    for (const double slope : {0.0, 0.1, 0.25, 0.35, 0.5}) {
        Model model = model_from(R"toml(name = "block"
[parameters]
slope = 0
[states]
x = 0
v = 2
[modes.on]
rates = { x = "v", v = "(-9.81*3*sin(slope) - rub)/3" }
[friction.rub]
velocity = "v"
normal = "3*9.81*cos(slope)"
coefficient = 0.3
)toml");
        model.set_parameter("slope", slope);
        Experiment experiment(model);
        experiment.run(2);
        const double stops = 2 / (9.81 * (std::sin(slope) + 0.3 * std::cos(slope)));
        EXPECT_NEAR(experiment.recorder.contacts().at(0).contact.time, stops, 8 * epsilon);
        const double down = std::max(0.0, 9.81 * (std::sin(slope) - 0.3 * std::cos(slope)));
        EXPECT_NEAR(experiment.state()[1], -down * (2 - stops), 1e-14);
        EXPECT_NEAR(experiment.state()[0], stops - down * (2 - stops) * (2 - stops) / 2, 1e-14);
    }
}

/// Two blocks on one another: the upper one, with coefficient 0.2, is pulled by 2 and then rests on the lower one,
/// whose ground has 0.05; all accelerations are constant.
TEST(Friction, OfTwoBodiesOnOneAnother) {
    Experiment experiment(model_from(R"toml(name = "blocks"
[states]
x1 = 0
v1 = 3
x2 = 0
v2 = 0
[modes.m]
rates = { x1 = "v1", v1 = "-upper/1", x2 = "v2", v2 = "(upper - ground)/2" }
[friction.upper]
velocity = "v1 - v2"
normal = 10
coefficient = 0.2
[friction.ground]
velocity = "v2"
normal = 30
coefficient = 0.05
)toml"));
    experiment.run(10);
    // v1 = 3 - 2t, v2 = 0.25 t until both are equal at t = 4/3; together they decelerate by 0.5 until rest.
    const double joined = 3 / 2.25, speed = 0.25 * joined, rest = joined + speed / 0.5;
    ASSERT_EQ(experiment.recorder.contacts().size(), 2U);
    EXPECT_NEAR(experiment.recorder.contacts()[0].contact.time, joined, 4 * epsilon);
    EXPECT_EQ(experiment.label(0), "m-forward-forward:upper-stops");
    EXPECT_NEAR(experiment.recorder.contacts()[1].contact.time, rest, 8 * epsilon);
    EXPECT_NEAR(experiment.state()[2], 0.125 * joined * joined + speed * speed, 1e-15);
    EXPECT_NEAR(experiment.state()[0], 3 * joined - joined * joined + speed * speed, 1e-14);
}

/// The shipped microactuator, whose frame rubs, as equations, impacts and a law.
TEST(Friction, GivesTheModesOfACapsuleDrive) {
    const Model shipped = shipped_with("impact-microactuator", {{"V", 0.9}, {"e", 0.6}});
    std::string text = "name = \"capsule\"\n[parameters]\n";
    for (const Parameter& parameter : shipped.parameters)
        text += fmt::format("{} = {}\n", parameter.name, *parameter.value);
    text += R"toml(
[states]
x1 = { initial = 0, drifting = true }
x2 = 0
x3 = 0
x4 = 0
x5 = { initial = 0, period = "pi" }
[definitions]
F = "alpha*V^2*sin(x5)^2/(d - x3)^2 - c*x4 - k*x3"
[modes.free]
rates = { x1 = "x2", x2 = "-(F + rub)/m1", x3 = "x4", x4 = "F/m2 + (F + rub)/m1", x5 = "omega" }
watch = ["front", "back"]
[friction.rub]
velocity = "x2"
normal = "N"
coefficient = "mu_d"
static = "mu_s"
[events]
front = "delta - x3"
back = "delta + x3"
[jumps.impact]
x2 = "x2 + m2*(1 + e)/(m1 + m2)*x4"
x4 = "-e*x4"
)toml" + transition("free", "front", "free", "impact") +
            transition("free", "back", "free", "impact");
    Experiment made(model_from(text), with_tolerance(1e-14)), written(shipped, with_tolerance(1e-14));
    EXPECT_EQ(made.simulation.model().transitions.size(), 10U);
    made.run(6);
    written.run(6);
    std::size_t compared = 0;
    for (const auto& contact : written.recorder.contacts()) {
        if (shipped.events[contact.contact.event].name == "poincare")
            continue;
        if (compared == 20) // later impacts accumulate
            break;
        ASSERT_LT(compared, made.recorder.contacts().size());
        const auto& other = made.recorder.contacts()[compared++];
        EXPECT_NEAR(other.contact.time, contact.contact.time, 1e-11);
        for (std::size_t i = 0; i < 5; ++i)
            EXPECT_NEAR(other.after[i], contact.after[i], 1e-10);
    }
    EXPECT_EQ(compared, 20U);
}

} // namespace graze::sliding_modes_test
