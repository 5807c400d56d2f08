// Slides and frictions: what is made of them, how they are written, and mistakes in them.

#include "graze/model/sliding.hpp"

#include "base/message_of.hpp"
#include "graze/base/input_errors.hpp"
#include "graze/model/check.hpp"
#include "graze/model/driven_parameter.hpp"
#include "graze/model/model_file.hpp"
#include "model/shipped_model.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace graze::sliding_test {

using namespace graze::testing;

/// f+ = (y - 1, 2 + x), f- = (1 + k y, -3) at x = 0.
const std::string relay = R"toml(name = "relay"
[parameters]
k = 0.25
[states]
x = 1
y = 0.5
[modes.off]
rates = { x = "1 + k*y", y = -3 }
[modes.on]
rates = { x = "y - 1", y = "2 + x" }
[events]
level = "x"
[slides.hold]
text = "kept at the level"
surface = "level"
between = ["off", "on"]
[initial]
mode = "on"
)toml";

const std::string block = R"toml(name = "block"
[parameters]
mu = 0.3
drive = 0.1
[states]
x = 1
v = 0
[definitions]
force = "drive - x - 0.1*v"
[modes.free]
watch = ["wall"]
rates = { x = "v", v = "(force - rub)/2" }
[friction.rub]
velocity = "v"
normal = "1 + x^2"
coefficient = "mu"
static = "1.5*mu"
[events]
wall = "x + 2"
[jumps.bounce]
v = "-0.5*v"
[[transitions]]
mode = "free"
event = "wall"
jump = "bounce"
next = "free"
)toml";

Model parsed(const std::string& text) {
    return parse_model(text, "m.toml");
}

std::string with(std::string text, const std::string& part, const std::string& other) {
    const std::size_t at = text.find(part);
    EXPECT_NE(at, std::string::npos) << part;
    return text.replace(at, part.size(), other);
}

/// All messages, joined, without the name of the file.
std::string refusal(const std::string& text) {
    try {
        parsed(text);
    } catch (const InputErrors& errors) {
        std::string all;
        for (const InputError& error : errors.all())
            all += std::string(error.what()).substr(7) + "\n";
        return all;
    } catch (const InputError& error) {
        return std::string(error.what()).substr(7);
    }
    return "";
}

TEST(Slide, HasTheCombinationOfBothFieldsThatIsTangent) {
    const Model model = parsed(relay);
    EXPECT_EQ(model.modes.size(), 3U);
    EXPECT_TRUE(model.modes[2].derived);
    EXPECT_EQ(model.modes[2].text, "kept at the level");
    for (const double y : {-0.5, 0.0, 0.9}) {
        const std::vector<double> rate = rates(model, "hold", std::vector{0.0, y});
        EXPECT_EQ(rate[0], 0);
        // Filippov: (f- L+h - f+ L-h)/(L+h - L-h)
        const double plus = y - 1, minus = 1 + 0.25 * y;
        EXPECT_NEAR(rate[1], (-3 * plus - 2 * minus) / (plus - minus), 4e-16 * 5);
        // Off the surface the state that follows from the others has no effect.
        EXPECT_EQ(rates(model, "hold", std::vector{0.1, y})[1], rate[1]);
        EXPECT_EQ(evaluate(model, event_function(model, "hold-off"), std::vector{0.0, y}), minus);
        EXPECT_EQ(evaluate(model, event_function(model, "hold-on"), std::vector{0.0, y}), -plus);
    }
    EXPECT_EQ(evaluate(model, event_function(model, "level-rising"), std::vector{0.5, 0.0}), -0.5);
    const Transition& meets = *model.find_transition(1, *model.find_event("level"));
    EXPECT_EQ(next_mode(model, meets, std::vector{0.0, 0.0}), "hold");
    EXPECT_EQ(next_mode(model, meets, std::vector{0.0, -5.0}), "off"); // off goes on towards smaller x
    const Transition& rises = *model.find_transition(0, *model.find_event("level-rising"));
    EXPECT_EQ(rises.label, "off:level");
    EXPECT_EQ(next_mode(model, rises, std::vector{0.0, 0.0}), "hold");
    EXPECT_EQ(next_mode(model, rises, std::vector{0.0, 2.0}), "on");
}

