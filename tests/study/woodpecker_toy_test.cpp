// The woodpecker toy (F. Pfeiffer 1984; R. I. Leine, C. Glocker and D. H. van Campen 2001) as an orbit: as published,
// and its jammed swing in closed form.

#include "graze/model/model_file.hpp"
#include "study/study_fixture.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

namespace graze::woodpecker_toy_test {

using namespace graze::testing;

const std::string toy = R"toml(
parameters = { g = 9.81, mM = 0.0003, JM = 5e-9, mS = 0.0045, JS = 7e-7, c = 0.0056, play = 0.0006, rM = 0.0031, hM = 0.0058, lM = 0.01, lG = 0.015, hS = 0.02, lS = 0.0201, reach = 0.0024, mu = 0.3, e = 0.5 }
states = { y = { initial = 0, drifting = true }, phiM = "-play/hM", phiS = -0.2788, v = -0.3395, wM = 0, wS = -7.462 }
definitions.spring = "c*(phiM - phiS)"
initial.mode = "free"
[modes.free]
rates = { y = "v", phiM = "wM", phiS = "wS" }
forces = { v = "-(mS + mM)*g", wM = "-spring - mS*g*lM", wS = "spring - mS*g*lG" }
[contacts]
velocities = ["v", "wM", "wS"]
mass = [["mS + mM", "mS*lM", "mS*lG"], ["mS*lM", "JM + mS*lM^2", "mS*lM*lG"], ["mS*lG", "mS*lM*lG", "JS + mS*lG^2"]]
beak = { gap = "reach - hS*phiS", restitution = "e", friction = "mu", slip = "v + lM*wM + (lG - lS)*wS" }
lower = { gap = "play + hM*phiM", restitution = 0, friction = "mu", slip = "v + rM*wM" }
upper = { gap = "play - hM*phiM", restitution = 0, friction = "mu", slip = "v + rM*wM" }
[sections.leaning]
function = "phiS + 0.2788"
direction = "falling"
)toml";

class WoodpeckerToy : public StudyFixture {
protected:
    WoodpeckerToy() { folder_.write("toy.toml", toy); }
};

/// Published are v = -0.3411 and wS = -7.4583 at phiS = -0.2788, by time stepping; time stepping with steps of 1e-6 s
/// gives the period 0.14598 s, v = -0.3395 and wS = -7.4620.
TEST_F(WoodpeckerToy, IsAnOrbitWithTheClosedFormOfItsSwing) {
    expect_complete(run(R"(name = "s"
model = "./toy.toml"
[runs.pecking]
kind = "orbit"
section = "leaning"
cycles = 200
[runs.branch]
kind = "continue"
start = { run = "pecking" }
along = { e = [0.49, 0.51] }
)"));
    const ResultFile file(path_, ResultFile::Access::read);
    const OrbitRecord record = file.orbits("pecking", false).at(0);
    EXPECT_TRUE(record.stable);
    const Orbit& orbit = record.point.solution.orbit;
    EXPECT_NEAR(orbit.period(), 0.145976, 2e-6);
    // While friction holds the sleeve at the lower edge the woodpecker swings about a balance of its own.
    const double w = std::sqrt(0.0056 / (7e-7 + 0.0045 * 0.015 * 0.015)),
                 middle = -0.0006 / 0.0058 - 0.0045 * 9.81 * 0.015 / 0.0056;
    const Model model = parse_model(toy, "toy.toml");
    std::size_t swings = 0;
    for (std::size_t k = 0; k < orbit.segments(); ++k) {
        if (model.modes[orbit.signature[k].mode].name != "free-lower-stick")
            continue;
        ++swings;
        const std::vector<double>&from = orbit.starts[k], &to = orbit.starts[(k + 1) % orbit.segments()];
        const double turn = w * orbit.durations[k];
        EXPECT_NEAR(to[2], middle + (from[2] - middle) * std::cos(turn) + from[5] / w * std::sin(turn), 1e-11);
        EXPECT_NEAR(to[5], from[5] * std::cos(turn) - (from[2] - middle) * w * std::sin(turn), 1e-9);
    }
    EXPECT_EQ(swings, 1U);
    // Nothing happens to it nearby: a contact that closes is not two events at once.
    for (const OrbitRecord& one : file.orbits("branch", true))
        EXPECT_TRUE(one.point.type == PointType::bound || one.point.type == PointType::end ||
                    one.point.type == PointType::regular)
            << one.label << ' ' << one.point.parameter;
}

} // namespace graze::woodpecker_toy_test
