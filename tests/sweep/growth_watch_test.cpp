#include "settle.hpp"

#include <gtest/gtest.h>

#include <random>

namespace graze {
namespace {

TEST(GrowthWatch, linear_oscillators_that_gain_energy_are_unbounded_in_any_units) {
    std::mt19937 random(2);
    std::uniform_real_distribution<double> uniform(0, 1);
    for (int k = 0; k < 60; ++k) {
        const double zeta = -std::pow(10, 3.5 * uniform(random) - 3);
        const double length = std::pow(10, std::floor(18 * uniform(random)) - 12);
        const auto section = k % 2 == 0 ? SectionOf::clock : SectionOf::states;
        const std::string force = k % 4 == 0 ? " + cos(theta)" : "";
        const PointResult result = settle(oscillator(fmt::format("-2*({:.17g})*V - X{}", zeta, force), section, 0.3,
                                                     0.1, 0.5 + uniform(random), length, 1e-6));
        EXPECT_EQ(result.label, Label::unbounded) << k << " " << zeta << " " << length;
    }
    EXPECT_EQ(settle(first_order("x", SectionOf::clock, 1)).label, Label::unbounded);
    EXPECT_EQ(settle(first_order("x", SectionOf::states, 1)).label, Label::unbounded);
}

TEST(GrowthWatch, growth_that_ends_is_not_called_so) {
    // From far inside of a limit cycle, through nine decades.
    for (const double start : {1e-3, 1e-9}) {
        const PointResult result = settle(oscillator("0.5*(1 - X^2)*V - X", SectionOf::states, start, 0));
        EXPECT_EQ(result.label, Label::periodic) << start;
    }
    // Still growing when the cycles are used up.
    EXPECT_EQ(settle(oscillator("0.002*(1 - X^2)*V - X", SectionOf::states, 1e-6, 0)).label, Label::unsettled);
    // Resonance without damping grows with time, and may end anywhere for all that is known: neither chaos nor a torus.
    EXPECT_EQ(settle(oscillator("-X + cos(theta)", SectionOf::clock, 0, 0)).label, Label::unsettled);
}

} // namespace
} // namespace graze
