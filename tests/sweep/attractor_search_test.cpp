#include "settle.hpp"

#include "graze/model/catalogue.hpp"
#include "graze/symbolic/parser.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace graze::attractor_search_test {

using std::numbers::pi;

/// z -> r z (1 - z) once in every unit of time.
Model logistic(double r, double start = 0.3) {
    return iterated(fmt::format("{:.17g}*z*(1 - z)", r), start);
}

TEST(AttractorSearch, LogisticMapHasItsKnownPeriods) {
    // Period 2 between 3 and 1 + sqrt 6, then 4 up to 3.544090, 8 up to 3.564407; the window of period 3 begins at 1 +
    // sqrt 8.
    struct Case {
        double r;
        std::size_t period;
    };
    const AttractorOptions options{.section = "half", .cycles = 2000, .largest_period = 8};
    for (const Case& known : {Case{2.5, 1},
                              {2.99, 1},
                              {3.01, 2},
                              {3.2, 2},
                              {3.4489, 2},
                              {3.4505, 4},
                              {3.5, 4},
                              {3.55, 8},
                              {3.83, 3},
                              {3.845, 6}}) {
        const PointResult result = settle(logistic(known.r), options);
        EXPECT_EQ(result.label, Label::periodic) << known.r;
        EXPECT_EQ(result.period, known.period) << known.r;
        ASSERT_FALSE(result.multipliers.empty());
        if (known.period == 1) {
            EXPECT_NEAR(result.multipliers[0].real(), 2 - known.r, 1e-9);
            EXPECT_NEAR(result.state[0], 1 - 1 / known.r, 1e-12);
        }
        if (known.period == 2) {
            EXPECT_NEAR(result.multipliers[0].real(), 4 + 2 * known.r - known.r * known.r, 1e-8);
        }
        EXPECT_EQ(result.samples.size(), known.period);
        EXPECT_NEAR(result.duration, static_cast<double>(known.period), 1e-12);
    }
}

TEST(AttractorSearch, LogisticMapIsChaoticWithExponentLog2) {
    const AttractorOptions options{.section = "half", .cycles = 4000, .lyapunov_cycles = 3900};
    const PointResult result = settle(logistic(4, 0.1234), options);
    EXPECT_EQ(result.label, Label::chaotic);
    ASSERT_TRUE(result.lyapunov && result.lyapunov_error);
    // The standard deviation of the mean of ln|4 - 8 z| over 3900 nearly independent values.
    EXPECT_NEAR(*result.lyapunov, std::log(2.0), 0.03);
    EXPECT_NEAR(*result.lyapunov, std::log(2.0), 6 * *result.lyapunov_error);
    EXPECT_EQ(result.samples.size(), options.keep);
}

TEST(AttractorSearch, SlowTransientsNextToAFlipAreNotLabelledDoubled) {
    // At 1e-4 before the flip, distances shrink by 1e-4 in each step: distances of samples suggest period 2 forever.
    const AttractorOptions options{.section = "half"};
    for (const double r : {2.9999, 2.99999}) {
        const PointResult result = settle(logistic(r), options);
        EXPECT_NE(result.period, 2u) << r;
        EXPECT_TRUE(result.label == Label::unsettled || result.period == 1) << r;
    }
}

TEST(AttractorSearch, AMotionOnAnUnstableOrbitLeavesIt) {
    const AttractorOptions options{.section = "half"};
    // The motion starts exactly on the unstable fixed point; the cycle of period 2 is the attractor.
    const PointResult result = settle(logistic(3.2, 1 - 1 / 3.2), options);
    EXPECT_EQ(result.label, Label::periodic);
    EXPECT_EQ(result.period, 2u);
}

