// Impacts of two contacts with friction that accumulate together: which of them sticks or slips when both are closed is
// told by velocities, which stay as they are.

#include "simulate.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

using namespace graze;
using namespace graze::testing;

namespace resting_contact_test {

/// Random bodies with elastic forces that are pushed to and fro, above two planes.
struct Case {
    std::string name, text;
    std::vector<std::size_t> velocities; ///< indices of states
    std::vector<double> expected;        ///< positions after the time 4, by time stepping
    double error = 0;                    ///< of these: halved where steps are halved
};

Case four_velocities() {
    return {"four velocities",
            R"toml(
states = { a = 0, b = 0, c = 0, g = 0, u = -0.43, v = 0.06, w = -1.04, o = -0.16, th = { initial = 0, period = "2*pi" } }
contacts.velocities = ["u", "v", "w", "o"]
contacts.mass = [[2.472, -0.766, 0.045, 0.068], [-0.766, 1.97, -0.12, -0.271], [0.045, -0.12, 1.835, 0.324], [0.068, -0.271, 0.324, 1.276]]
[modes.free]
rates = { a = "u", b = "v", c = "w", g = "o", th = 1.96 }
[modes.free.forces]
u = "-1.7376 - 0.05*cos(th) - 1.1*a - 0.25*u"
v = "-0.5629 - 0.24*cos(th) - 1.05*b - 0.22*v"
w = "-2.0329 - 0.4*cos(th) - 0.8*c - 0.28*w"
o = "-1.0421 + 0.99*cos(th) - 1.15*g - 0.09*o"
[contacts.A]
gap = "2.05*a + 0.46*b + 0.78*c + 0.66*g + 0.11"
restitution = 0.62
friction = 0.08
slip = "-0.64*u + 0.54*v - 0.08*w - 1.12*o"
[contacts.B]
gap = "-0.46*a + 0.19*b + 2.15*c + 0.67*g + 0.45"
restitution = 0.64
friction = 0.3
slip = "0.15*u + 0.22*v - 0.84*w - 0.41*o"
)toml",
            {4, 5, 6, 7},
            {0.0264839652, 0.2844618747, -0.1415485391, -0.2799041418},
            1e-5};
}

Case three_velocities() {
    return {"three velocities",
            R"toml(
states = { a = 0, b = 0, c = 0, u = -0.64, v = -0.42, w = 0.23, th = { initial = 0, period = "2*pi" } }
contacts.velocities = ["u", "v", "w"]
contacts.mass = [[1.37, -0.39, -0.084], [-0.39, 2.131, 0.586], [-0.084, 0.586, 1.473]]
[modes.free]
rates = { a = "u", b = "v", c = "w", th = 2.88 }
[modes.free.forces]
u = "-1.051 + 0.16*cos(th) - 0.35*a - 0.14*u"
v = "0.28 + 0.7*cos(th) - 1.18*b - 0.23*v"
w = "1.3952 + 0.5*cos(th) - 0.99*c - 0.12*w"
[contacts.A]
gap = "0.23*a - 0.13*b - 1.08*c + 0.22"
restitution = 0
friction = 0.38
slip = "0.22*u - 1.56*v + 0.17*w"
[contacts.B]
gap = "1.25*a - 0.2*b - 0.16*c + 0.48"
restitution = 0.11
friction = 0.11
slip = "0.12*u - 0.33*v - 1.15*w"
)toml",
            {3, 4, 5},
            {-0.4019090860, -0.2284172334, 0.1456068596},
            1e-4};
}

/// The last impact of one contact comes when its gap does not close any more.
Case closes_without_impact() {
    return {"closes without impact",
            R"toml(
states = { a = 0, b = 0, c = 0, g = 0, u = -0.48, v = -0.01, w = -0.17, o = -0.37, th = { initial = 0, period = "2*pi" } }
contacts.velocities = ["u", "v", "w", "o"]
contacts.mass = [[1.349, -0.143, 0.443, -0.586], [-0.143, 3.505, 0.478, -0.783], [0.443, 0.478, 1.87, -0.977], [-0.586, -0.783, -0.977, 2.477]]
[modes.free]
rates = { a = "u", b = "v", c = "w", g = "o", th = 2.94 }
[modes.free.forces]
u = "-0.5081 + 0.35*cos(th) - 0.41*a - 0.12*u"
v = "-0.6839 + 0.5*cos(th) - 1.49*b - 0.18*v"
w = "1.4115 + 0.31*cos(th) - 0.34*c - 0.25*w"
o = "-0.1881 + 0.01*cos(th) - 0.97*g - 0.12*o"
[contacts.A]
gap = "0.34*a - 0.06*b - 1.02*c - 0.12*g + 0.23"
restitution = 0
friction = 0.23
slip = "0.15*u - 0.88*v + 1.66*w - 0.76*o + 0.66"
[contacts.B]
gap = "0.43*a + 1.57*b - 1.05*c + 0.63*g + 0.19"
restitution = 0.57
friction = 0.1
slip = "0.87*u + 0.5*v - 0.46*w + 0.78*o + 0.71"
)toml",
            {4, 5, 6, 7},
            {-0.9084661782, 0.1055190646, -0.0753046278, -0.0699910072},
            3e-5};
}

/// The time stepping is Moreau's scheme: positions at midpoints, and in each step the complementarity problem of
/// impulses with friction, solved by trying all combinations of rest, both slips and separation; 64000 steps.
TEST(RestingContacts, AgreeWithTimeStepping) {
    for (const Case& one : {four_velocities(), three_velocities(), closes_without_impact()}) {
        SCOPED_TRACE(one.name);
        Experiment experiment(model_from(one.text));
        EXPECT_EQ(experiment.run(4).ending, Ending::end_time) << experiment.trajectory.outcome().detail;
        for (std::size_t i = 0; i < one.expected.size(); ++i)
            EXPECT_NEAR(experiment.state()[i], one.expected[i], one.error) << i;
    }
}

/// What comes to rest takes an impulse of the size of the speeds that are left, whatever the mode that follows.
TEST(RestingContacts, KeepVelocities) {
    for (const Case& one : {four_velocities(), three_velocities(), closes_without_impact()}) {
        SCOPED_TRACE(one.name);
        Experiment experiment(model_from(one.text));
        experiment.run(4);
        std::size_t rests = 0;
        for (const auto& [contact, before, after] : experiment.recorder.contacts()) {
            if (contact.kind != ContactKind::sticking)
                continue;
            ++rests;
            for (const std::size_t velocity : one.velocities)
                EXPECT_NEAR(after[velocity], before[velocity], std::max(100 * std::abs(contact.rate_before), 1e-14))
                    << contact.time;
        }
        EXPECT_GE(rests, 2U);
    }
}

} // namespace resting_contact_test
