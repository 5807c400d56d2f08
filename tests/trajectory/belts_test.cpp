// A plank on two belts, and a block on two feet: slips of one direction, which stop one by one or at once. Against
// closed forms.

#include "simulate.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <string>
#include <utility>
#include <vector>

using namespace graze;
using namespace graze::testing;

namespace belts_test {

constexpr double first_force = 0.065, second_force = 0.035; ///< friction: 0.1 times the loads 0.65 and 0.35

Model plank(double push, double belt, double speed, double height = 0, double torque = 0.3) {
    return model_from(fmt::format(R"toml(
parameters = {{ belt = {}, push = {} }}
states = {{ x = 0, y = {}, p = 0, u = {}, v = 0, w = 0 }}
modes.free.rates = {{ x = "u", y = "v", p = "w" }}
modes.free.forces = {{ u = "push", v = -1, w = {} }}
contacts.velocities = ["u", "v", "w"]
contacts.mass = [1, 1, 1]
contacts.A = {{ gap = "y - p", restitution = 0, friction = 0.1, slip = "u" }}
contacts.B = {{ gap = "y + p", restitution = 0, friction = 0.1, slip = "u + belt" }}
)toml",
                                  belt, push, height, speed, torque));
}

struct Motion {
    double x = 0, u = 0;
};

/// Coulomb's friction as an inclusion: forces are constant between the speeds 0 and -belt, at which one of them may
/// take any value between both of its limits.
Motion closed_form(double push, double belt, double u, double time) {
    const std::array<double, 2> zeros{0, -belt}, forces{first_force, second_force};
    double x = 0;
    while (time > 0) {
        double least = push, greatest = push;
        for (std::size_t i = 0; i < 2; ++i) {
            least -= u >= zeros[i] ? forces[i] : -forces[i];
            greatest -= u > zeros[i] ? forces[i] : -forces[i];
        }
        const double a = least > 0 ? least : greatest < 0 ? greatest : 0;
        double next = 0, until = time;
        for (const double zero : zeros)
            if (a * (zero - u) > 0 && (zero - u) / a < until) {
                until = (zero - u) / a;
                next = zero;
            }
        x += until * (u + a * until / 2);
        u = until < time ? next : u + a * until;
        time -= until;
    }
    return {x, u};
}

TEST(Belts, OfDifferentSpeedsStopAPlankOneByOne) {
    for (const double belt : {0.1, -0.07, 1e-9})
        for (const double push : {-0.2, -0.05, -0.03, -0.01, 0.01, 0.03, 0.05, 0.2})
            for (const double speed : {0.1, -0.05, -0.2}) {
                SCOPED_TRACE(fmt::format("belt {}, push {}, speed {}", belt, push, speed));
                Experiment experiment(plank(push, belt, speed));
                EXPECT_EQ(experiment.run(6).ending, Ending::end_time) << experiment.trajectory.outcome().detail;
                const Motion expected = closed_form(push, belt, speed, 6);
                EXPECT_NEAR(experiment.state()[0], expected.x, 1e-13);
                EXPECT_NEAR(experiment.state()[3], expected.u, 1e-14);
            }
}

/// Belts of the same speed are one floor, whatever expression says so.
TEST(Belts, OfTheSameSpeedStopAPlankAtOnce) {
    for (const double push : {-0.2, -0.09, 0.0, 0.05, 0.2}) {
        Experiment experiment(plank(push, 0, 0.2));
        EXPECT_EQ(experiment.run(6).ending, Ending::end_time) << experiment.trajectory.outcome().detail;
        const Motion expected = closed_form(push, 0, 0.2, 6);
        EXPECT_NEAR(experiment.state()[0], expected.x, 1e-13) << push;
        EXPECT_NEAR(experiment.state()[3], expected.u, 1e-14) << push;
        if (std::abs(push) < 0.1) {
            EXPECT_EQ(experiment.simulation.model().modes[experiment.trajectory.mode()].name, "free-A-stick-B-stick");
        }
    }
}

