// Branches of models with declared contacts.

#include "follow.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>

namespace graze::contacts_branch_test {

using namespace graze::testing;
using std::numbers::pi;

/// The shipped ball on a vibrating table as a declared contact.
const std::string ball = R"toml(
parameters = { g = 9.81, e = 0.8, a = 0.002, f = 10, omega = "2*pi*f" }
states = { x = 0.05, v = 0, theta = { initial = 0, period = "2*pi" } }
modes.flight.rates = { x = "v", v = "-g", theta = "omega" }
contacts.velocities = ["v"]
contacts.mass = [1]
contacts.table = { gap = "x - a*sin(theta)", restitution = "e" }
)toml";

/// The same with friction and a spring that holds the ball sideways: several cases of one impact.
const std::string rubbing = R"toml(
parameters = { g = 9.81, e = 0.8, a = 0.002, f = 10, omega = "2*pi*f" }
states = { x = 0.05, v = 0, theta = { initial = 0, period = "2*pi" }, s = 0, u = 0 }
modes.flight.rates = { x = "v", v = "-g", theta = "omega", s = "u", u = "-300*s - 4*u" }
contacts.velocities = ["v", "u"]
contacts.mass = [1, 1]
contacts.table = { gap = "x - a*sin(theta)", restitution = "e", friction = 0.3, slip = "u" }
)toml";

/// Phase of the impact of the orbit with one impact in each period of the table, the stable one.
double phase(double a) {
    const double g = 9.81, e = 0.8, f = 10, omega = 2 * pi * f;
    return std::acos(g / (2 * f) * (1 - e) / (1 + e) / (a * omega));
}

/// The branch has the special points of the shipped model, whose fold is known: a omega^2 = pi g (1 - e)/(1 + e).
TEST(Contacts, BranchesAreThoseOfTheWrittenModel) {
    const double a = 0.002, f = 10, at = phase(a);
    const std::vector<double> start{a * std::sin(at), 9.81 / (2 * f), at};
    const Model shipped = shipped_with("bouncing-ball", {{"a", a}});
    const Orbit known = given_orbit(shipped, "impact", {start}, {1 / f});
    for (const bool rubs : {false, true}) {
        const Model model = model_from(rubs ? rubbing : ball);
        std::vector<double> here = start;
        if (rubs)
            here.insert(here.end(), {0, 0});
        const Orbit orbit = given_orbit(model, rubs ? "flight:table:stick" : "flight:table", {here}, {1 / f});
        for (const int direction : {1, -1}) {
            const Branch branch = follow_branch(System(model), orbit, in_parameter(model, "a", {}, 0.006, direction));
            const Branch expected =
                follow_branch(System(shipped), known, in_parameter(shipped, "a", {}, 0.006, direction));
            ASSERT_FALSE(branch.special.empty());
            EXPECT_EQ(branch.special[0].type, expected.special[0].type);
            EXPECT_NEAR(branch.special[0].parameter, expected.special[0].parameter, 1e-14);
            if (direction < 0) {
                EXPECT_NEAR(branch.special[0].parameter * std::pow(2 * pi * f, 2), pi * 9.81 * 0.2 / 1.8, 1e-10);
            }
            for (const BranchPoint& point : branch.points)
                if (direction > 0) {
                    EXPECT_TRUE(point.solution.certificate.admissible) << point.solution.certificate.reason;
                }
        }
    }
}

} // namespace graze::contacts_branch_test
