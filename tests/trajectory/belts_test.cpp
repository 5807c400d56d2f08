// A plank on two belts, and a block on two feet: slips of one direction, which stop one by one or at once. Against
// closed forms.

#include "simulate.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <utility>

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
    for (const auto& pair : {std::pair{0.9, 0.4}, {0.6, 0.2}, {0.9, 0.1}, {1.2, 0.4}, {0.5, 0.2}}) {
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

} // namespace belts_test
