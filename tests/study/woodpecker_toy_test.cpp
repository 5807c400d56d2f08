// The shipped woodpecker: its orbit as published, its jammed swing in closed form.

#include "study/study_fixture.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

namespace graze::woodpecker_toy_test {

using namespace graze::testing;

class WoodpeckerToy : public StudyFixture {};

/// Leine, Glocker and van Campen (2001) give v = -0.3411 and wS = -7.4583 at phiS = -0.2788; time stepping with steps
/// of 1e-6 s gives the period 0.14598 s, v = -0.3395 and wS = -7.4620.
TEST_F(WoodpeckerToy, PecksAsPublished) {
    expect_complete(run(R"(name = "s"
model = "woodpecker-toy"
[runs.pecking]
kind = "orbit"
section = "leaning"
)"));
    const ResultFile file(path_, ResultFile::Access::read);
    const OrbitRecord record = file.orbits("pecking", false).at(0);
    EXPECT_TRUE(record.stable);
    EXPECT_NEAR(record.point.solution.orbit.period(), 0.145976, 2e-6);
}

} // namespace graze::woodpecker_toy_test
