// First guesses of homoclinic orbits from periodic ones, of closed form.

#include "orbit/homoclinic_candidate.hpp"

#include "orbit/orbits.hpp"
#include "trajectory/model_parts.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace graze::homoclinic_candidate_test {

using namespace graze::testing;

/// x'' = x - 2 d x' between impacts at x = 1, from one of the speed v on.
Model at_wall(double v) {
    return OneMode{.parameters = "d = 0.3\ne = 1",
                   .states = fmt::format("x = 1\nv = {:.17g}", v),
                   .rates = "x = 'v', v = 'x - 2*d*v'",
                   .stops = {{"wall", "1 - x", "v = '-e*v'", "impact"}}}
        .model();
}

/// The motion that comes back to the wall after a time: x = a exp(l t) + b exp(m t).
struct Round {
    explicit Round(double time) {
        const double root = std::sqrt(1.09), l = root - 0.3, m = -root - 0.3;
        const double far = std::exp(l * time), near = std::exp(m * time);
        a = (1 - near) / (far - near);
        b = 1 - a;
        speed = a * l + b * m;
    }
    double a = 0, b = 0, speed = 0;
};

TEST(HomoclinicCandidate, BeginsAndEndsBesideTheSaddleThatIsPassed) {
    double before = 1;
    for (const double time : {12.0, 18.0, 24.0}) {
        const Round round(time);
        const Model model = at_wall(round.speed);
        const Orbit orbit = given_orbit(model, "impact", {{1, round.speed}}, {time});
        const auto candidate = homoclinic_candidate(System(model), orbit, 1e-13);
        ASSERT_TRUE(candidate) << time;
        EXPECT_EQ(to_string(model, candidate->orbit.signature), "impact saddle");
        EXPECT_LT(candidate->distance, 0.2 * before);
        before = candidate->distance;
        EXPECT_EQ(candidate->orbit.starts[1], orbit.starts[0]);
        // It begins on the line of the unstable space, and takes less time than the orbit.
        EXPECT_NEAR(candidate->orbit.starts[0][1] / candidate->orbit.starts[0][0], std::sqrt(1.09) - 0.3, 1e-9);
        EXPECT_LT(candidate->orbit.return_time(), time);
        EXPECT_GT(candidate->orbit.return_time(), time - 6);
    }
}

TEST(HomoclinicCandidate, ThereIsNoneOfAnOrbitThatPassesNoSaddle) {
    const Round round(2);
    const Model model = at_wall(round.speed);
    const Orbit orbit = given_orbit(model, "impact", {{1, round.speed}}, {2});
    EXPECT_FALSE(homoclinic_candidate(System(model), orbit, 1e-13));
}

} // namespace graze::homoclinic_candidate_test
