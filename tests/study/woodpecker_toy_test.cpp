// The woodpecker toy (F. Pfeiffer 1984; R. I. Leine, C. Glocker and D. H. van Campen 2001) as an orbit: as published,
// and its jammed swing in closed form.

#include "graze/model/model_file.hpp"
#include "study/study_fixture.hpp"
#include "trajectory/woodpecker_toy.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

namespace graze::woodpecker_toy_test {

using namespace graze::testing;

class WoodpeckerToy : public StudyFixture {
protected:
    WoodpeckerToy() { folder_.write("toy.toml", woodpecker_toy); }
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
    const Model model = parse_model(woodpecker_toy, "toy.toml");
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
