#include "identify/chi_square.hpp"

#include <gtest/gtest.h>

namespace graze::testing {

// Tabulated quantiles (M. Abramowitz and I. A. Stegun, Table 26.8), to their digits.
TEST(ChiSquare, TailEqualsTabulatedValues) {
    EXPECT_NEAR(chi_square_tail(3.84146, 1), 0.05, 1e-6);
    EXPECT_NEAR(chi_square_tail(9.21034, 2), 0.01, 1e-7);
    EXPECT_NEAR(chi_square_tail(7.81473, 3), 0.05, 1e-6);
    EXPECT_NEAR(chi_square_tail(20.5150, 5), 0.001, 1e-7);
    EXPECT_NEAR(chi_square_tail(18.3070, 10), 0.05, 1e-5);
    EXPECT_NEAR(chi_square_tail(43.7730, 30), 0.05, 1e-5);
    EXPECT_EQ(chi_square_tail(0, 4), 1);
    EXPECT_EQ(chi_square_tail(1e6, 4), 0);
}

} // namespace graze::testing