/// A surface that is linear in no state is reached by a step along its gradient: quadratically close.
TEST(Slide, ProjectsOntoCurvedSurfaces) {
    const Model model = parsed(with(relay, "level = \"x\"", "level = \"x^2 + 4*y^2 - 1\""));
    const std::size_t onto = *model.find_jump("onto-level");
    const std::vector<double> near{0.6 + 1e-7, 0.4}, put = jumped(model, onto, near);
    EXPECT_LT(std::abs(put[0] * put[0] + 4 * put[1] * put[1] - 1), 1e-13);
    EXPECT_NE(put[1], near[1]);
    const std::vector<double> rate = rates(model, "hold", std::vector{0.6, 0.4});
    EXPECT_NEAR(2 * 0.6 * rate[0] + 8 * 0.4 * rate[1], 0, 16 * 2.2e-16);
}

/// On v + 2 x = 0, v' = -u - x, x' = v + u^2/2: where v' + 2 x' = 0 with u between -1 and 1, Utkin's u differs from
/// Filippov's share, because x' is not linear in u.
TEST(Slide, UtkinsControlIsPutIntoTheEquations) {
    const std::string text = R"toml(name = "control"
[states]
x = 0
v = 1
z = 0
[modes.low]
rates = { x = "v", v = "-u - x", z = "u^2" }
[modes.high]
rates = { x = "v", v = "-u - x", z = "u^2" }
[events]
line = "v + 2*x"
[slides.s]
surface = "line"
between = ["low", "high"]
convention = "utkin"
control = "u"
[initial]
mode = "high"
)toml";
    const Model model = parsed(text);
    const std::vector<double> state{0.2, -0.4, 0};
    const double control = 2 * state[1] - state[0]; // -u - x + 2 v = 0
    EXPECT_NEAR(rates(model, "s", state)[2], control * control, 1e-15);
    EXPECT_NEAR(rates(model, "s", state)[1], -2 * rates(model, "s", state)[0], 1e-15);
    EXPECT_EQ(rates(model, "low", state)[1], 1 - 0.2);
    EXPECT_EQ(rates(model, "high", state)[1], -1 - 0.2);
    EXPECT_EQ(write_model(parsed(write_model(model))), write_model(model));
    EXPECT_NE(write_model(model).find("control = \"u\""), std::string::npos);
    EXPECT_EQ(
        refusal(with(text, "z = \"u^2\" }\n[events]", "z = \"u\" }\n[events]")),
        "16:11: the rates of 'z' in 'low' and 'high' differ; write the same rates in both modes, with 'u' for what "
        "differs");
    EXPECT_EQ(refusal(with(text, "control = \"u\"\n", "")).substr(0, 5), "7:26:"); // u is not known
    EXPECT_EQ(
        refusal(with(text, "convention = \"utkin\"\n", "")),
        "15:11: the slide 's' has a control, which belongs to the convention of Utkin; add convention = \"utkin\", "
        "or leave it out");
    EXPECT_EQ(
        refusal(with(with(text, "-u - x\", z", "-u^3 - x\", z"), "-u - x\", z", "-u^3 - x\", z")),
        "16:11: the rate of the surface 'line' is not linear in the control 'u'; use the convention of Filippov, or "
        "a control in which it is");
}

