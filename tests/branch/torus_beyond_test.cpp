#include "branch/torus_beyond.hpp"

#include "locked_circle.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace graze::torus_beyond_test {

using namespace graze::testing;

constexpr double pi = std::numbers::pi;

/// Adler's equation: the angle advances by 2 pi/10 p + e sin(5 angle) beside the fifth, and goes around at the square
/// root of the difference of the squares.
TEST(TorusBeyond, TurnsAsAdlersEquation) {
    constexpr double e = 1e-4;
    const LockedCircle locked(e);
    const Resonance resonance{2, 5};
    LockedCurveFinder finder(locked.setting, locked.circle, resonance, 0, {}, 1e-13);
    const LockedCurve curve = finder.follow(1);
    ASSERT_TRUE(curve.closed) << curve.problem;
    EXPECT_EQ(curve.shift, 3U); // 3 * 2/5 is a fifth of a turn
    const double edge = e / (0.2 * pi);
    EXPECT_NEAR(curve.greatest(), edge, 1e-14);
    EXPECT_NEAR(curve.least(), -edge, 1e-14);
    const TorusProblem problem(locked.setting, 120);
    for (const double off : {-3.0, -1.2, 1.2, 2.0}) {
        const double p = off * edge;
        const auto u = torus_beyond(problem, curve, resonance, p, 1);
        ASSERT_TRUE(u);
        const double rate = (off < 0 ? -1 : 1) * e * std::sqrt(off * off - 1);
        const Torus torus = problem.torus_of(*u);
        EXPECT_NEAR((torus.rotation - 0.4) * 2 * pi, rate, 2e-3 * std::abs(rate)) << off;
        EXPECT_EQ(u->back(), p);
        // A return advances the angle by the rotation number.
        for (const double turns : {0.0, 0.3}) {
            const std::vector<double> here = torus.state_at(turns), then = torus.state_at(turns + torus.rotation);
            const double angle = std::atan2(here[1], here[0]), after = std::atan2(then[1], then[0]),
                         advance = 2 * pi * (0.4 + 0.1 * p) + e * std::sin(5 * angle);
            EXPECT_NEAR(std::remainder(after - angle - advance, 2 * pi), 0, 0.02 * e) << off << ' ' << turns;
        }
    }
    // Within the tongue motions do not come around.
    EXPECT_FALSE(torus_beyond(problem, curve, resonance, 0.5 * edge, 1));
}

TEST(TorusBeyond, NeedsMoreHarmonicsNearATongue) {
    LockedCurve curve;
    curve.extremes.resize(2);
    curve.extremes[0].parameter = -1;
    curve.extremes[1].parameter = 1;
    // The harmonics of 5 decay by 3 - sqrt(8) at three half widths.
    EXPECT_NEAR(harmonics_beyond(curve, {1, 5}, 3, 1e-9), 5 * (1 + std::log(1e-9) / std::log(3 - std::sqrt(8.))), 1e-9);
    EXPECT_GT(harmonics_beyond(curve, {1, 5}, 1.1, 1e-9), harmonics_beyond(curve, {1, 5}, -3, 1e-9));
}

} // namespace graze::torus_beyond_test
