#pragma once

#include "graze/identify/estimate.hpp"
#include "record/waves.hpp"

#include <gtest/gtest.h>

namespace graze::testing {

constexpr std::size_t experiments = 200;

/// Whether an interval of 95 % covers the truth. @param roundoff by which it may be missed
inline bool covers(const Estimate& estimate, double truth, double roundoff = 0) {
    return std::abs(estimate.value - truth) < estimate.half_width() + roundoff;
}

/// Expects 180 to 198 of 200 intervals of 95 % to cover the truth: 190 +- 3 is the binomial count.
inline void expect_coverage(std::size_t covered, const char* what) {
    EXPECT_GE(covered, 180U) << what;
    EXPECT_LE(covered, 198U) << what;
}

} // namespace graze::testing
