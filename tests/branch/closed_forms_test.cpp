// Branches of impacting orbits with closed forms: the bouncing ball and the linear impact oscillator.

#include "follow.hpp"
#include "impact_oscillator.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>

namespace graze::closed_forms_test {

using namespace graze::testing;
using std::numbers::pi;

double bisect(const std::function<double(double)>& function, double low, double high) {
    const bool negative = function(low) < 0;
    EXPECT_NE(negative, function(high) < 0);
    for (int i = 0; i < 100; ++i) {
        const double middle = 0.5 * (low + high);
        ((function(middle) < 0) == negative ? low : high) = middle;
    }
    return 0.5 * (low + high);
}

/// One bounce per period T of the table. With the table's velocity W and acceleration A at the impact, the ball leaves
/// with g T / 2 and comes back with -g T / 2, hence W = (1 - e) / (1 + e) g T / 2. With time and velocity (t, v) after
/// an impact the map to the next one has the derivatives
///     dt' = dt + (1 + e) / g dv,    dv' = (1 + e) A dt' - e dv + e g (dt' - dt):
/// determinant e^2, trace 1 + e^2 + (1 + e)^2 A / g.
struct Ball {
    double g = 9.81, e = 0.8, f = 10;
    double omega() const { return 2 * pi * f; }
    double table_velocity() const { return (1 - e) / (1 + e) * g / (2 * f); }
    double fold() const { return table_velocity() / omega(); }
    double flip() const {
        return std::hypot(table_velocity(), 2 * g * (1 + e * e) / ((1 + e) * (1 + e) * omega())) / omega();
    }
    /// @param stable true: the branch on which the table's upward velocity decreases at the impact
    double phase(double a, bool stable) const {
        return (stable ? 1 : -1) * std::acos(table_velocity() / (a * omega()));
    }
    double trace(double a, bool stable) const {
        const double acceleration = -a * omega() * omega() * std::sin(phase(a, stable));
        return 1 + e * e + (1 + e) * (1 + e) * acceleration / g;
    }
    /// Returns the minimum of the gap between two impacts on the other branch.
    double least_gap(double a) const {
        const double start = phase(a, false), speed = g / (2 * f);
        const auto rate = [&](double t) { return speed - g * t - a * omega() * std::cos(start + omega() * t); };
        constexpr int parts = 1000;
        for (int i = 1; i < parts; ++i) {
            const double t = i / (f * parts), next = (i + 1) / (f * parts);
            if (rate(t) < 0 && rate(next) >= 0) {
                const double at = bisect(rate, t, next);
                return a * std::sin(start) + speed * at - g * at * at / 2 - a * std::sin(start + omega() * at);
            }
        }
        return NAN;
    }
    Model model(double a) const { return shipped_with("bouncing-ball", {{"a", a}}); }
    Orbit orbit(const Model& model, double a) const {
        const double at = phase(a, true);
        return given_orbit(model, "impact", {{a * std::sin(at), g / (2 * f), at}}, {1 / f});
    }
};

TEST(ClosedForms, BouncingBallHasItsFoldFlipAndGrazing) {
    const Ball ball;
    const Model model = ball.model(0.002);
    BranchSettings settings = in_parameter(model, "a", {}, 0.01);
    const Orbit orbit = ball.orbit(model, 0.002);

    const Branch up = follow_branch(System(model), orbit, settings);
    ASSERT_EQ(names(up), "PD BD");
    EXPECT_NEAR(up.special[0].parameter, ball.flip(), 1e-15);
    expect_flip(up.special[0]);
    EXPECT_EQ(up.outcome, BranchOutcome::bound);
    EXPECT_EQ(up.points.back().parameter, 0.01);

    settings.direction = -1;
    const Branch down = follow_branch(System(model), orbit, settings);
    ASSERT_EQ(names(down), "SN GR");
    EXPECT_NEAR(down.special[0].parameter, ball.fold(), 1e-15);
    EXPECT_NEAR(ball.fold() * ball.omega() * ball.omega() / ball.g, pi * (1 - ball.e) / (1 + ball.e), 1e-14);
    expect_fold(down, down.special[0]);
    const double touch = bisect([&](double a) { return ball.least_gap(a); }, 0.004, 0.009);
    EXPECT_NEAR(down.special[1].parameter, touch, 1e-14);
    expect_touch(model, down.special[1], 0.01);

    for (const Branch* branch : {&up, &down})
        for (const BranchPoint& point : branch->points) {
            const bool stable = std::sin(point.solution.orbit.starts[0][2]) > 0;
            ASSERT_EQ(point.solution.multipliers.size(), 2U);
            const auto sum = point.solution.multipliers[0] + point.solution.multipliers[1];
            const auto product = point.solution.multipliers[0] * point.solution.multipliers[1];
            // The derivative of phase and trace with respect to the parameter is infinite at the fold.
            const double near_fold = std::sqrt(std::abs(point.parameter / ball.fold() - 1)) + 1e-7;
            EXPECT_NEAR(sum.real(), ball.trace(std::max(point.parameter, ball.fold()), stable),
                        1e-11 * std::abs(sum) + 1e-13 / near_fold);
            EXPECT_NEAR(product.real(), ball.e * ball.e, 1e-12 * std::norm(sum));
        }
}

TEST(ClosedForms, BouncingBallDoublesItsPeriodAtTheFlip) {
    const Ball ball;
    Model model = ball.model(0.002);
    BranchSettings settings = in_parameter(model, "a", {}, 0.004);
    const Branch single = follow_branch(System(model), ball.orbit(model, 0.002), settings);
    ASSERT_EQ(names(single), "PD BD");
    const auto starts = branches_at(System(model), single.special[0], settings);
    ASSERT_EQ(starts.size(), 1U);
    EXPECT_EQ(starts[0].how, "doubled");
    const Branch branch = follow(model, starts[0], settings);
    ASSERT_EQ(names(branch), "PD BD");
    const double second = branch.special[0].parameter;
    EXPECT_GT(second, ball.flip());
    for (const BranchPoint& point : branch.points) {
        EXPECT_NEAR(point.solution.orbit.period(), 2 / ball.f, 1e-12);
        // The difference between the two flights grows with the square root of the distance and does not return to
        // zero.
        const auto& durations = point.solution.orbit.durations;
        EXPECT_GT(std::abs(durations[0] - durations[1]), 0.02 * std::sqrt(point.parameter / ball.flip() - 1) / ball.f);
        EXPECT_GE(point.parameter, ball.flip());
        EXPECT_EQ(point.stable, point.parameter < second);
        EXPECT_TRUE(point.solution.certificate.admissible) << point.solution.certificate.reason;
    }
    // Simulation from nearby settles on the stable orbits.
    std::size_t compared = 0;
    for (const BranchPoint& point : branch.points)
        if (point.parameter > 1.02 * ball.flip() && point.parameter < 0.98 * second) {
            model.set_parameter("a", point.parameter);
            const std::vector<double>& begin = point.solution.orbit.starts[0];
            model.set_initial("x", begin[0] + 1e-4);
            model.set_initial("v", 1.03 * begin[1]);
            model.set_initial("theta", begin[2] + 0.03);
            const OrbitSolution other = settled(model, "phase0", 4000);
            ASSERT_EQ(other.orbit.segments(), 2U);
            const bool swapped = std::abs(other.orbit.durations[0] - point.solution.orbit.durations[0]) > 1e-6;
            for (std::size_t k = 0; k < 2; ++k)
                for (std::size_t i = 0; i < 2; ++i)
                    EXPECT_NEAR(other.orbit.starts[(k + (swapped ? 1 : 0)) % 2][i], point.solution.orbit.starts[k][i],
                                1e-11);
            ++compared;
        }
    EXPECT_GE(compared, 2U);
    // In the other direction the branch ends where it returns to the original branch.
    settings.direction = -1;
    const Branch back = follow_branch(System(model), branch.points[5].solution.orbit, settings);
    EXPECT_EQ(back.outcome, BranchOutcome::returned) << names(back);
    // At the crossing the equations are singular; the parameter is quadratic in the remaining error.
    EXPECT_NEAR(back.points.back().parameter, ball.flip(), 1e-8 * ball.flip());
}

TEST(ClosedForms, ImpactOscillatorHasItsFoldFlipAndGrazing) {
    const Oscillator known;
    const Model model = oscillator_model(known, 0.02);
    const OrbitSolution start = settled(model, "phase0", 400);
    ASSERT_EQ(start.orbit.segments(), 1U);
    BranchSettings settings = in_parameter(model, "sigma", -1, 1);
    const auto check = [&](const Branch& branch) {
        for (const BranchPoint& point : branch.points) {
            const double after = point.solution.orbit.starts[0][1], phase = point.solution.orbit.starts[0][2];
            if (std::abs(after) < 1e-6)
                continue; // the end, where multipliers diverge
            ASSERT_EQ(point.solution.multipliers.size(), 2U);
            const auto sum = point.solution.multipliers[0] + point.solution.multipliers[1];
            const auto product = point.solution.multipliers[0] * point.solution.multipliers[1];
            EXPECT_NEAR(product.real(), known.product(), 1e-12 * (1 + std::norm(sum)));
            EXPECT_NEAR(sum.real(), known.trace(after, phase, point.parameter), 1e-9 * (1 + std::abs(sum)));
            const double upper = known.sigma(after, true), lower = known.sigma(after, false);
            EXPECT_LT(std::min(std::abs(upper - point.parameter), std::abs(lower - point.parameter)), 1e-11);
        }
    };
    const Branch up = follow_branch(System(model), start.orbit, settings);
    check(up);
    ASSERT_EQ(names(up), "PD GR");
    expect_flip(up.special[0]);
    const double flipping = up.special[0].solution.orbit.starts[0][1];
    const double velocity = bisect(
        [&](double v) {
            const double stop = known.sigma(v, true);
            return known.trace(v, known.phase(v, stop), stop) + 1 + known.product();
        },
        1.1 * flipping, 0.9 * flipping);
    EXPECT_NEAR(up.special[0].parameter, known.sigma(velocity, true), 1e-12);
    // The impact speed vanishes where the amplitude of the motion without impact equals the gap.
    EXPECT_TRUE(up.special[1].at_end);
    EXPECT_NEAR(up.special[1].parameter, known.radius, 1e-12);
    EXPECT_EQ(up.outcome, BranchOutcome::unphysical);

    settings.direction = -1; // through zero
    const Branch down = follow_branch(System(model), start.orbit, settings);
    check(down);
    ASSERT_EQ(names(down), "SN GR");
    EXPECT_NEAR(down.special[0].parameter, known.fold(false), 1e-13);
    expect_fold(down, down.special[0]);
    expect_touch(model, down.special[1], 0.3);
}

TEST(ClosedForms, ImpactOscillatorGainsAndLosesItsImpactAtTheSameGap) {
    const Oscillator known;
    const double sigma = 0.1;
    Model model = oscillator_model(known, sigma);
    model.set_parameter("amplitude", 0.1);
    model.set_initial("x", 0);
    BranchSettings settings = in_parameter(model, "amplitude", 0, 10);
    const Branch free = follow_branch(System(model), settled(model, "phase0").orbit, settings);
    ASSERT_EQ(names(free), "GR");
    EXPECT_NEAR(free.special[0].parameter, sigma / known.radius, 1e-13);
    expect_touch(model, free.special[0], sigma);
    for (const BranchPoint& point : free.points)
        EXPECT_NEAR(std::abs(point.solution.multipliers[0] * point.solution.multipliers[1]), known.decay * known.decay,
                    1e-12);
    const auto starts = branches_at(System(model), free.special[0], settings);
    ASSERT_EQ(starts.size(), 1U);
    const Branch impacting = follow(model, starts[0], settings);
    ASSERT_GT(impacting.points.size(), 5U);
    for (const BranchPoint& point : impacting.points) {
        ASSERT_EQ(point.solution.orbit.segments(), 1U);
        // In units of the force all is as above.
        const double after = point.solution.orbit.starts[0][1] / point.parameter, stop = sigma / point.parameter;
        EXPECT_LT(std::min(std::abs(known.sigma(after, true) - stop), std::abs(known.sigma(after, false) - stop)),
                  1e-11);
    }
    // From the last point with an impact back to where the impact vanishes, and on without it to zero force.
    settings.direction = impacting.points.back().parameter > impacting.points.front().parameter ? -1 : 1;
    const Branch back = follow_branch(System(model), impacting.points[5].solution.orbit, settings);
    const auto lost = of_type(back, PointType::grazing);
    ASSERT_EQ(lost.size(), 1U);
    EXPECT_TRUE(lost[0].at_end);
    EXPECT_NEAR(lost[0].parameter, sigma / known.radius, 1e-12);
    const auto without = branches_at(System(model), lost[0], settings);
    ASSERT_EQ(without.size(), 1U);
    const Branch to_rest = follow(model, without[0], settings);
    EXPECT_EQ(names(to_rest), "BD");
    EXPECT_EQ(to_rest.points.back().parameter, 0);
}

} // namespace graze::closed_forms_test
