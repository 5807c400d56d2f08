// Motions from the unstable space of a cycle: a closed form through a contact.

#include "orbit/manifold_motion.hpp"

#include "orbit/newton.hpp"
#include "orbit/saddle_cycles.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace graze::manifold_motion_test {

using namespace graze::testing;

TEST(ManifoldMotion, HasTheSegmentsOfTheCycleAndContacts) {
    const Model model = gated_saddle(0.2);
    const double turn = 2 * std::numbers::pi;
    const Simulation simulation(System(model), {}, {}, integration(1e-13));
    SaddleCycle cycle(simulation, origin_of(model), {});
    ASSERT_TRUE(cycle.follow(model.parameter_values()));
    ManifoldFollower follower(System(model), cycle, 1e-13, 3 * turn);
    const double x = 0.1, to_gate = std::log(1 / x) / 0.2; // in the second turn
    const ManifoldMotion motion = follower.follow(x / cycle.unstable_direction()[0]);
    ASSERT_GE(motion.segments(), 3U);
    EXPECT_EQ(to_string(model, {motion.orbit.signature.begin(), motion.orbit.signature.begin() + 3}),
              "start back start");
    EXPECT_NEAR(motion.orbit.starts[0][0], x, 1e-15);
    EXPECT_NEAR(motion.orbit.starts[1][0], x * std::exp(0.2 * turn), 1e-12);
    EXPECT_NEAR(motion.orbit.durations[0], turn, 1e-12);
    EXPECT_NEAR(motion.orbit.durations[1], to_gate - turn, 1e-11);
    EXPECT_NEAR(motion.orbit.starts[2][0], 0.2 + 0.5 * std::cos(to_gate), 1e-11);
    EXPECT_TRUE(follower.may_pass(motion, 1));
    EXPECT_FALSE(follower.may_pass(motion, 2)); // the gate
}

} // namespace graze::manifold_motion_test