TEST(AttractorSearch, BouncingBallDoublesItsPeriodAtTheClosedFormThreshold) {
    // One impact per period of the table: flight time, impact law and stability give the amplitude of the flip.
    Model model = load_model("bouncing-ball");
    const double e = 0.5, g = 9.81, omega = 2 * pi * 10;
    model.set_parameter("e", e);
    const double cosine = pi * (1 - e) / (1 + e), sine = 2 * (1 + e * e) / ((1 + e) * (1 + e));
    const double flip = g / (omega * omega) * std::hypot(cosine, sine);
    for (const double factor : {0.9, 0.999, 1.001, 1.01}) {
        const double a = factor * flip;
        model.set_parameter("a", a);
        // Start close to the orbit: just after the impact, moving upwards for half a period.
        const double phase = std::acos(g / (omega * omega) * cosine / a);
        const AttractorOptions options{.section = "phase0", .cycles = 4000};
        std::vector<double> state{a * std::sin(phase) + 1e-6, g * pi / omega, phase};
        const PointResult result = settle(model, options, state);
        ASSERT_EQ(result.label, Label::periodic) << factor;
        EXPECT_EQ(result.period, factor < 1 ? 1u : 2u) << factor;
        EXPECT_EQ(result.signature, factor < 1 ? "impact" : "impact^2");
        if (factor < 1) {
            const double trace = 1 + e * e - (1 + e) * (1 + e) * a * omega * omega * std::sin(phase) / g;
            ASSERT_EQ(result.multipliers.size(), 2u);
            EXPECT_NEAR((result.multipliers[0] + result.multipliers[1]).real(), trace, 1e-8);
            EXPECT_NEAR((result.multipliers[0] * result.multipliers[1]).real(), e * e, 1e-9);
        }
    }
}

TEST(AttractorSearch, OneOrbitOfManyReturnsHasOneSignature) {
    // Which of the 24 returns these motions settle with depends on where they begin.
    Model model = load_model("impact-oscillator");
    model.set_parameter("omega", 2.75);
    for (const double x : {-1.18, -0.67, 0.04}) {
        std::vector<double> state = model.initial_state();
        state[0] = x;
        const PointResult result = settle(model, {.section = "phase0"}, state);
        ASSERT_EQ(result.label, Label::periodic) << x;
        EXPECT_EQ(result.period, 24U) << x;
        EXPECT_NEAR(result.duration, 24 * 2 * pi / 2.75, 1e-9) << x;
        EXPECT_EQ(result.signature, "impact* release") << x;
    }
}

TEST(AttractorSearch, LinearImpactOscillatorHasTheExponentOfItsClosedForm) {
    // Between impacts areas shrink by exp(-2 zeta t), at each impact by e^2. With one impact per period T of the force
    // the product of the multipliers is e^2 exp(-2 zeta T); if they are complex, each exponent is half its logarithm.
    Model model = load_model("impact-oscillator");
    const AttractorOptions options{.section = "phase0", .cycles = 3000};
    const double zeta = 0.1, e = 0.8;
    std::size_t complex = 0;
    for (const double omega : {1.8, 2.0, 2.2, 2.5, 2.9}) {
        model.set_parameter("zeta", zeta);
        model.set_parameter("e", e);
        model.set_parameter("omega", omega);
        model.set_parameter("sigma", 0);
        const PointResult result = settle(model, options);
        const auto impacts = [&]() -> int {
            if (result.signature == "impact")
                return 1;
            return result.signature == "impact^2" ? 2 : 0;
        }();
        if (result.label != Label::periodic || impacts == 0)
            continue;
        ASSERT_EQ(result.multipliers.size(), 2u) << omega;
        const double product = std::pow(e, 2 * impacts) * std::exp(-2 * zeta * result.duration);
        EXPECT_NEAR((result.multipliers[0] * result.multipliers[1]).real(), product, 1e-9) << omega;
        if (result.multipliers[0].imag() != 0) {
            ++complex;
            EXPECT_NEAR(*result.lyapunov, 0.5 * std::log(product) / result.duration, 1e-9) << omega;
        }
    }
    EXPECT_GE(complex, 2u);
}

TEST(AttractorSearch, LinearOscillatorWithoutContactHasTheExponentOfItsDamping) {
    Model model = testing::shipped_with("impact-oscillator", {{"zeta", 0.05}, {"sigma", 50}});
    model.set_initial("x", 0.2);
    const AttractorOptions options{.section = "phase0"};
    const PointResult result = settle(model, options);
    ASSERT_EQ(result.label, Label::periodic);
    EXPECT_EQ(result.signature, "");
    ASSERT_TRUE(result.lyapunov);
    EXPECT_NEAR(*result.lyapunov, -0.05, 1e-12);
}

TEST(AttractorSearch, ExponentAlongAMotionEqualsThatOfTheMultipliers) {
    // For the stable orbit of period two; with largest_period 1 the search does not find it.
    const AttractorOptions options{.section = "half", .cycles = 1200, .largest_period = 1, .lyapunov_cycles = 1000};
    const double r = 3.2;
    const PointResult averaged = settle(logistic(r), options);
    EXPECT_NE(averaged.label, Label::chaotic);
    ASSERT_TRUE(averaged.lyapunov);
    EXPECT_NEAR(*averaged.lyapunov, 0.5 * std::log(std::abs(4 + 2 * r - r * r)), 1e-3);
}

