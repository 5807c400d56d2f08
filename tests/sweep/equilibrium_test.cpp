#include "settle.hpp"

#include "graze/model/catalogue.hpp"

#include <gtest/gtest.h>

#include <random>

namespace graze::equilibrium_test {

TEST(Equilibrium, MotionsThatComeToRestAreLabelledInAnyUnits) {
    // Damping ratios of foci, of the critical case and of nodes; the exponent follows in closed form.
    std::mt19937 random(1);
    std::uniform_real_distribution<double> uniform(0, 1);
    for (int k = 0; k < 60; ++k) {
        const double zeta = k % 10 == 0 ? 1 : std::pow(10, 4.3 * uniform(random) - 4), rest = k % 3 == 0 ? 0 : 3;
        const double length = std::pow(10, std::floor(18 * uniform(random)) - 12);
        const double time = std::pow(10, std::floor(12 * uniform(random)) - 9);
        const auto section = k % 2 == 0 ? SectionOf::clock : SectionOf::states;
        const Model model = oscillator(fmt::format("{:.17g} - 2*{:.17g}*V - X", rest, zeta), section,
                                       2 * uniform(random) - 1, uniform(random), 0.5 + uniform(random), length, time);
        const PointResult result = settle(model);
        ASSERT_EQ(result.label, Label::equilibrium) << k << " " << zeta << " " << length << " " << time;
        const double exponent = zeta <= 1 ? -zeta : -1 / (zeta + std::sqrt(zeta * zeta - 1));
        ASSERT_TRUE(result.lyapunov);
        // A double eigenvalue is known to the square root of the machine epsilon.
        EXPECT_NEAR(*result.lyapunov * time, exponent, zeta == 1 ? 1e-7 : 1e-11) << zeta;
        EXPECT_NEAR(result.state[0] / length, rest, 1e-9);
        EXPECT_EQ(result.samples.size(), 1u);
    }
}

TEST(Equilibrium, SettledVanDerPolOscillatorIsAtRest) {
    for (const auto section : {SectionOf::clock, SectionOf::states})
        for (const double mu : {-0.05, -0.5, -1.5}) {
            const PointResult result = settle(oscillator(fmt::format("{}*(1 - X^2)*V - X", mu), section, 0.5, 0));
            EXPECT_EQ(result.label, Label::equilibrium) << mu;
            EXPECT_NEAR(*result.lyapunov, mu / 2, 1e-11);
        }
}

TEST(Equilibrium, ReturnsMayTakeManySteps) {
    for (const double mu : {8.0, 40.0}) {
        const PointResult result = settle(oscillator(fmt::format("{}*(1 - X^2)*V - X", mu), SectionOf::states, 2, 0));
        EXPECT_EQ(result.label, Label::periodic) << mu;
        EXPECT_EQ(result.period, 1u);
    }
}

TEST(Equilibrium, ALimitCycleAboutAStableEquilibriumIsDistinguished) {
    // r' = -r (1 - r^2) (4 - r^2), rotating: r = 0 and r = 2 are stable, r = 1 separates them. Where the motion crosses
    // x = 0 the field may look linear.
    for (const double start : {0.1, 0.9, 1.1, 1.9, 2.5}) {
        const PointResult result = settle(testing::OneMode{.states = fmt::format("x = {}\ny = 0", start),
                                                           .definitions = "g = '0.05*(1 - x^2 - y^2)*(4 - x^2 - y^2)'",
                                                           .rates = "x = '-g*x - y', y = 'x - g*y'",
                                                           .more = testing::section("s", "x")}
                                              .model());
        EXPECT_EQ(result.label, start < 1 ? Label::equilibrium : Label::periodic) << start;
    }
}

TEST(Equilibrium, DecayEndsWellBeforeUnderflow) {
    for (const auto section : {SectionOf::clock, SectionOf::states}) {
        EXPECT_EQ(settle(first_order("-x", section, 1)).label, Label::equilibrium);
        EXPECT_EQ(settle(first_order("-50*x", section, 1)).label, Label::equilibrium);
        // Decay that is not exponential: the linear part does not show it, but there is no singularity.
        const Label slow = settle(first_order("-x^3", section, 1)).label;
        EXPECT_TRUE(slow == Label::unsettled || slow == Label::equilibrium) << name_of(slow);
    }
    EXPECT_EQ(settle(first_order("x^2", SectionOf::clock, 1)).label, Label::singular);
}

TEST(Equilibrium, SlowDriftCostsNoMoreThanOtherMotions) {
    for (const auto section : {SectionOf::clock, SectionOf::states}) {
        const PointResult result = settle(first_order("-1e-6*x", section, 1));
        EXPECT_EQ(result.label, Label::equilibrium);
        EXPECT_LE(result.periods_run, 600u);
        EXPECT_LE(settle(first_order("1e-6*(x - x^3)", section, 0.1)).periods_run, 600u);
    }
}

TEST(Equilibrium, MotionsOnAnUnstableEquilibriumAreDisplacedInAnyUnits) {
    for (const double length : {1e-9, 1.0, 1e6})
        for (const auto section : {SectionOf::clock, SectionOf::states}) {
            // A ball between two wells.
            const PointResult wells = settle(oscillator("-0.2*V + X - X^3", section, 0, 0, 1, length, 1e-3));
            EXPECT_EQ(wells.label, Label::equilibrium);
            EXPECT_NEAR(std::abs(wells.state[0]) / length, 1, 1e-9);
            EXPECT_EQ(settle(oscillator("0.2*V - X", section, 0, 0, 1, length, 1e-3)).label, Label::unbounded);
        }
    const PointResult cycle = settle(oscillator("0.5*(1 - X^2)*V - X", SectionOf::states, 0, 0));
    EXPECT_EQ(cycle.label, Label::periodic);
    EXPECT_EQ(cycle.period, 1u);
}

TEST(Equilibrium, MotionsThatMustNotBeDisplacedAreNotLabelledChaotic) {
    AttractorOptions options;
    options.disturbance = 0;
    for (const auto section : {SectionOf::clock, SectionOf::states}) {
        const PointResult result = settle(oscillator("-0.2*V + X - X^3", section, 0, 0), options);
        EXPECT_EQ(result.label, Label::unsettled);
        EXPECT_NE(result.outcome.detail.find("unstable"), std::string::npos);
        EXPECT_EQ(result.state[0], 0);
    }
    const PointResult map = settle(iterated("4*z*(1 - z)", 0.75), options);
    EXPECT_EQ(map.label, Label::unsettled);
    options.disturbance = 1e-6;
    EXPECT_EQ(settle(iterated("4*z*(1 - z)", 0.75), options).label, Label::chaotic);
}

TEST(Equilibrium, DrivenParametersAreJudgedByMultipliers) {
    // Mathieu's equation at rest: stable outside the tongue at twice the natural frequency, unstable inside.
    const auto mathieu = [](double Omega, double x) {
        return oscillator("-0.02*V - (1 + 0.3*cos(theta))*X - X^3", SectionOf::clock, x, 0, Omega);
    };
    EXPECT_EQ(settle(mathieu(1.3, 0.01)).label, Label::equilibrium);
    const PointResult within = settle(mathieu(2, 0));
    EXPECT_NE(within.label, Label::equilibrium);
    EXPECT_NE(within.label, Label::chaotic);
    EXPECT_GT(std::abs(within.state[0]), 0.01);
}

/// A body stuck to a table that a clock moves up and down.
TEST(Equilibrium, ABodyOnAMovingTableIsNotAtRest) {
    for (const double amplitude : {1e-9, 1e-2, 1e3}) {
        const PointResult result =
            settle(testing::OneMode{.states = fmt::format("x = 0\nv = {:.17g}", amplitude),
                                    .rates = fmt::format("x = 'v', v = '-{:.17g}*sin(theta)'", amplitude),
                                    .clock = "1"}
                       .model());
        EXPECT_NE(result.label, Label::equilibrium) << amplitude;
    }
}

TEST(Equilibrium, CarriedStatesKeepTheirSigns) {
    // Above mu = 0 x grows, below it decays, and never becomes negative: from 0 - the pulses leave it there - too.
    const auto sweep = [](double mu, double x) {
        return settle(testing::OneMode{.states = fmt::format("x = {{ initial = {} }}\ny = 1", x),
                                       .rates = fmt::format("x = 'x*({} + y - 1 - x)', y = '1 - y'", mu),
                                       .clock = "0.2",
                                       .period = "1",
                                       .stops = {{"tick", "0.5 - theta", "y = 'y'", "", "free", "section"}}}
                          .model());
    };
    double x = 0.5;
    for (const double mu : {-1.0, -0.5, -2.0, 0.5, -1.0, 1.0}) {
        const PointResult result = sweep(mu, x);
        x = result.state[0];
        EXPECT_GT(x, 0) << mu;
        EXPECT_NEAR(x, std::max(mu, 0.0), 1e-9) << mu;
    }
}

TEST(Equilibrium, StatesMovedOnlyByRoundingHaveNoScaleOfTheirOwn) {
    // At the bottom of a well of Duffing's oscillator, in units in which the rounded force is not zero: there are no
    // returns.
    for (const double length : {1e-9, 1e-6, 1e-3, 1.0, 7.0, 1e6})
        for (const auto section : {SectionOf::clock, SectionOf::states}) {
            const PointResult result = settle(oscillator("X - X^3 - 0.2*V", section, 1, 0, 1.3, length));
            EXPECT_EQ(result.label, Label::equilibrium) << length << name_of(result.label);
            ASSERT_TRUE(result.lyapunov) << length;
            EXPECT_NEAR(*result.lyapunov, -0.1, 1e-9) << length;
        }
}

TEST(Equilibrium, MotionsAtACentreAreNotDisplaced) {
    // A centre neither attracts nor repels.
    for (const double length : {1e-9, 1.0, 1e6}) {
        const PointResult result = settle(oscillator("X - X^3", SectionOf::clock, 1, 0, 1.3, length));
        EXPECT_EQ(result.label, Label::unsettled) << length << name_of(result.label);
        EXPECT_NEAR(result.state[0], length, 1e-12 * length);
    }
}

TEST(Equilibrium, SweepsLeaveAnEquilibriumThatLosesItsStability) {
    // x' = x (k - x): the attractor is zero for k < 0 and k for k > 0, however long the sweep has been below.
    for (const double length : {1e-9, 1.0, 1e6}) {
        std::vector<double> state{0.5 * length, 0};
        for (int k = -20; k <= 20; ++k) {
            if (k == 0)
                continue; // approaches more slowly than can be detected
            const double parameter = 0.05 * k;
            const PointResult result = settle(
                first_order(fmt::format("x*({:.17g} - x/{:.17g})", parameter, length), SectionOf::clock, 0), {}, state);
            EXPECT_EQ(result.label, Label::equilibrium) << parameter << name_of(result.label);
            EXPECT_NEAR(result.state[0], std::max(parameter, 0.0) * length, 1e-9 * length) << parameter;
            EXPECT_GT(result.state[0], 1e-40 * length) << "tiny, but not smaller with every point";
            state = result.state;
        }
    }
}

/// A mass pushed to one side of its range of rest slips back by less with every period of the force, which friction
/// exceeds: the remaining distance d becomes d - C d^2, and in the limit nothing moves.
TEST(Equilibrium, SlipsThatVanishInTheLimitAreNoOrbit) {
    Model model = load_model("dry-friction-oscillator");
    for (const double excess : {0.0, 0.05, 0.3})
        for (const double omega : {0.8, 1.0, 2.0}) {
            model.set_parameter("omega", omega);
            model.set_parameter("friction_static", 1 + excess);
            model.set_parameter("friction_dynamic", 1 + excess);
            const PointResult result = settle(model, {}, {excess + 0.1, 0, 0});
            EXPECT_EQ(result.label, Label::equilibrium) << excess << " " << omega << name_of(result.label);
            EXPECT_NEAR(result.state[0], excess, 1e-8) << omega;
            EXPECT_EQ(result.signature, "");
            EXPECT_TRUE(result.multipliers.empty());
        }
    // With a slightly stronger force there is an orbit of small slips to either side, and it is found.
    model.set_parameter("omega", 2);
    model.set_parameter("friction_static", 0.99);
    model.set_parameter("friction_dynamic", 0.99);
    const PointResult orbit = settle(model, {}, {0.1, 0, 0});
    EXPECT_EQ(orbit.label, Label::periodic) << name_of(orbit.label);
    EXPECT_NE(orbit.signature, "");
}

} // namespace graze::equilibrium_test