TEST(Slide, WatchesWhatBothModesWatch) {
    const std::string both = with(with(relay, "[modes.off]\n", "[modes.off]\nwatch = [\"top\", \"level\"]\n"),
                                  "[modes.on]\n", "[modes.on]\nwatch = [\"top\"]\n");
    const std::string text = with(both, "level = \"x\"\n", "level = \"x\"\ntop = \"5 - y\"\n");
    const auto transitions = [](const std::string& off, const std::string& on) {
        return fmt::format(
            "[jumps.flip]\ny = \"-y\"\n[jumps.kick]\nx = \"x + y\"\n[[transitions]]\nmode = \"off\"\nevent "
            "= \"top\"\n{}\n[[transitions]]\nmode = \"on\"\nevent = \"top\"\n{}\n",
            off, on);
    };
    const Model ends = parsed(text + transitions("next = \"end\"", "next = \"end\""));
    EXPECT_EQ(next_mode(ends, *ends.find_transition(2, 1), std::vector{0.0, 5.0}), "end");
    EXPECT_EQ(ends.events[ends.modes[0].watched[1]].name, "level-rising"); // in the place of the surface
    const Model stays = parsed(text + transitions("jump = \"flip\"\nnext = \"off\"", "jump = \"flip\"\nnext = \"on\""));
    EXPECT_EQ(next_mode(stays, *stays.find_transition(2, 1), std::vector{0.0, 5.0}), "hold");
    const Model thrown =
        parsed(text + transitions("jump = \"kick\"\nnext = \"off\"", "jump = \"kick\"\nnext = \"on\""));
    const Transition& kick = *thrown.find_transition(2, 1);
    EXPECT_EQ(next_mode(thrown, kick, std::vector{1.0, 5.0}), "on");
    EXPECT_EQ(next_mode(thrown, kick, std::vector{-1.0, 5.0}), "off");
    EXPECT_EQ(next_mode(thrown, kick, std::vector{0.0, 5.0}), "hold");
    const std::string differ = text + transitions("next = \"end\"", "next = \"on\"");
    EXPECT_EQ(refusal(differ),
              "19:1: 'off' and 'on' do not go on alike after the event 'top', which the slide 'hold' watches; add "
              "[[transitions]] with mode = \"hold\" and event = \"top\", or name the events in watch");
    EXPECT_EQ(refusal(differ + "[[transitions]]\nmode = \"hold\"\nevent = \"top\"\nnext = \"off\"\n"), "");
    EXPECT_EQ(refusal(with(differ, "surface =", "watch = []\nsurface =")), "");
}

TEST(Friction, MakesModesForBothDirectionsAndRest) {
    const Model model = parsed(block);
    ASSERT_EQ(model.modes.size(), 3U);
    EXPECT_EQ(model.modes[0].name, "free-backward");
    EXPECT_EQ(model.modes[1].name, "free-stick");
    EXPECT_EQ(model.modes[2].name, "free-forward");
    const std::vector<double> state{0.5, 0};
    const double force = 0.1 - 0.5, normal = 1.25;
    EXPECT_NEAR(rates(model, "free-forward", state)[1], (force - 0.3 * normal) / 2, 1e-16);
    EXPECT_NEAR(rates(model, "free-backward", state)[1], (force + 0.3 * normal) / 2, 1e-16);
    EXPECT_EQ(rates(model, "free-stick", std::vector{0.5, 0.7}), (std::vector{0.0, 0.0}));
    EXPECT_NEAR(evaluate(model, event_function(model, "free-stick-forward"), state), 0.45 * normal - force, 1e-15);
    EXPECT_NEAR(evaluate(model, event_function(model, "free-stick-backward"), state), 0.45 * normal + force, 1e-15);
    const Transition& wall = *model.find_transition(0, *model.find_event("wall"));
    EXPECT_EQ(next_mode(model, wall, std::vector{-2.0, 1.0}), "free-forward");
    EXPECT_EQ(next_mode(model, wall, std::vector{-2.0, -1.0}), "free-backward");
    EXPECT_EQ(next_mode(model, wall, std::vector{-2.0, 0.0}), "free-stick"); // 2.1 < 0.45*5
    Model strong = model;
    strong.set_parameter("drive", 1);
    EXPECT_EQ(next_mode(strong, wall, std::vector{-2.0, 0.0}), "free-forward");
}

