#include "orbit/end_distances.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace graze::end_distances_test {

TEST(EndDistances, MakeTheErrorOfTheLinearSpacesRoundOff) {
    for (const double growth : {0.5, 1.0, 3.0}) {
        const EndDistances wanted = wanted_distances(growth, 1);
        EXPECT_NEAR(std::pow(wanted.departure, 2 + 1 / growth), 1e-13, 1e-15);
        EXPECT_NEAR(std::pow(wanted.approach, 2 + growth), 1e-13, 1e-15);
    }
    EXPECT_EQ(wanted_distances(1, 100).departure, 0.05); // where the other space contracts so much
}

} // namespace graze::end_distances_test