/// A plank that falls onto both belts at once cannot stick to both. Each takes an impulse of 1/2: the second one, which
/// rubs, brakes by 0.05, of which the first needs 0.02 to stop the speed 0.03 and holds the rest.
TEST(Belts, ImpactsDoNotStickToBoth) {
    Experiment experiment(plank(0.02, 0.1, 0.01, 0.5, 0));
    EXPECT_EQ(experiment.run(1.1).ending, Ending::end_time) << experiment.trajectory.outcome().detail;
    EXPECT_EQ(experiment.simulation.model().modes[experiment.trajectory.mode()].name, "free-A-stick-B-forward");
    EXPECT_NEAR(experiment.state()[0], 0.02, 1e-15);
    EXPECT_NEAR(experiment.state()[3], 0, 1e-16);
}

/// A block with feet at two heights, which rub with the same coefficient and together carry the weight 1: whatever the
/// shares, it moves as one mass, u' = p cos t - mu sgn u.
TEST(Belts, FeetAtTwoHeightsMoveAsOneMass) {
    std::vector<std::pair<double, double>> settings;
    for (const double push : {0.2, 0.38, 0.5, 0.6, 0.9, 1.2, 2.0})
        for (const double mu : {0.1, 0.2, 0.4, 0.7, 1.0})
            if (push != mu) // a push that just reaches the limit is decided by round-off
                settings.emplace_back(push, mu);
    for (const auto& pair : settings) {
        const double push = pair.first, mu = pair.second; // clang 14 has no lambdas that capture structured bindings
        SCOPED_TRACE(fmt::format("push {}, friction {}", push, mu));
        Experiment experiment(model_from(fmt::format(R"toml(
states = {{ x = 0, y = 0, p = 0, u = 0.3, v = 0, w = 0, th = {{ initial = 0, period = "2*pi" }} }}
modes.free.rates = {{ x = "u", y = "v", p = "w", th = 1 }}
modes.free.forces = {{ u = "{0}*cos(th)", v = -1, w = 0.1 }}
contacts.velocities = ["u", "v", "w"]
contacts.mass = [1, 1, 0.3]
contacts.A = {{ gap = "y - p", restitution = 0, friction = {1}, slip = "u + 0.5*w" }}
contacts.B = {{ gap = "y + p", restitution = 0, friction = {1}, slip = "u + 0.3*w" }}
)toml",
                                                     push, mu)));
        EXPECT_EQ(experiment.run(20).ending, Ending::end_time) << experiment.trajectory.outcome().detail;
        double t = 0, u = 0.3, x = 0;
        const auto zero = [](const auto& function, double from) { // first one after `from`
            double until = from + 1e-9;
            while (function(until) * function(from + 1e-9) > 0 && until < 20)
                until += 1e-3;
            double low = std::max(from + 1e-9, until - 1e-3);
            for (int i = 0; i < 60; ++i)
                (function((low + until) / 2) * function(from + 1e-9) > 0 ? low : until) = (low + until) / 2;
            return std::min(until, 20.0);
        };
        while (t < 20) {
            const double start = t;
            if (u == 0 && std::abs(push * std::cos(t)) < mu * (1 - 1e-9)) {
                t = zero([&](double s) { return mu - std::abs(push * std::cos(s)); }, t);
                continue;
            }
            const double force = u != 0 ? std::copysign(mu, u) : std::copysign(mu, std::cos(t));
            const auto speed = [&](double s) {
                return u + push * (std::sin(s) - std::sin(start)) - force * (s - start);
            };
            t = zero(speed, start);
            const double d = t - start;
            x += u * d - push * (std::cos(t) - std::cos(start) + std::sin(start) * d) - force * d * d / 2;
            u = t < 20 ? 0 : speed(t);
        }
        EXPECT_NEAR(experiment.state()[0], x, 1e-10);
        EXPECT_NEAR(experiment.state()[3], u, 1e-10);
    }
}

