#include "settle.hpp"

#include <gtest/gtest.h>

#include <random>

namespace graze::growth_watch_test {

TEST(GrowthWatch, LinearOscillatorsThatGainEnergyAreUnboundedInAnyUnits) {
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

TEST(GrowthWatch, GrowthThatEndsIsNotLabelledUnbounded) {
    // From far inside of a limit cycle, through nine decades.
    for (const double start : {1e-3, 1e-9}) {
        const PointResult result = settle(oscillator("0.5*(1 - X^2)*V - X", SectionOf::states, start, 0));
        EXPECT_EQ(result.label, Label::periodic) << start;
    }
    // Still growing when the cycles are used up.
    EXPECT_EQ(settle(oscillator("0.002*(1 - X^2)*V - X", SectionOf::states, 1e-6, 0)).label, Label::unsettled);
    // Resonance without damping grows linearly in time and may end anywhere: neither chaos nor a torus.
    EXPECT_EQ(settle(oscillator("-X + cos(theta)", SectionOf::clock, 0, 0)).label, Label::unsettled);
}

/// An oscillator that grows at the rate a/2 about zero and is damped where |x| > 1.
Model damped_outside(double a, double x, double length = 1) {
    return testing::model_from(
        fmt::format(R"toml(
[states]
x = {{ initial = {1:.17g} }}
v = 0
[events]
up = {{ function = "{2:.17g} - x", kind = "section" }}
down = {{ function = "x + {2:.17g}", kind = "section" }}
in_right = {{ function = "x - {2:.17g}", kind = "section" }}
in_left = {{ function = "-{2:.17g} - x", kind = "section" }}
[modes.inner]
rates = {{ x = "v", v = "{0:.17g}*v - x" }}
watch = ["up", "down"]
[modes.right]
rates = {{ x = "v", v = "-0.5*v - x" }}
watch = ["in_right"]
[modes.left]
rates = {{ x = "v", v = "-0.5*v - x" }}
watch = ["in_left"]
[initial]
mode = "inner"
)toml",
                    a, x * length, length) +
        testing::transition("inner", "up", "right") + testing::transition("inner", "down", "left") +
        testing::transition("right", "in_right", "inner") + testing::transition("left", "in_left", "inner") +
        testing::section("top", "v", "falling"));
}

TEST(GrowthWatch, GrowthThatALaterEventEndsIsNotLabelledUnbounded) {
    for (const double length : {1e-9, 1.0, 1e6}) {
        // The event is later by any number of decades.
        for (const double start : {1e-2, 1e-10, 1e-30})
            EXPECT_EQ(settle(damped_outside(0.3, start, length)).label, Label::periodic) << start << " " << length;
        EXPECT_EQ(settle(damped_outside(0.001, 0.01, length)).label, Label::unsettled) << length;
    }
}

TEST(GrowthWatch, EventsAheadMayBeAnyNumberOfDecadesAway) {
    for (const double length : {1e-9, 1.0, 1e6}) {
        // An event after 43 decades, and a quadratic term after 300.
        EXPECT_EQ(settle(damped_outside(0.3, 1e-43, length)).label, Label::periodic) << length;
        const PointResult result =
            settle(first_order(fmt::format("x*(1 - x/{:.17g})", length), SectionOf::clock, 1e-300));
        EXPECT_EQ(result.label, Label::equilibrium) << name_of(result.label);
        EXPECT_NEAR(result.state[0], length, 1e-9 * length);
    }
}

} // namespace graze::growth_watch_test