TEST(AttractorSearch, TwoIncommensurateFrequenciesAreQuasiPeriodic) {
    const Model model =
        testing::OneMode{.states = "x = 1\nv = 0", .rates = "x = 'v', v = '-x'", .clock = "(sqrt(5) + 1)/2"}.model();
    const PointResult result = settle(model);
    EXPECT_EQ(result.label, Label::quasi_periodic);
    ASSERT_TRUE(result.lyapunov);
    EXPECT_NEAR(*result.lyapunov, 0, 1e-3);
}

TEST(AttractorSearch, TestbedHasThePublishedAttractors) {
    Model model = testing::shipped_with("electromagnetic-testbed", {{"V0", 4.833}});
    AttractorOptions options{.section = "phase0"};
    // From rest the motion reaches the stop; in small steps of the voltage the orbit without impacts is followed.
    PointResult still;
    std::vector<double> state;
    for (int millivolts = 4500; millivolts <= 4832; millivolts += millivolts < 4800 ? 20 : 1) {
        model.set_parameter("V0", millivolts / 1000.0);
        still = settle(model, options, state);
        state = still.state;
    }
    EXPECT_EQ(still.label, Label::periodic);
    EXPECT_EQ(still.period, 1u);
    EXPECT_EQ(still.signature, "");
    EXPECT_EQ(still.symmetric, true);
    model.set_parameter("V0", 4.833);
    // Published: the coexisting impacting orbit of period three, in units of the dissertation's chapter 5.
    model.set_initial("I", 0.1);
    options.cycles = 600;
    const PointResult impacting = settle(model, options);
    EXPECT_EQ(impacting.label, Label::periodic);
    ASSERT_EQ(impacting.period, 3u);
    EXPECT_EQ(impacting.symmetric, true);
    ASSERT_GE(impacting.multipliers.size(), 2u);
    EXPECT_NEAR(impacting.multipliers[0].real(), 0.6128, 5e-5);
    EXPECT_NEAR(impacting.multipliers[1].real(), 0.1126, 5e-5);
    EXPECT_NEAR(*impacting.lyapunov, std::log(0.6128) / (3 / 6.25), 2e-4);
}

TEST(AttractorSearch, AResetMakesASingleStateSuperstable) {
    for (const double current : {1.001, 1.5, 20.0}) {
        const PointResult result =
            settle(testing::integrate_and_fire(current, "barrier", testing::section("threshold", "1 - u", "falling")));
        ASSERT_EQ(result.label, Label::periodic) << current;
        EXPECT_EQ(result.period, 1u);
        EXPECT_NEAR(result.duration, std::log(current / (current - 1)), 1e-11);
        ASSERT_EQ(result.multipliers.size(), 1u);
        EXPECT_EQ(std::abs(result.multipliers.front()), 0);
    }
}

TEST(AttractorSearch, AStateMovedOnlyByRoundingDoesNotKeepOthersFromSettling) {
    // The second oscillator is driven by cancelling terms.
    const PointResult result =
        settle(testing::OneMode{.states = "x = 0\nv = 0\nq = 0\nr = 0",
                                .definitions = "F = 'cos(theta)'",
                                .rates = "x = 'v', v = 'F - x*2 - 0.3*v', q = 'r', "
                                         "r = '(0.1*v + 0.2*F) - 0.3*(v/3 + F*(2/3)) - 7.3*q - 0.3*r'",
                                .clock = "1"}
                   .model());
    EXPECT_EQ(result.label, Label::periodic);
    EXPECT_EQ(result.period, 1u);
    EXPECT_NEAR(std::abs(result.multipliers.front()), std::exp(-0.15 * 2 * 3.14159265358979), 1e-9);
}

TEST(AttractorSearch, ZeroMultipliersAreExactlyZero) {
    for (const double current : {1.001, 1.1, 1.5, 3.0, 1e3}) {
        const PointResult result =
            settle(testing::integrate_and_fire(current, "section", testing::section("half", "u - 0.5")));
        EXPECT_EQ(result.label, Label::periodic) << current;
        EXPECT_NEAR(result.duration, std::log(current / (current - 1)), 1e-11 * result.duration);
        ASSERT_EQ(result.multipliers.size(), 1u);
        EXPECT_EQ(result.multipliers.front(), 0.0);
        EXPECT_FALSE(result.lyapunov) << "the exponent would be that of round-off";
    }
}

} // namespace graze::attractor_search_test