/// A block at rest whose feet rub differently is pushed harder and harder. It holds as long as its weight can be shared
/// so that both do: up to the push at which both are at their limits. In units from nano to mega.
TEST(Belts, FeetThatRubDifferentlyGiveWayTogether) {
    std::mt19937_64 random(1);
    std::uniform_real_distribution<double> share(0, 1);
    for (int i = 0; i < 12; ++i) {
        const double unit = std::array{1e-9, 1e-3, 1.0, 1e6}[static_cast<std::size_t>(i) % 4];
        const double first_height = 0.1 + share(random), second_height = 0.1 + share(random),
                     first = 0.05 + 0.4 * share(random), second = 0.05 + 0.4 * share(random),
                     torque = 0.2 * (share(random) - 0.5);
        SCOPED_TRACE(
            fmt::format("unit {}, heights {} {}, friction {} {}", unit, first_height, second_height, first, second));
        Experiment experiment(model_from(fmt::format(R"toml(
states = {{ x = 0, y = 0, p = 0, u = 0, v = 0, w = 0, s = 0 }}
modes.free.rates = {{ x = "u", y = "v", p = "w", s = 1 }}
modes.free.forces = {{ u = "0.1*s*{0}^2", v = "-{0}^2", w = "{5}*{0}^3" }}
contacts.velocities = ["u", "v", "w"]
contacts.mass = ["{0}", "{0}", "0.3*{0}^3"]
contacts.A = {{ gap = "y - p*{0}", restitution = 0, friction = {3}, slip = "u + {1}*w*{0}" }}
contacts.B = {{ gap = "y + p*{0}", restitution = 0, friction = {4}, slip = "-2*u - 2*{2}*w*{0}" }}
)toml",
                                                     unit, first_height, second_height, first, second, torque)));
        EXPECT_EQ(experiment.run(10).ending, Ending::end_time) << experiment.trajectory.outcome().detail;
        // The lever of the second foot doubles its force: N1 + N2 = 1, N2 - N1 - h1 mu1 N1 - 2 h2 mu2 N2 + torque = 0.
        const double p1 = 1 + first_height * first, p2 = 1 - 2 * second_height * second;
        const double n1 = (p2 + torque) / (p1 + p2), n2 = 1 - n1;
        ASSERT_GT(std::min(n1, n2), 0);
        const double slips = 10 * (first * n1 + 2 * second * n2);
        const auto& contacts = experiment.recorder.contacts();
        ASSERT_EQ(contacts.size(), slips < 10 ? 1U : 0U);
        if (contacts.empty())
            continue;
        EXPECT_NEAR(contacts.front().contact.time, slips, 1e-12 * slips);
        const double d = 10 - slips;
        EXPECT_NEAR(experiment.state()[0], unit * 0.1 * d * d * d / 6, 1e-11 * unit);
        EXPECT_NEAR(experiment.state()[3], unit * 0.1 * d * d / 2, 1e-11 * unit);
    }
}

/// A body in a corner rubs along the floor while the wall holds it: its slip is zero with the wall's gap.
TEST(Belts, WallsHoldWhatRubsAlongTheFloor) {
    Experiment experiment(model_from(R"toml(
states = { x = 0, y = 0, u = 0, v = 0, s = 0 }
modes.free.rates = { x = "u", y = "v", s = 1 }
modes.free.forces = { u = "0.2*s - 1", v = -1 }
contacts.velocities = ["u", "v"]
contacts.mass = [1, 1]
contacts.floor = { gap = "y", restitution = 0, friction = 0.3, slip = "u" }
contacts.wall = { gap = "x", restitution = 0 }
)toml"));
    EXPECT_EQ(experiment.run(8).ending, Ending::end_time) << experiment.trajectory.outcome().detail;
    ASSERT_EQ(experiment.recorder.contacts().size(), 1U); // the push reaches 0.3
    EXPECT_NEAR(experiment.recorder.contacts().front().contact.time, 6.5, 1e-12);
    EXPECT_NEAR(experiment.state()[0], 0.2 * 1.5 * 1.5 * 1.5 / 6, 1e-13);
}

} // namespace belts_test
