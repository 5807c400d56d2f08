#include "graze/flow/step_size.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

namespace graze::step_size_test {

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double nan = std::numeric_limits<double>::quiet_NaN();

using Coefficients = std::vector<double>;

double step(const std::vector<Coefficients>& states, double tolerance, double previous = 0) {
    std::vector<Series> series;
    for (const Coefficients& coefficients : states)
        series.push_back({coefficients.data()});
    return StepSize(static_cast<int>(states[0].size()) - 1, tolerance)(series, previous);
}

Coefficients geometric(int order, double factor, double ratio) {
    Coefficients c;
    for (int k = 0; k <= order; ++k)
        c.push_back(factor * std::pow(ratio, k));
    return c;
}

Coefficients exponential(int order, double rate) {
    Coefficients c{1};
    for (int k = 1; k <= order; ++k)
        c.push_back(c.back() * rate / k);
    return c;
}

TEST(StepSize, OrderGrowsWithTheNumberOfDigits) {
    EXPECT_EQ(order_for_tolerance(1e-8), 12);
    EXPECT_EQ(order_for_tolerance(1e-12), 17);
    EXPECT_EQ(order_for_tolerance(1e-16), 20);
    EXPECT_EQ(order_for_tolerance(1e-300), order_for_tolerance(1e-16));
    EXPECT_GE(order_for_tolerance(1), 4);
    for (double tolerance = 1e-2; tolerance > 1e-16; tolerance /= 3)
        EXPECT_LE(order_for_tolerance(tolerance), order_for_tolerance(tolerance / 3));
}

TEST(StepSize, TruncationErrorIsBelowTheTolerance) {
    for (const double tolerance : {1e-4, 1e-8, 1e-12, 1e-15}) {
        const int order = order_for_tolerance(tolerance);
        const double rate = 3;
        const double h = step({exponential(order, rate)}, tolerance, 0.1);
        double term = 1;
        for (int k = 1; k <= order + 1; ++k)
            term *= rate * h / k;
        EXPECT_LT(term, tolerance);
        EXPECT_GT(term, 1e-3 * tolerance); // but not far below
    }
}

TEST(StepSize, StaysWithinTheRadiusOfConvergence) {
    // 1/(1 - s/2): radius 2.
    const int order = 16;
    const Coefficients c = geometric(order, 1, 0.5);
    const double h = step({c}, 1e-13);
    EXPECT_LT(h, 0.5);
    EXPECT_GT(h, 0.1);
    const std::vector<Series> series{{c.data()}};
    EXPECT_NEAR(StepSize(order, 1e-13).radius(series), 2, 1e-12);
}

TEST(StepSize, DoesNotDependOnUnits) {
    const int order = 15;
    for (const double unit : {1e-200, 1e-9, 1.0, 1e9, 1e200}) {
        Coefficients scaled = exponential(order, 2);
        for (double& c : scaled)
            c *= unit;
        EXPECT_NEAR(step({scaled, exponential(order, 0.5)}, 1e-12),
                    step({exponential(order, 2), exponential(order, 0.5)}, 1e-12), 1e-12);
    }
    // The step scales with the unit of time.
    for (const double unit : {1e-6, 1e3})
        EXPECT_NEAR(step({exponential(order, 2 / unit)}, 1e-12) / unit, step({exponential(order, 2)}, 1e-12), 1e-10);
}

TEST(StepSize, FastestStateDecides) {
    const int order = 15;
    EXPECT_DOUBLE_EQ(step({exponential(order, 1), exponential(order, 50)}, 1e-12, 0.01),
                     step({exponential(order, 50)}, 1e-12, 0.01));
}

TEST(StepSize, StatesThatPassZeroDoNotLimitTheStep) {
    // sin s at s = 0, where its value is zero.
    const int order = 15;
    Coefficients c(order + 1);
    double factorial = 1;
    for (int k = 1; k <= order; ++k) {
        factorial *= k;
        c[static_cast<std::size_t>(k)] = k % 2 == 0 ? 0 : (k % 4 == 1 ? 1 : -1) / factorial;
    }
    for (const double previous : {0.0, 0.3, 1.0}) {
        EXPECT_GT(step({c}, 1e-12, previous), 0.2);
        EXPECT_LT(step({c}, 1e-12, previous), 3);
    }
}

TEST(StepSize, PolynomialsAndConstantsAreExact) {
    const int order = 12;
    Coefficients constant(order + 1), line(order + 1), parabola(order + 1);
    constant[0] = 5;
    line[0] = 1, line[1] = 4;
    parabola[0] = 1, parabola[2] = -4;
    EXPECT_EQ(step({constant}, 1e-12), infinity);
    EXPECT_EQ(step({Coefficients(order + 1)}, 1e-12), infinity);
    EXPECT_TRUE(std::isfinite(step({line}, 1e-12)));
    EXPECT_GT(step({line}, 1e-12), 0.2);
    EXPECT_GT(step({parabola}, 1e-12), 0.4);
    // They have no effect beside a state that is not a polynomial.
    EXPECT_DOUBLE_EQ(step({exponential(order, 3), parabola}, 1e-12, 0.1), step({exponential(order, 3)}, 1e-12, 0.1));
}

TEST(StepSize, NonFiniteCoefficientsGiveNaN) {
    const int order = 15;
    for (const double bad : {nan, infinity, -infinity})
        for (const int k : {0, 1, 2, order - 1, order}) {
            Coefficients c = exponential(order, 1);
            c[static_cast<std::size_t>(k)] = bad;
            EXPECT_TRUE(std::isnan(step({c}, 1e-12))) << k;
            EXPECT_TRUE(std::isnan(step({exponential(order, 1), c}, 1e-12, 0.1))) << k;
            Coefficients short_one(order + 1); // log of a negative constant: it has a single coefficient
            short_one[static_cast<std::size_t>(k)] = bad;
            EXPECT_TRUE(std::isnan(step({exponential(order, 1), short_one}, 1e-12, 0.1))) << k;
        }
}

TEST(StepSize, GrowingTermsShortenTheStep) {
    // exp(-100 s^2) about s = -1, whose Taylor coefficients grow long before they fall.
    const int order = 15;
    Coefficients c(order + 1);
    c[0] = std::exp(-100.0);
    c[1] = 200 * c[0];
    for (std::size_t k = 1; k < static_cast<std::size_t>(order); ++k)
        c[k + 1] = 200 * (c[k] - c[k - 1]) / static_cast<double>(k + 1);
    Coefficients time(order + 1); // a second state of ordinary size, beside which the function is small
    time[0] = -1, time[1] = 1;
    const double h = step({c, time}, 1e-12, 0.1);
    EXPECT_GT(h, 0);
    EXPECT_LT(h, 0.3);
}

/// The series of x'' = x^n from almost zero has n terms of round-off between those that count.
TEST(StepSize, GapsThatAreRoundOffDoNotLimitTheStep) {
    for (const int gap : {2, 3, 4, 5, 6, 7})
        for (const int order : {12, 17, 20}) {
            Coefficients exact = geometric(order, 1, 1), round_off = exact;
            for (int k = 0; k <= order; ++k)
                if (k % gap != 0) {
                    exact[static_cast<std::size_t>(k)] = 0;
                    round_off[static_cast<std::size_t>(k)] *= 1e-18;
                }
            const double wanted = step({exact}, 1e-12, 0.1);
            EXPECT_GE(step({round_off}, 1e-12, 0.1), 0.5 * wanted) << gap << ' ' << order;
        }
}

} // namespace graze::step_size_test
