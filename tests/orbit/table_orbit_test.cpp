// Orbits under forces that are known at points only.

#include "graze/model/model_file.hpp"
#include "orbits.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <string>

namespace graze::table_orbit_test {

using namespace graze::testing;

/// An oscillator on a measured spring, under a recorded periodic force, that hits a stop.
Model driven(const std::string& interpolation) {
    return parse_model(fmt::format(R"toml(
[parameters]
c = 0.2
r = 0.8
A = 1
[states]
x = 0
v = 0
s = {{ initial = 0, period = 5 }}
[tables.force]
points = [[0, 0.9], [1, 0.4], [2, -0.7], [3, -0.9], [4.2, 0.3], [5, 0.9]]
periodic = true
interpolation = "{0}"
[tables.spring]
points = [[-1, -1.4], [-0.5, -0.6], [0, 0], [0.3, 0.4], [0.6, 0.9]]
outside = "linear"
interpolation = "{0}"
[modes.free]
watch = ["stop"]
rates = {{ x = "v", v = "A*force(s) - spring(x) - c*v", s = 1 }}
[events.stop]
function = "0.7 - x"
[jumps.impact]
v = "-r*v"
[[transitions]]
mode = "free"
event = "stop"
jump = "impact"
next = "free"
[sections.start]
state = "s"
value = 0
)toml",
                                   interpolation),
                       "driven.toml");
}

TEST(TableOrbit, MultipliersHaveTheProductOfLiouville) {
    for (const char* interpolation : {"linear", "cubic"}) {
        const OrbitSolution solution = settled(driven(interpolation), "start");
        ASSERT_EQ(solution.outcome, OrbitOutcome::converged) << solution.detail;
        EXPECT_LT(solution.residual, 1e-12);
        ASSERT_EQ(solution.multipliers.size(), 2U);
        const auto impacts = static_cast<double>(solution.orbit.signature.size());
        ASSERT_GE(impacts, 1) << interpolation;
        const double product = std::exp(-0.2 * solution.orbit.period()) * std::pow(0.8, 2 * impacts);
        EXPECT_NEAR(std::abs(solution.multipliers[0] * solution.multipliers[1] - product), 0, 1e-9) << interpolation;
        EXPECT_NEAR(std::fmod(solution.orbit.period() + 1e-9, 5), 0, 2e-9);
        EXPECT_TRUE(solution.certificate.admissible) << solution.certificate.reason;
    }
}

} // namespace graze::table_orbit_test