/// Two bodies, one of which slips on the ground and on the other: both forces at rest follow from both equations.
TEST(Friction, ForcesAtRestOfTwoFrictionsSolveBothEquations) {
    const Model model = parsed(R"toml(name = "two"
[states]
v1 = 0
v2 = 0
x = 0
[modes.m]
rates = { v1 = "(3 - ground - between)/2", v2 = "(1 + between)/5", x = "v1" }
[friction.ground]
velocity = "v1"
normal = 1
coefficient = 2
[friction.between]
velocity = "v1 - v2"
normal = 1
coefficient = 1.5
)toml");
    ASSERT_EQ(model.modes.size(), 9U);
    const std::vector<double> rest{0, 0, 0};
    // At rest v2' = 0: between = -1, and ground = 3 - between = 4.
    EXPECT_EQ(evaluate(model, event_function(model, "m-stick-stick-between-backward"), rest), 1.5 - 1);
    EXPECT_EQ(evaluate(model, event_function(model, "m-stick-stick-ground-forward"), rest), 2 - 4.0);
    // While both slip together on the ground: v1' = (3 - 2 - b)/2 = (1 + b)/5, b = 3/7, v' = 2/7.
    const std::vector<double> rate = rates(model, "m-forward-stick", std::vector{0.3, 0.3, 0.0});
    EXPECT_NEAR(rate[0], 2.0 / 7, 1e-16);
    EXPECT_EQ(rate[0], rate[1]);
    // The start gives way at once: ground can hold 2 of 4; both go together, since 3/7 < 1.5.
    EXPECT_EQ(model.modes[model.initial_mode].name, "m-forward-stick");
}

TEST(Friction, TheStartFollowsTheVelocityUntilAModeIsChosen) {
    Model model = parsed(block);
    EXPECT_EQ(model.modes[model.initial_mode].name, "free-backward"); // the spring is stronger than friction
    model.set_initial("x", 0.2);
    EXPECT_EQ(model.modes[model.initial_mode].name, "free-stick");
    model.set_initial("v", 1);
    EXPECT_EQ(model.modes[model.initial_mode].name, "free-forward");
    EXPECT_NE(write_model(model).find("mode = \"free\""), std::string::npos);
    model.set_initial_mode("free-stick");
    model.set_initial("v", -1);
    EXPECT_EQ(model.modes[model.initial_mode].name, "free-stick");
    EXPECT_EQ(parsed(write_model(model)).initial_mode, model.initial_mode);
}

TEST(Slide, IsWrittenAsItWasDeclared) {
    for (const std::string& text : {relay, block}) {
        Model model = parsed(text);
        model.set_parameter(model.parameters[0].name, 0.125);
        const std::string written = write_model(model);
        EXPECT_EQ(written.find("-rising"), std::string::npos);
        EXPECT_EQ(written.find("-stick"), std::string::npos);
        const Model again = parsed(written);
        EXPECT_EQ(write_model(again), written);
        EXPECT_EQ(again.modes.size(), model.modes.size());
        EXPECT_EQ(again.parameters[0].value, 0.125);
        const Model copy = model;
        EXPECT_EQ(write_model(copy), written);
        // What was changed after the declarations were completed is not lost.
        model.modes[0].rates[0] = model.number(7);
        const Model changed = parsed(write_model(model));
        EXPECT_TRUE(changed.slides.empty() && changed.frictions.empty());
        EXPECT_EQ(changed.modes.size(), model.modes.size());
        EXPECT_TRUE(changed.modes[0].rates[0].is_number(7));
    }
}

