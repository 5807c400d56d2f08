#include "settle.hpp"

#include <gtest/gtest.h>

namespace graze::exponent_test {

TEST(Exponent, KnownValuesLieWithinTheStatedError) {
    // Families with known exponents, each with another kind of convergence.
    int all = 0, within = 0;
    const auto count = [&](const PointResult& result, double truth, const std::string& name) {
        if (!result.lyapunov || !result.lyapunov_error)
            return;
        ++all;
        within += std::abs(*result.lyapunov - truth) <= *result.lyapunov_error ? 1 : 0;
        EXPECT_LE(std::abs(*result.lyapunov - truth), 3 * *result.lyapunov_error) << name << " " << *result.lyapunov;
    };
    for (int k = 0; k < 60; ++k) { // random: the logistic map at 4
        const PointResult result = settle(iterated("4*z*(1 - z)", 0.1 + 0.013 * k));
        count(result, std::log(2.0), fmt::format("logistic {}", k));
    }
    for (int k = 0; k < 20; ++k) { // bounded: conservative and dissipative tori
        const double Omega = 1.35 + 0.037 * k;
        count(settle(oscillator("-X", SectionOf::clock, 1, 0, Omega)), 0, fmt::format("linear torus {}", k));
        count(settle(iterated(fmt::format("z + {} - 0.1*sin(2*pi*z)", 0.31 + 0.0123 * k), 0.2, true)), 0,
              fmt::format("circle {}", k));
    }
    for (int k = 0; k < 15; ++k) // like the logarithm of time: neighbours on other tori move apart
        count(settle(oscillator("-X - X^3", SectionOf::clock, 0.3 + 0.1 * k, 0)), 0, fmt::format("Duffing {}", k));
    for (int k = 0; k < 15; ++k) { // steady: growth of a linear oscillator
        const double zeta = 0.001 * (k + 1);
        count(settle(oscillator(fmt::format("{}*V - X", 2 * zeta), SectionOf::clock, 1, 0, 1.7)), zeta,
              fmt::format("growth {}", k));
    }
    for (int k = 0; k < 20; ++k) { // random: tents of two slopes, whose invariant density is even
        const double a = 0.21 + 0.029 * k;
        count(settle(in_two_pieces(fmt::format("z/{:.17g}", a), fmt::format("(1 - z)/{:.17g}", 1 - a), a, 0.1234)),
              -a * std::log(a) - (1 - a) * std::log(1 - a), fmt::format("tent {}", k));
    }
    EXPECT_GE(all, 120);
    EXPECT_GE(within, 0.95 * all) << all;
}

TEST(Exponent, AllCyclesAfterTheTransientAreUsed) {
    // The error decreases like the inverse square root of the requested cycles.
    std::vector<double> errors;
    for (const std::size_t cycles : {150u, 5000u, 40000u}) {
        AttractorOptions options;
        options.cycles = cycles;
        const PointResult result = settle(iterated("4*z*(1 - z)", 0.1234), options);
        ASSERT_EQ(result.label, Label::chaotic);
        EXPECT_EQ(result.cycles, cycles + std::max<std::size_t>(cycles, options.chaos_cycles));
        errors.push_back(*result.lyapunov_error);
        EXPECT_NEAR(*result.lyapunov, std::log(2.0), 2 * errors.back()) << cycles;
    }
    EXPECT_LT(errors[1], 0.7 * errors[0]);
    EXPECT_LT(errors[2], 0.7 * errors[1]);
    EXPECT_LT(errors[2], 0.005);
}

} // namespace graze::exponent_test
