// Declarations of conserved quantities, where they do not hold, and states on which nothing depends.

#include "graze/model/conserved.hpp"

#include "base/message_of.hpp"
#include "graze/model/check.hpp"
#include "graze/model/model_file.hpp"
#include "trajectory/model_parts.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

namespace graze::conserved_test {

using namespace graze::testing;

/// A mass on a spring with a stop. @param conserved lines of the table
Model with_stop(const std::string& conserved, const std::string& parameters = "e = 1\nzeta = 0") {
    return OneMode{.parameters = parameters,
                   .states = "x = 0\nv = 0.5\ns = 0",
                   .rates = "x = 'v', v = '-x - zeta*v', s = 'v'",
                   .stops = {{"wall", "1 - x", "v = '-e*v'\ns = 's + 0.1'", "impact"}},
                   .more = "[conserved]\n" + conserved}
        .model();
}

TEST(Conserved, IsReadWrittenAndTested) {
    const Model model = with_stop("energy = { value = 'v^2/2 + x^2/2', unit = 'J', text = 'of the mass' }");
    ASSERT_EQ(model.conserved.size(), 1U);
    EXPECT_EQ(model.conserved[0].unit, "J");
    EXPECT_EQ(why_not_conserved(model, 0), "");
    const Model again = parse_model(write_model(model), "again");
    EXPECT_EQ(write_model(again), write_model(model));
    EXPECT_EQ(again.conserved[0].text, "of the mass");
}

TEST(Conserved, SaysInWhichModeOrTransitionItChanges) {
    const std::string energy = "energy = 'v^2/2 + x^2/2'";
    EXPECT_NE(why_not_conserved(with_stop(energy, "e = 1\nzeta = 0.1"), 0)
                  .find("'energy' is not conserved: in mode 'free' it changes at the rate"),
              std::string::npos);
    EXPECT_NE(why_not_conserved(with_stop(energy, "e = 0.9\nzeta = 0"), 0)
                  .find("'energy' is not conserved: the transition 'impact' changes it from"),
              std::string::npos);
    EXPECT_NE(why_not_conserved(with_stop("energy = 'v^2/2 + x^2'"), 0).find("in mode 'free'"), std::string::npos);
    // The same stands among the warnings of `graze check`.
    bool warned = false;
    for (const ModelWarning& warning : located_warnings(with_stop(energy, "e = 0.9\nzeta = 0")))
        warned = warned || warning.text.find("is not conserved") != std::string::npos;
    EXPECT_TRUE(warned);
    const Model angle = OneMode{.states = "q = { initial = 1, period = '2*pi' }\nw = 0",
                                .rates = "q = 'w', w = 1",
                                .more = "[conserved]\nenergy = 'w^2/2 - q'"}
                            .model();
    EXPECT_NE(why_not_conserved(angle, 0).find("after a period of 'q'"), std::string::npos);
}

/// A runner on a massless springy leg. @param energy lines of the table
Model runner(const std::string& energy) {
    return model_from("[parameters]\nk = 20\nalpha = 1.2\n[states]\nx = 0\ny = 1\nvx = 1.6\nvy = 0\nfoot = 0\n"
                      "[definitions]\nleg = 'sqrt((x - foot)^2 + y^2)'\npush = 'k*(1 - leg)/leg'\n"
                      "[modes.flight]\nrates = { x = 'vx', y = 'vy', vx = 0, vy = -1, foot = 0 }\n"
                      "watch = ['touchdown']\n"
                      "[modes.stance]\nrates = { x = 'vx', y = 'vy', vx = 'push*(x - foot)', vy = 'push*y - 1', "
                      "foot = 0 }\nwatch = ['takeoff']\n"
                      "[events]\ntouchdown = { function = 'y - sin(alpha)', kind = 'section' }\n"
                      "takeoff = { function = '1 - leg', kind = 'section' }\n"
                      "[jumps.step]\nfoot = 'x + cos(alpha)'\n"
                      "[[transitions]]\nmode = 'flight'\nevent = 'touchdown'\nlabel = 'touchdown'\njump = 'step'\n"
                      "next = 'stance'\n[[transitions]]\nmode = 'stance'\nevent = 'takeoff'\nlabel = 'takeoff'\n"
                      "next = 'flight'\n[initial]\nmode = 'flight'\n[conserved.energy]\n" +
                      energy);
}

TEST(Conserved, ConstantsAndWhatIsNeverANumberAreNone) {
    for (const std::string text : {"3", "e", "x - x"})
        EXPECT_NE(why_not_conserved(with_stop("energy = '" + text + "'"), 0)
                      .find("'energy' is no first integral: it has the same value at all states"),
                  std::string::npos)
            << text;
    EXPECT_NE(why_no_first_integral(with_stop("energy = 'sqrt(-1 - x^2)'"), 0)
                  .find("'energy' is no first integral: in mode 'free' it is not a number (as at x = "),
              std::string::npos);
    EXPECT_EQ(why_no_first_integral(with_stop("energy = 'sqrt(x)'"), 0), "") << "a number at some states";
    // In a mode that is far from the initial state it need not be a number around that.
    const std::string far = "value = '(vx^2 + vy^2)/2 + y'\nmodes = { stance = 'sqrt(-100 - y)' }";
    EXPECT_EQ(why_no_first_integral(runner(far), 0), "");
    bool warned = false;
    for (const ModelWarning& warning : located_warnings(with_stop("energy = '3'")))
        warned = warned || warning.text.find("it has the same value at all states; give") != std::string::npos;
    EXPECT_TRUE(warned);
}

TEST(Conserved, AlongAMotionOnlyItsOwnStatesCount) {
    // The motion x = sin(t), v = cos(t) from 0.2 to 2.6, where x is positive.
    std::vector<StateInMode> motion;
    for (int i = 1; i < 14; ++i)
        motion.push_back({0, {std::sin(0.2 * i), std::cos(0.2 * i), 0}});
    const auto why = [&](const std::string& energy) {
        return why_not_conserved_along(with_stop("energy = '" + energy + "'", "e = 0.9\nzeta = 0"), 0, motion);
    };
    EXPECT_EQ(why("v^2/2 + x^2/2"), "") << "the impact is not part of the motion";
    EXPECT_EQ(why("v^2/2 + sqrt(x)^4/2"), "") << "negative x are not either";
    EXPECT_NE(why("v^2/2 + x^2/3").find("'energy' is not conserved: in mode 'free' it changes at the rate"),
              std::string::npos);
    EXPECT_NE(why("v^2/2 + x^2/2 + 1e-6*x").find("in mode 'free' it changes"), std::string::npos);
    EXPECT_NE(why("sqrt(-x)").find("it is not a number"), std::string::npos);
    EXPECT_NE(why("3").find("the same value at all states"), std::string::npos);
}

TEST(Conserved, MayHaveAnExpressionOfItsOwnInAMode) {
    const std::string moving = "(vx^2 + vy^2)/2 + y";
    const Model model = runner("value = '" + moving + "'\nmodes = { stance = '" + moving + " + k*(1 - leg)^2/2' }");
    EXPECT_EQ(why_not_conserved(model, 0), "");
    EXPECT_NE(why_not_conserved(runner("value = '" + moving + "'"), 0).find("in mode 'stance'"), std::string::npos);
    EXPECT_NE(message_of([&] {
                  runner("modes = { stance = '" + moving + "' }");
              }).find("conserved.energy has no expression in mode 'flight'"),
              std::string::npos);
    EXPECT_EQ(write_model(parse_model(write_model(model), "again")), write_model(model));
}

TEST(Conserved, StatesOnWhichNothingDependsAreFoundAloneAndInPairs) {
    const Model stop = with_stop("energy = 'v^2/2 + x^2/2'");
    EXPECT_EQ(ignorable_states(stop), (std::vector<std::size_t>{2}));
    EXPECT_TRUE(stop.states[2].drifting);
    EXPECT_FALSE(stop.states[0].drifting);
    // Without a declaration nothing is changed.
    EXPECT_FALSE(with_stop("").states[2].drifting);
    const std::string moving = "(vx^2 + vy^2)/2 + y";
    const Model run = runner("value = '" + moving + "'\nmodes = { stance = '" + moving + " + k*(1 - leg)^2/2' }");
    EXPECT_TRUE(ignorable_states(run).empty());
    EXPECT_TRUE(run.states[0].drifting);
    EXPECT_FALSE(run.states[4].drifting);
    ASSERT_TRUE(run.states[4].drifts_with);
    EXPECT_EQ(*run.states[4].drifts_with, 0U);
}

/// A body and two feet, of which one takes the place of the other; and two bodies that have nothing to do with one
/// another.
TEST(Conserved, StatesOfWhichOnlyDistancesMatterAreFoundInSets) {
    const Model walk =
        model_from("[states]\ny = 1\nrear = 0\nx = 0.1\nw = 0\nfront = 0.3\n[modes.on]\n"
                   "rates = { y = 'w', w = '-y', rear = 0, x = 'w', front = 0 }\nwatch = ['off']\n[modes.both]\n"
                   "rates = { y = 'w', w = '(x - rear) - y + (x - front)^3', rear = 0, x = 'w', front = 0 }\n"
                   "[events]\noff = 'x - rear - 1'\n[jumps.swing]\nrear = 'front'\nfront = 'x + y'\n[[transitions]]\n"
                   "mode = 'on'\nevent = 'off'\njump = 'swing'\nnext = 'both'\n[initial]\nmode = 'on'\n"
                   "[conserved]\nheight = 0\n");
    EXPECT_TRUE(walk.states[1].drifting);
    EXPECT_EQ(walk.states[2].drifts_with, std::optional<std::size_t>(1));
    EXPECT_EQ(walk.states[4].drifts_with, std::optional<std::size_t>(1));
    EXPECT_FALSE(walk.states[0].drifting || walk.states[3].drifting || walk.states[0].drifts_with);
    const Model apart = model_from("[states]\na = 0\nb = 1\nc = 0\nd = 2\n[modes.on]\n"
                                   "rates = { a = 'b - a', b = 'a - b', c = 'd - c', d = 'sin(c - d)' }\n"
                                   "[conserved]\nsum = 'a + b'\n");
    EXPECT_FALSE(apart.states[0].drifting); // the sum itself is moved
    EXPECT_TRUE(apart.states[2].drifting);
    EXPECT_EQ(apart.states[3].drifts_with, std::optional<std::size_t>(2));
}

TEST(Conserved, NamesAreChecked) {
    EXPECT_NE(message_of([] {
                  with_stop("period = 'v^2/2 + x^2/2'");
              }).find("'period' cannot be the name of a conserved quantity"),
              std::string::npos);
    EXPECT_NE(message_of([] {
                  with_stop("zeta = 'v^2/2 + x^2/2'");
              }).find("the name 'zeta' of a conserved quantity is used twice"),
              std::string::npos);
    EXPECT_NE(message_of([] { with_stop("energy = 'v^2/2 + y'"); }).find("unknown name 'y'"), std::string::npos);
    EXPECT_NE(message_of([] { with_stop("energy = { modes = { fly = 'v' } }"); }).find("fly"), std::string::npos);
}

} // namespace graze::conserved_test
