#include "graze/base/input_error.hpp"
#include "graze/branch/continuation.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace graze::continuation_test {

DenseProblem circle(bool exact) {
    const auto residual = [](std::span<const double> u, std::span<double> f) {
        f[0] = u[0] * u[0] + u[1] * u[1] - 1;
        return true;
    };
    const auto jacobian = [](std::span<const double> u, std::span<double> j) {
        j[0] = 2 * u[0];
        j[1] = 2 * u[1];
        return true;
    };
    return exact ? DenseProblem(2, residual, jacobian) : DenseProblem(2, residual);
}

TEST(Continuation, ClosesOnACircle) {
    for (const bool exact : {true, false})
        for (const int direction : {1, -1}) {
            DenseProblem problem = circle(exact);
            Continuation branch(borrowed(problem));
            const std::vector<double> start{0.1, 1.05};
            ASSERT_TRUE(branch.start(start, 0, direction));
            EXPECT_NEAR(branch.point().u[0], 0.1, 1e-15);
            std::size_t folds = 0;
            while (branch.step()) {
                const auto& u = branch.point().u;
                EXPECT_NEAR(std::hypot(u[0], u[1]), 1, 1e-11);
                folds += branch.point().tangent[0] * branch.previous().tangent[0] < 0 ? 1 : 0;
                EXPECT_GT(branch.point().determinant * branch.previous().determinant, 0);
                ASSERT_LT(branch.steps(), 1000u);
            }
            EXPECT_EQ(branch.outcome(), ContinuationOutcome::closed);
            EXPECT_EQ(folds, 2u);
            // Chords of at most 0.1 are slightly shorter than the arc.
            EXPECT_NEAR(branch.point().arclength, 2 * std::numbers::pi, 0.12);
        }
}

TEST(Continuation, BetweenGivesPointsOfTheLastStep) {
    DenseProblem problem = circle(true);
    Continuation branch(borrowed(problem));
    const std::vector<double> start{0.9, std::sqrt(1 - 0.81)};
    ASSERT_TRUE(branch.start(start, 0, 1));
    while (branch.step() && branch.point().tangent[0] > 0) {
    }
    // The fold in the first unknown, by bisection.
    double low = 0, high = 1;
    ContinuationPoint point;
    for (int i = 0; i < 60; ++i) {
        const double middle = 0.5 * (low + high);
        ASSERT_TRUE(branch.between(middle, point));
        (point.tangent[0] > 0 ? low : high) = middle;
    }
    EXPECT_NEAR(point.u[0], 1, 1e-14);
    EXPECT_NEAR(point.u[1], 0, 1e-12);
}

/// The pitchfork x (p - x^2) = 0.
DenseProblem pitchfork() {
    return DenseProblem(2, [](std::span<const double> u, std::span<double> f) {
        f[0] = u[0] * (u[1] - u[0] * u[0]);
        return true;
    });
}

TEST(Continuation, DeterminantChangesItsSignAtABranchPoint) {
    DenseProblem problem = pitchfork();
    Continuation branch(borrowed(problem));
    const std::vector<double> start{0, -0.303};
    ASSERT_TRUE(branch.start(start, 1, 1));
    double before = branch.point().determinant;
    std::size_t changes = 0;
    while (branch.step() && branch.point().u[1] < 0.5) {
        changes += branch.point().determinant * before < 0 ? 1 : 0;
        before = branch.point().determinant;
        EXPECT_NEAR(branch.point().u[0], 0, 1e-9);
    }
    EXPECT_EQ(changes, 1u);
    // From the branch point onto the other branch.
    const std::vector<double> point{0, 0}, across{1, 0};
    Continuation other(borrowed(problem));
    ASSERT_TRUE(other.start_along(point, across, 0.05));
    while (other.step() && other.steps() < 20)
        EXPECT_NEAR(other.point().u[0] * other.point().u[0], other.point().u[1], 1e-10);
    EXPECT_GT(other.point().u[0], 0.1);
    ASSERT_TRUE(other.start_along(point, across, -0.05));
    EXPECT_LT(other.point().u[0], 0);
}

TEST(Continuation, ResultsDoNotDependOnScales) {
    // The same curve in units that differ by twelve powers of ten.
    DenseProblem problem(2,
                         [](std::span<const double> u, std::span<double> f) {
                             const double x = u[0] * 1e9, y = u[1] * 1e-3;
                             f[0] = x * x + y * y - 1;
                             return true;
                         },
                         {}, {1e-9, 1e3});
    Continuation branch(borrowed(problem));
    const std::vector<double> start{1e-10, 1e3};
    ASSERT_TRUE(branch.start(start, 0, 1));
    while (branch.step())
        ASSERT_LT(branch.steps(), 1000u);
    EXPECT_EQ(branch.outcome(), ContinuationOutcome::closed);
}

TEST(Continuation, OutcomeTellsHowItEnded) {
    // A branch that ends where a square root becomes undefined.
    DenseProblem problem(2, [](std::span<const double> u, std::span<double> f) {
        f[0] = u[0] - std::sqrt(u[1]) * u[1];
        return u[1] >= 0;
    });
    Continuation branch(borrowed(problem));
    const std::vector<double> start{1, 1};
    ASSERT_TRUE(branch.start(start, 1, -1));
    while (branch.step())
        ASSERT_LT(branch.steps(), 10000u);
    EXPECT_EQ(branch.outcome(), ContinuationOutcome::undefined);
    EXPECT_LT(branch.point().u[1], 1e-4);
    // No solution nearby.
    DenseProblem none(2, [](std::span<const double> u, std::span<double> f) {
        f[0] = u[0] * u[0] + 1;
        return true;
    });
    Continuation lost(borrowed(none));
    EXPECT_FALSE(lost.start(start, 1, 1));
    EXPECT_EQ(lost.outcome(), ContinuationOutcome::no_convergence);
    ContinuationOptions options;
    options.largest_step = -1;
    EXPECT_THROW(Continuation(borrowed(none), options), InputError);
}

TEST(Continuation, CanBeStoppedAndResumedAfterAnyStep) {
    DenseProblem problem = circle(true);
    const std::vector<double> start{0, 1};
    Continuation whole(borrowed(problem));
    ASSERT_TRUE(whole.start(start, 0, 1));
    for (int i = 0; i < 20; ++i)
        whole.step();
    Continuation first(borrowed(problem));
    ASSERT_TRUE(first.start(start, 0, 1));
    for (int i = 0; i < 10; ++i)
        first.step();
    Continuation second(borrowed(problem));
    ASSERT_TRUE(second.start_at(first.point().u, first.point().tangent));
    second.set_next_step(first.next_step());
    for (int i = 0; i < 10; ++i)
        second.step();
    for (int i = 0; i < 2; ++i)
        EXPECT_NEAR(second.point().u[static_cast<std::size_t>(i)], whole.point().u[static_cast<std::size_t>(i)], 1e-12);
}

} // namespace graze::continuation_test
