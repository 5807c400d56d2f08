#include "settle.hpp"

#include "graze/model/catalogue.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>

namespace graze::attractor_plane_test {

constexpr double golden = 1.618033988749895;

/// A model with these states and rates, and a clock of rate q whose phase zero is the section.
Model beside_a_clock(const std::string& states, const std::string& rates, double q = 1) {
    return testing::OneMode{.states = states, .rates = rates, .clock = fmt::format("{:.17g}", q)}.model();
}

TEST(AttractorPlane, ASecondClockThatDoesNotReturnHasNoPeriod) {
    // x is the sum of two sines, in closed form.
    for (const double w : {0.98, 1.02, 1.001, 1.0001, 1.00001, 2.02}) {
        const PointResult result =
            settle(beside_a_clock("x = 0\nph = { initial = 0, period = \"2*pi\" }",
                                  fmt::format("x = \"-0.1*x + cos(theta) + sin(ph)\", ph = {:.17g}", w)));
        EXPECT_NE(result.label, Label::periodic) << w;
        EXPECT_GE(result.state[1], 0) << w;
        EXPECT_LT(result.state[1], 2 * std::numbers::pi) << w;
    }
    for (const auto& [w, period] : {std::pair{1.0, 1}, std::pair{2.0, 1}, std::pair{1.5, 2}, std::pair{0.25, 4}}) {
        const PointResult result =
            settle(beside_a_clock("x = 0\nph = { initial = 0, period = \"2*pi\" }",
                                  fmt::format("x = \"-0.1*x + cos(theta) + sin(ph)\", ph = {:.17g}", w)));
        EXPECT_EQ(result.label, Label::periodic) << w;
        EXPECT_EQ(result.period, static_cast<std::size_t>(period)) << w;
        EXPECT_NEAR(std::abs(result.multipliers.front()), std::exp(-0.1 * 2 * std::numbers::pi * period), 1e-9) << w;
    }
}

TEST(AttractorPlane, AGrowingLinearModeIsNotChaotic) {
    for (const double q : {1.0, 3.0, 7.0, 20.0, 100.0, 1000.0}) {
        for (const auto& [states, rates] :
             {std::pair{"x = 1", "x = \"0.3*x\""}, std::pair{"x = 1\nv = 0", "x = \"v\", v = \"0.2*v - x\""},
              std::pair{"x = 0\nv = 1", "x = \"0.3*x\", v = \"-v\""},
              std::pair{"x = 1\nv = 1", "x = \"0.3*x\", v = \"0.3*v\""},
              std::pair{"x = 1\nv = 1", "x = \"0.3*x + 0.1*v\", v = \"0.2*v\""},
              std::pair{"x = 0\nv = 0", "x = \"1 + 0.05*x\", v = \"-v + sin(theta)\""}}) {
            const PointResult result = settle(beside_a_clock(states, rates, q));
            EXPECT_TRUE(result.label == Label::unbounded || result.label == Label::unsettled)
                << rates << " " << q << " " << name_of(result.label);
        }
        EXPECT_EQ(settle(beside_a_clock("x = 1", "x = \"0.3*x\"", q)).label, Label::unbounded) << q;
    }
}

TEST(AttractorPlane, ATorusOnAnUnstablePlaneIsLeft) {
    // x is a sum of two sines; y converges to 1 from any positive value.
    for (const double y : {0.0, 1e-30, 1e-9}) {
        const PointResult result = settle(
            beside_a_clock(fmt::format("x = 0\ny = {:.17g}\nph = {{ initial = 0, period = \"2*pi\" }}", y),
                           fmt::format("x = \"-x + cos(theta) + sin(ph)\", y = \"y - y^3\", ph = {:.17g}", golden)));
        // The search may end before averages are even enough, but not with chaos.
        EXPECT_TRUE(result.label == Label::quasi_periodic || result.label == Label::unsettled)
            << y << " " << name_of(result.label);
        EXPECT_NEAR(result.state[1], 1, 1e-9) << y;
    }
    // Without a disturbance the behaviour is unknown.
    AttractorOptions still;
    still.disturbance = 0;
    const PointResult result =
        settle(beside_a_clock("x = 0\ny = 0\nph = { initial = 0, period = \"2*pi\" }",
                              fmt::format("x = \"-x + cos(theta) + sin(ph)\", y = \"y - y^3\", ph = {:.17g}", golden)),
               still);
    EXPECT_EQ(result.label, Label::unsettled);
    EXPECT_NE(result.outcome.detail.find("plane"), std::string::npos);
}

TEST(AttractorPlane, ChaosOnAnUnstablePlaneIsLeft) {
    // Two coupled logistic maps in synchrony, which neighbours leave: the transverse exponent is 0.35 + log(1 - 2c) >
    // 0.
    const auto coupled = [](double c) {
        return testing::ticking("x = 0.3\ny = 0.3", "x = 0, y = 0",
                                fmt::format("x = \"(1-{0})*3.7*x*(1-x) + {0}*3.7*y*(1-y)\"\n"
                                            "y = \"(1-{0})*3.7*y*(1-y) + {0}*3.7*x*(1-x)\"",
                                            c));
    };
    const PointResult apart = settle(coupled(0.1));
    EXPECT_EQ(apart.label, Label::periodic);
    EXPECT_EQ(apart.period, 4u);
    // The transverse exponent is negative: neighbours synchronise again, and are chaotic.
    const PointResult together = settle(coupled(0.3));
    EXPECT_EQ(together.label, Label::chaotic);
    EXPECT_NEAR(together.state[0], together.state[1], 1e-9);
    EXPECT_NEAR(*together.lyapunov, 0.35, 0.03);
    // y = 0 is unstable; the motion goes to y^2 = 0.5, where x has period 2.
    for (const double y : {0.0, 1e-118}) {
        // As in a sweep that carries on a state that has decayed from 0.1.
        const PointResult left = settle(testing::ticking("x = 0.3\ny = 0.1", "x = 0, y = 0",
                                                         "x = \"(3.9 - 1.6*y^2)*x*(1-x)\"\ny = \"y*(1.5 - y^2)\""),
                                        {}, {0.3, y, 0});
        // From so close to the plane it may take longer than the search.
        EXPECT_NE(left.label, Label::chaotic) << y;
        if (y == 0) {
            EXPECT_EQ(left.label, Label::periodic);
            EXPECT_EQ(left.period, 2u);
        }
    }
}

/// A focus with one growth rate for x > 0 and another for x < 0: all motions look alike on all scales.
Model two_zones(double left) {
    return testing::TwoModes{.parameters = fmt::format("a = {}", left),
                             .states = "x = 1\nv = 0",
                             .first = {"R", "x = 'v', v = '0.2*v - 1.01*x'", "toL", "x"},
                             .second = {"L", "x = 'v', v = '2*a*v - (a^2 + 4)*x'", "toR", "-x"},
                             .more = testing::section("a", "v", "falling")}
        .model();
}

TEST(AttractorPlane, AMotionThatShrinksIntoACornerIsNotLabelledPeriodic) {
    for (const double left : {-0.6, -0.3, -0.21}) { // log(amplitude) changes by pi (0.1 + left/2) in each turn
        const PointResult result = settle(two_zones(left));
        EXPECT_TRUE(result.label == Label::equilibrium || result.label == Label::unsettled)
            << left << " " << name_of(result.label);
        EXPECT_NEAR(result.state[0], 0, left == -0.6 ? 1e-9 : 1) << left;
    }
    EXPECT_EQ(settle(two_zones(-0.6)).label, Label::equilibrium);
}

TEST(AttractorPlane, ABallAtRestOnAMovingTableIsPeriodic) {
    Model model = testing::shipped_with("bouncing-ball", {{"f", 3}});
    const AttractorOptions options{.section = "phase0"};
    for (const double a : {0.001, 0.005, 0.02}) { // the table's acceleration is below g: a omega^2 < 7.2
        model.set_parameter("a", a);
        const PointResult result = settle(model, options);
        ASSERT_EQ(result.label, Label::periodic) << a << " " << name_of(result.label);
        EXPECT_EQ(result.period, 1u);
        EXPECT_NEAR(result.duration, 1.0 / 3, 1e-12);
        EXPECT_EQ(result.signature, "");
        ASSERT_FALSE(result.multipliers.empty());
        EXPECT_EQ(result.multipliers.front(), 1.0); // multiplier of the height, which the table determines
        EXPECT_NEAR(result.state[0], 0, 1e-9 * a);
    }
}

TEST(AttractorPlane, MotionsThatSlideBackAndForthAnywhereArePeriodic) {
    // x'' = A cos(t) - 2 zeta x': the multipliers are 1, for the centre of the oscillation, and exp(-2 zeta T).
    for (const double amplitude : {0.1, 0.2, 0.3, 0.4, 0.5, 0.65, 0.8, 1.0}) {
        const double Omega = 2.2, period = 2 * std::acos(-1.0) / Omega, zeta = 0.02;
        const Model model =
            oscillator(fmt::format("{}*cos(theta) - 2*{}*V", amplitude, zeta), SectionOf::clock, 0, 0.1, Omega);
        const PointResult result = settle(model);
        EXPECT_EQ(result.label, Label::periodic) << amplitude << name_of(result.label);
        ASSERT_EQ(result.multipliers.size(), 2U);
        EXPECT_NEAR(std::abs(result.multipliers[0]), 1, 1e-12);
        EXPECT_NEAR(std::abs(result.multipliers[1]), std::exp(-2 * zeta * period), 1e-9);
    }
}

} // namespace graze::attractor_plane_test