/// A shipped-like model in C++.
TEST(Slide, IsCompletedOnceInModelsFromCpp) {
    Model model;
    model.name = "cpp";
    const Expression x = model.symbol("x");
    model.states.push_back({.name = "x", .initial = model.number(1)});
    model.modes.push_back({.name = "up", .rates = {model.number(1)}});
    model.modes.push_back({.name = "down", .rates = {model.number(-2)}});
    model.events.push_back({.name = "zero", .function = x});
    model.slides.push_back({.name = "rest", .surface = 0, .left = 0, .right = 1});
    model.initial_mode = 1;
    EXPECT_NE(message_of([&] { model.validate(); }).find("call Model::complete"), std::string::npos);
    model.complete();
    EXPECT_EQ(message_of([&] { model.validate(); }), "");
    EXPECT_EQ(model.modes.size(), 3U);
    const std::size_t transitions = model.transitions.size();
    model.complete();
    EXPECT_EQ(model.transitions.size(), transitions);
    EXPECT_TRUE(model_warnings(model).empty());
    Model wrong;
    wrong.states = {{.name = "x", .initial = wrong.number(0)}};
    wrong.modes = {{.name = "m", .rates = {wrong.number(0)}}};
    wrong.slides.push_back({.name = "s", .surface = 3});
    EXPECT_NE(message_of([&] { wrong.complete(); }).find("refers to event 3"), std::string::npos);
    EXPECT_EQ(wrong.modes.size(), 1U); // nothing has changed
}

/// A parameter of a surface that moves changes the motion along it.
TEST(Slide, IsDerivedAgainForADrivenParameter) {
    const Model model = parsed(with(relay, "level = \"x\"", "level = \"x - k\""));
    DrivenParameter driven = drive_parameter(model, "k", DriveKind::shift);
    driven.model.set_parameter(driven.rate, 0.5);
    const std::vector<double> rate = rates(driven.model, "hold", std::vector{0.35, 0.0, 0.1});
    EXPECT_NEAR(rate[0], 0.5, 1e-15); // x follows k + shift
    EXPECT_EQ(rate[2], 0.5);
    EXPECT_NE(write_model(driven.model).find("[slides.hold]"), std::string::npos);
}

TEST(Slide, MistakesHavePlacesAndRemedies) {
    const auto at = [](const std::string& text, const std::string& said) {
        EXPECT_EQ(refusal(text).substr(0, said.size()), said) << refusal(text);
    };
    at(with(relay, "surface = \"level\"\n", ""), "13:9: slides.hold has no surface; add surface = ...");
    at(with(relay, "between = [\"off\", \"on\"]\n", ""), "13:9: slides.hold has no modes; add between = ...");
    at(with(relay, "[\"off\", \"on\"]", "[\"off\"]"), "16:11: slides.hold.between has 1 modes; name two");
    at(with(relay, "[\"off\", \"on\"]", "[\"off\", \"onn\"]"), "16:19: there is no mode 'onn'; did you mean 'on'?");
    at(with(relay, "[\"off\", \"on\"]", "[\"on\", \"on\"]"), "16:1: the slide 'hold' is between a mode and itself");
    at(with(relay, "surface = \"level\"", "surface = \"lewel\""), "15:11: there is no event 'lewel'");
    at(with(relay, "level = \"x\"", "level = { function = \"x\", kind = \"section\" }"),
       "15:11: the surface 'level' is a section; make it a barrier");
    at(with(relay, "level = \"x\"", "level = \"k\""), "15:11: the surface 'level' does not depend on a state");
    at(with(relay, "text = \"kept", "conventoin = \"utkin\"\ntext = \"kept"),
       "14:1: unknown key 'conventoin' in slides.hold; did you mean 'convention'?");
    at(with(relay, "text = \"kept", "convention = \"fillipov\"\ntext = \"kept"),
       "14:14: slides.hold.convention cannot be 'fillipov'; choose from filippov, utkin");
    at(with(relay, "slides.hold", "slides.on"), "13:9: slides.on makes the mode 'on', but there is one of this name");
    at(with(relay, "y = \"2 + x\"", "y = \"2 + w\""), "10:33: unknown name 'w'");
    at(with(with(relay, "x = \"1 + k*y\"", "x = -1"), "x = \"y - 1\"", "x = -1"),
       "16:1: 'off' and 'on' cross the surface 'level' at the same rate, so that nothing slides");
    at(relay + "[[transitions]]\nmode = \"on\"\nevent = \"level\"\nnext = \"off\"\n",
       "16:1: mode 'on' has a transition for 'level' already; leave it out: the slide 'hold' makes it");
    at(relay + "[slides.again]\nsurface = \"level\"\nbetween = [\"off\", \"on\"]\n",
       "21:1: two slides have mode 'off' at the surface 'level'");
    at(with(relay, "level = \"x\"", "level = \"x\"\nlevel-rising = \"y\""),
       "14:9: slides.hold makes the event 'level-rising', but there is one of this name; rename what it is made for");
    const auto more = [](const char* slide, const char* left, const char* right, int rate) {
        return fmt::format(
            "[modes.{1}]\nrates = {{ x = {3}, y = 1 }}\n[modes.{2}]\nrates = {{ x = -2, y = 1 }}\n[slides.{0}]\n"
            "surface = \"level\"\nbetween = [\"{1}\", \"{2}\"]\n",
            slide, left, right, rate);
    };
    at(relay + more("o", "c-d", "e", 2) + more("o-c", "d", "f", 3),
       "30:9: slides.o-c makes the event 'o-c-d', but there is one of this name; rename what it is made for");
    at(block + "[events.zero]\nfunction = \"v\"\n" +
           "[slides.free-stick]\nsurface = \"zero\"\nbetween = [\"free\", \"free\"]\n",
       "29:9: slides.free-stick makes a second mode 'free-stick'; rename one of the two");
}

