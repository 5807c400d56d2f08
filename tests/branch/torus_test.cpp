#include "graze/branch/torus.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace graze::torus_test {

TEST(Torus, StatesAreThoseOfTheSeries) {
    const Torus torus{{}, 0.3, {{1, 0}, {2, 0}, {0, 3}, {0, -1}, {0.5, 0}}};
    EXPECT_EQ(torus.harmonics(), 2U);
    for (const double turns : {0.0, 0.2, 0.77, 3.2}) {
        const double angle = 2 * std::numbers::pi * turns;
        const std::vector<double> state = torus.state_at(turns);
        EXPECT_NEAR(state[0], 1 + 2 * std::cos(angle) + 0.5 * std::sin(2 * angle), 1e-14);
        EXPECT_NEAR(state[1], 3 * std::sin(angle) - std::cos(2 * angle), 1e-14);
    }
}

TEST(Torus, ThatIsNotGivenHasNoStates) {
    EXPECT_TRUE(Torus().state_at(0.5).empty());
}

} // namespace graze::torus_test
