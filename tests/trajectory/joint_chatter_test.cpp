// Contacts that hit one another until all rest: stacks of balls, against closed forms and an independent simulation.

#include "closed_form.hpp"
#include "simulate.hpp"
#include "stack_of_balls.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

using namespace graze;
using namespace graze::testing;

namespace joint_chatter_test {

/// Runs a stack; returns when all rest, negative (and the reason) if they do not.
double time_of_rest(const Stack& stack, double end, std::string& why) {
    Experiment experiment(model_from(stack.model()), with_tolerance(1e-12));
    const Outcome& outcome = experiment.run(end);
    const std::string& mode = experiment.simulation.model().modes[experiment.trajectory.mode()].name;
    why = fmt::format("{} in {}: {}", name_of(outcome.ending), mode, outcome.detail);
    if (outcome.ending != Ending::end_time ||
        std::ranges::count(mode, '-') != static_cast<std::ptrdiff_t>(stack.size()))
        return -1;
    for (std::size_t i = 0; i < 2 * stack.size(); ++i)
        EXPECT_EQ(experiment.state()[i], 0) << why;
    const auto& contacts = experiment.recorder.contacts();
    return contacts.empty() ? -1 : contacts.back().contact.time;
}

/// A ball that falls on an equal one, which rests on the floor. Up to e = 3 - 2 sqrt(2) the three collide infinitely
/// often at one instant, and rest (Bernu and Mazighi 1990).
TEST(JointChatter, CollapsesAtOneInstant) {
    std::string why;
    for (const double e : {0.01, 0.05, 0.1, 0.15, 0.17})
        for (const double height : {1e-9, 0.1, 1e6}) {
            const double fall = std::sqrt(2 * height / 9.81);
            const double rest = time_of_rest({{1, 1}, {e, e}, {0, height}, {0, 0}}, 2 * fall, why);
            EXPECT_NEAR(rest, fall, 1e-14 * fall) << e << ' ' << why;
        }
}

/// Above, the lower ball is at rest again before the upper one, with a speed that has fallen by a constant factor,
/// comes back: flights are a geometric series.
TEST(JointChatter, FollowsTheGeometricSeries) {
    std::string why;
    for (const double e : {0.75, 0.8, 0.85, 0.9, 0.95, 0.98, 0.99})
        for (const double ratio : {0.5, 1.0, 2.0}) { // of the lower mass to the upper one
            double lower = 0, upper = -1;
            for (bool hit = true; hit;) {
                hit = upper < lower;
                if (hit) {
                    const double impulse = (1 + e) * (lower - upper) / (1 + ratio);
                    upper += ratio * impulse;
                    lower -= impulse;
                }
                lower = std::max(lower, -e * lower);
            }
            if (!(lower / (1 - e) < upper)) // the lower one is not at rest yet
                continue;
            const double fall = std::sqrt(2 / 9.81), expected = fall * (1 + 2 * upper / (1 - upper));
            const double rest = time_of_rest({{ratio, 1}, {e, e}, {0, 1}, {0, 0}}, 2 * expected, why);
            EXPECT_NEAR(rest, expected, 1e-11 * expected) << e << ' ' << ratio << ' ' << why;
        }
}

/// Where the first ball of a row begins, and the forces on each.
struct RowStart {
    double place = 0, speed = 0, stiffness = 0, damping = 0;
};

/// Equal balls in a row that touch, but for the first one.
Model row_of_balls(int balls, double restitution, const RowStart& start) {
    std::string states, rates, velocities, masses, contacts;
    for (int i = 0; i < balls; ++i) {
        states += fmt::format("x{0} = {1}, v{0} = {2}, ", i, i == 0 ? start.place : 0, i == 0 ? start.speed : 0);
        rates += fmt::format("x{0} = \"v{0}\", v{0} = \"-{1}*x{0} - {2}*v{0}\", ", i, start.stiffness, start.damping);
        velocities += fmt::format("\"v{}\", ", i);
        masses += "1, ";
        if (i > 0)
            contacts +=
                fmt::format("contacts.c{1} = {{ gap = \"x{1} - x{0}\", restitution = {2} }}\n", i - 1, i, restitution);
    }
    return model_from(fmt::format("states = {{ {} }}\nmodes.free.rates = {{ {} }}\ncontacts.law = \"sequence\"\n"
                                  "contacts.velocities = [{}]\ncontacts.mass = [{}]\n{}initial.mode = \"free\"\n",
                                  states.substr(0, states.size() - 2), rates.substr(0, rates.size() - 2), velocities,
                                  masses, contacts));
}

/// Balls in a row without forces, the first of which hits the others, which touch: below e = 7 - 4 sqrt(3) three of
/// them stay together (Bernu and Mazighi 1990), and more of them for such e as well. They go on with the common
/// momentum.
TEST(JointChatter, BallsInARowStayTogether) {
    for (const int balls : {3, 4, 5})
        for (const double e : {0.0, 0.01, 0.05, 0.07})
            for (const double unit : {1e-9, 1.0, 1e6}) {
                Experiment experiment(row_of_balls(balls, e, {.place = -unit, .speed = unit}));
                const Outcome& outcome = experiment.run(3);
                ASSERT_EQ(outcome.ending, Ending::end_time) << balls << ' ' << e << ' ' << outcome.detail;
                for (std::size_t i = 0; i < static_cast<std::size_t>(balls); ++i) {
                    EXPECT_NEAR(experiment.state()[2 * i], 2 * unit / balls, 1e-12 * unit) << balls << ' ' << e;
                    EXPECT_NEAR(experiment.state()[2 * i + 1], unit / balls, 1e-13 * unit) << balls << ' ' << e;
                }
            }
}

/// Damped pendulums that touch at rest (Newton's cradle) swing together in the end, through instants with any number of
/// impacts.
TEST(JointChatter, CradleSwings) {
    for (const int balls : {3, 4, 5})
        for (const double e : {0.0, 0.05, 0.3, 0.8, 0.95, 0.99, 1.0})
            for (const double damping : {0.0, 0.1}) {
                Experiment experiment(row_of_balls(balls, e, {.place = -1, .stiffness = 9, .damping = damping}));
                const Outcome& outcome = experiment.run(60);
                ASSERT_EQ(outcome.ending, Ending::end_time)
                    << balls << ' ' << e << ' ' << damping << ' ' << outcome.detail;
                if (e > 0.05 || damping > 0)
                    continue;
                // Together from the first impact on, at the time pi/6, with a common momentum of 3.
                const double phase = 3 * 60 - std::acos(-1.0) / 2;
                for (std::size_t i = 0; i < static_cast<std::size_t>(balls); ++i)
                    EXPECT_NEAR(experiment.state()[2 * i], std::sin(phase) / balls, 1e-10) << balls << ' ' << e;
            }
}

/// Columns of two and three balls, of any size, whatever the order of their impacts. Some need too many impacts: the
/// motion then ends and says so.
TEST(JointChatterSlow, RandomStacksRestWhenAnIndependentSimulationDoes) {
    Random random(5);
    int compared = 0, undecided = 0, other = 0, late = 0;
    double worst = 0;
    std::string which;
    for (int i = 0; i < 150; ++i) {
        Stack stack;
        const std::size_t balls = random.chance(0.6) ? 2 : 3;
        const double length = random.log_uniform(1e-9, 1e6);
        const bool equal = random.chance(0.4);
        for (std::size_t k = 0; k < balls; ++k) {
            stack.mass.push_back(equal ? 1 : random.log_uniform(1e-3, 1e3));
            stack.restitution.push_back(random.uniform(0, 0.9));
            stack.gap.push_back(random.chance(0.1) ? 0 : length * random.uniform(0.1, 1));
            stack.velocity.push_back(0);
        }
        stack.gravity = random.log_uniform(0.1, 1e3);
        const double expected = known_rest(stack), size = std::sqrt(length / stack.gravity);
        std::string why;
        const double rest = time_of_rest(stack, expected > 0 ? 2 * expected : 1000 * size, why);
        if (rest < 0) {
            const bool says_so = why.starts_with("no-progress");
            ++(says_so ? undecided : other);
            if (!says_so)
                which += fmt::format("{} {}\n{}\n", i, why, stack.model());
            continue;
        }
        if (expected < 0)
            continue;
        ++compared;
        const double error = std::abs(rest - expected) / expected;
        worst = std::max(worst, error);
        late += error > 1e-10;
        if (error > 1e-10)
            which += fmt::format("{} late by {}, {}\n{}\n", i, error, rest, stack.model());
    }
    EXPECT_EQ(other, 0) << which;
    EXPECT_EQ(late, 0) << worst << '\n' << which;
    EXPECT_LT(undecided, 10);
    EXPECT_GT(compared, 100);
}

} // namespace joint_chatter_test
