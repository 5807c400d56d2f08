#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <gtest/gtest.h>
#include <random>

namespace graze::testing {

/// Noise that is the same with every standard library (their normal distributions differ).
class Noise {
public:
    explicit Noise(std::uint64_t seed) : engine_(seed) {}
    double uniform() { return (static_cast<double>(engine_() >> 11) + 0.5) * 0x1p-53; }
    /// Standard normal (Box and Muller).
    double normal() {
        const double radius = std::sqrt(-2 * std::log(uniform()));
        return radius * std::cos(2 * std::acos(-1.0) * uniform());
    }

private:
    std::mt19937_64 engine_;
};

constexpr std::size_t experiments = 200;

/// Expects 180 to 198 of 200 intervals of 95 % to cover the truth: 190 +- 3 is the binomial count.
inline void expect_coverage(std::size_t covered, const char* what) {
    EXPECT_GE(covered, 180U) << what;
    EXPECT_LE(covered, 198U) << what;
}

} // namespace graze::testing
