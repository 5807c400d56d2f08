// Saddle cycles as functions of parameters: closed forms of a map.

#include "orbit/saddle_cycle.hpp"

#include "orbit/newton.hpp"
#include "orbit/saddle_cycles.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace graze::saddle_cycle_test {

using namespace graze::testing;

constexpr double a = 1.3, b = 0.3;

class SaddleCycleTest : public ::testing::Test {
protected:
    SaddleCycle cycle_at(double at) const {
        SaddleCycle cycle(Simulation(System(model_), {}, {}, integration(1e-13)), saddle_of_henon(model_, a, b),
                          {model_.independent_parameter("a")});
        cycle.set_scales(Eigen::Vector3d(1, 0.5, 1));
        EXPECT_TRUE(cycle.follow(std::vector{at, b})) << cycle.problem();
        return cycle;
    }
    Model model_ = henon_map(a, b);
};

TEST_F(SaddleCycleTest, FollowsTheParameterWithItsSpaces) {
    for (const double at : {a, 1.31, 1.28}) {
        const SaddleCycle cycle = cycle_at(at);
        const HenonSaddle exact(at, b);
        EXPECT_NEAR(cycle.state()[0], exact.x, 1e-14);
        EXPECT_NEAR(cycle.state()[1], exact.y, 1e-14);
        EXPECT_NEAR(cycle.unstable_multiplier(), exact.unstable, 1e-13);
        EXPECT_NEAR(cycle.growth(), std::log(-exact.unstable), 1e-13);
        EXPECT_NEAR(cycle.decay(), -std::log(exact.stable), 1e-12);
        // Eigenvectors of ((-2 a x, 1), (b, 0)): right (mu, b), left (mu, 1).
        const Eigen::VectorXd& v = cycle.unstable_direction();
        EXPECT_NEAR(v[1] / v[0], b / exact.unstable, 1e-13);
        EXPECT_NEAR(cycle.length_of(v), 1, 1e-14);
        const Eigen::RowVectorXd& w = cycle.unstable_coordinate();
        EXPECT_NEAR(w[1] / w[0], 1 / exact.unstable, 1e-13);
        EXPECT_NEAR(w.dot(v), 1, 1e-13);
    }
}

TEST_F(SaddleCycleTest, MovesWithTheParameterAsDifferencesSay) {
    const SaddleCycle cycle = cycle_at(a);
    constexpr double step = 1e-6;
    const HenonSaddle more(a + step, b), less(a - step, b);
    EXPECT_NEAR(cycle.state_by_parameters()(0, 0), (more.x - less.x) / (2 * step), 1e-9);
    EXPECT_NEAR(cycle.state_by_parameters()(1, 0), (more.y - less.y) / (2 * step), 1e-9);
}

TEST_F(SaddleCycleTest, ATurnBesideItIsThatOfTheMap) {
    const SaddleCycle cycle = cycle_at(a);
    const SaddleCycle::Turn turn = cycle.turn_from(Eigen::Vector3d(1e-3, 2e-3, 0));
    ASSERT_EQ(turn.starts.size(), 1U);
    EXPECT_NEAR(turn.starts[0][0], cycle.state()[0] + 1e-3, 1e-15);
    EXPECT_NEAR(turn.durations[0], 1, 1e-14);
    EXPECT_NEAR(turn.off[0], -2 * a * cycle.state()[0] * 1e-3 + 2e-3, 1e-14);
    EXPECT_NEAR(turn.off[1], b * 1e-3, 1e-15);
}

} // namespace graze::saddle_cycle_test