TEST(Friction, MistakesHavePlacesAndRemedies) {
    const auto at = [](const std::string& text, const std::string& said) {
        EXPECT_EQ(refusal(text).substr(0, said.size()), said) << refusal(text);
    };
    at(with(block, "velocity = \"v\"\n", ""), "13:11: friction.rub has no velocity; add velocity = ...");
    at(with(block, "normal = \"1 + x^2\"\n", ""), "13:11: friction.rub has no normal force; add normal = ...");
    at(with(block, "coefficient = \"mu\"\n", ""), "13:11: friction.rub has no coefficient; add coefficient = ...");
    at(with(block, "velocity = \"v\"", "velocity = \"mu\""),
       "14:12: the velocity of the friction 'rub' does not depend on a state");
    at(with(block, "1.5*mu", "0.5*mu"),
       "17:10: static friction of 'rub' is 0.3 in the initial state, less than dynamic friction, 0.6");
    at(with(block, "force - rub", "force + rub"),
       "12:1: in mode 'free' the friction 'rub' accelerates its velocity; write -rub");
    at(with(block, "force - rub", "force - rub^3"),
       "12:1: the rates of mode 'free' are not linear in the friction 'rub'");
    at(with(block, "(force - rub)/2", "force/2"), "13:11: no mode has the friction 'rub' in its rates");
    at(with(block, "x = \"v\", v = \"(force - rub)/2\"", "x = \"v - rub\", v = \"force/2\""),
       "12:1: the friction 'rub' in mode 'free' has no effect on the rate of its velocity");
    at(with(block, "0.1*v\"", "0.1*v - rub\""),
       "9:30: definitions.force.value uses the friction 'rub'; write it in rates only");
    at(with(block, "wall = \"x + 2\"", "wall = \"x + 2 - rub\""),
       "19:17: events.wall.function uses the friction 'rub'; write it in rates only");
    at(with(block, "friction.rub", "friction.mu"),
       "13:11: the name 'mu' is used twice, for a parameter and for a friction");
    at(with(block, "event = \"wall\"", "event = \"wall\"\nchatter = { mode = \"free\", jump = \"bounce\" }"),
       "22:1: chatter leads to the mode 'free', and may change the velocity of its friction 'rub'; name one of the "
       "modes");
    at(block.substr(0, block.find("[[transitions]]")),
       "11:10: mode 'free' watches the barrier 'wall' but has no transition for it");
}

} // namespace graze::sliding_test
