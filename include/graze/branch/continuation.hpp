#pragma once

#include "graze/base/borrowed.hpp"

#include <cstddef>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace graze {

/// Smooth equations F(u) = 0, one fewer than unknowns, whose solutions form branches.
class ContinuationProblem {
public:
    virtual ~ContinuationProblem() = default;
    virtual std::size_t unknowns() const = 0;
    /// Positive scales of the unknowns; constant between calls of `evaluate` that belong to one step.
    /// The numbers must stay where they are until `accept`, as those of `weights`.
    virtual std::span<const double> scales() const = 0;
    /// Weights of the unknowns in lengths and angles: 0 for redundant unknowns. Empty: 1 for all.
    virtual std::span<const double> weights() const { return {}; }
    /// Evaluates F and its derivatives at u and stores them for `solve`. @return false where F is not defined
    virtual bool evaluate(std::span<const double> u) = 0;
    /// Solves derivatives * step = -F (0 if homogeneous) together with row . step = right.
    /// @param determinant if not null, set to the determinant of the bordered matrix, up to a positive factor that
    /// varies smoothly
    /// @return false when the matrix is singular
    virtual bool solve(std::span<const double> row, double right, bool homogeneous, std::span<double> step,
                       double* determinant) = 0;
    /// True when `chord` is available: F can be evaluated without derivatives.
    virtual bool has_chords() const { return false; }
    /// True when derivatives cost so much more than F that those of the last point should be tried first.
    virtual bool derivatives_are_expensive() const { return false; }
    /// Solves derivatives * step = -F(u) together with row . step = 0, with the derivatives of the last `evaluate`,
    /// which are kept. @return false where F is not defined or the matrix is singular
    virtual bool chord(std::span<const double>, std::span<const double>, std::span<double>) { return false; }
    /// Called before each step with its start point; the problem may then choose new scales.
    virtual void accept(std::span<const double>) {}
    /// Returns the round-off of solutions beside the last evaluation, in scaled unknowns, where it is known to be
    /// large.
    virtual double round_off() const { return 0; }
    /// Removes whole periods from the difference of two solutions where unknowns are angles.
    virtual void reduce(std::span<double>) const {}

    /// Returns the inner product of two directions in scaled and weighted unknowns.
    double product(std::span<const double> a, std::span<const double> b) const;
    double length_of(std::span<const double> direction) const;
    /// Returns the row whose product with a vector is the inner product with a direction.
    std::vector<double> row_of(std::span<const double> direction) const;
};

/// Equations given by functions and solved with dense matrices, for problems of moderate size.
class DenseProblem : public ContinuationProblem {
public:
    /// @param residuals function of u: unknowns - 1 values
    /// @param jacobian function of u: (unknowns - 1) x unknowns values, row by row; central differences if empty
    /// @param scales of the unknowns; 1 if empty
    using Map = std::function<bool(std::span<const double> u, std::span<double> values)>;
    DenseProblem(std::size_t unknowns, Map residuals, Map jacobian = {}, std::vector<double> scales = {});
    std::size_t unknowns() const override { return unknowns_; }
    std::span<const double> scales() const override { return scales_; }
    bool evaluate(std::span<const double> u) override;
    bool solve(std::span<const double> row, double right, bool homogeneous, std::span<double> step,
               double* determinant) override;

private:
    bool differences(std::span<const double> u);
    std::size_t unknowns_;
    Map residuals_, jacobian_;
    bool evaluated_ = false;
    std::vector<double> scales_, values_, matrix_;
};

/// A solution with the tangent of the branch through it.
struct ContinuationPoint {
    std::vector<double> u;
    std::vector<double> tangent; ///< unit tangent, in scaled unknowns
    double arclength = 0;        ///< arclength since the start, in scaled unknowns
    double determinant = 0; ///< determinant of the derivatives bordered by the tangent: changes sign at branch points
    std::size_t iterations = 0; ///< iterations of Newton's method
};

struct ContinuationOptions {
    double first_step = 0.01;    ///< length of the first step, in scaled unknowns
    double smallest_step = 1e-8; ///< the continuation ends when the step falls below this
    double largest_step = 0.05;  ///< upper limit of the step; make it smaller where special points are missed
    double accuracy = 1e-10; ///< Newton's method stops when its last correction, scaled, is below this; 1e-15 .. 1e-2
    double largest_angle = 0.35; ///< largest angle between tangents of successive points, in radians, below 1.5
    std::size_t iterations = 7;  ///< largest number of Newton iterations per point; beyond it the step is halved
    /// @throws InputError naming the option that is out of range
    void validate() const;
};

/// Why a continuation has ended, or that it has not.
enum class ContinuationOutcome {
    going,          ///< it has not ended
    closed,         ///< the branch has returned to its first point
    no_convergence, ///< the step has fallen below the smallest step
    undefined,      ///< F is not defined at the first point, or beyond the last
    singular,       ///< the first point does not lie on a single branch
};
std::string_view name_of(ContinuationOutcome outcome);

/// Follows a branch by pseudo-arclength continuation (H. B. Keller, 1977; E. Allgower and K. Georg, "Introduction to
/// Numerical Continuation Methods", 2003): a predictor step along the tangent, corrected by Newton's method in the
/// hyperplane orthogonal to it. The step length adapts to the speed of convergence and the curvature of the branch. The
/// class is independent of the meaning of the unknowns. It can be stopped after any step, inspected and resumed.
class Continuation {
public:
    /// @param problem is shared, also with copies. @throws InputError for options out of range
    explicit Continuation(std::shared_ptr<ContinuationProblem> problem, const ContinuationOptions& options = {});

    /// Starts near u, which is corrected with one unknown fixed if possible, in the direction in which that unknown
    /// increases (direction > 0) or decreases. @return false when the start failed; `outcome` says why
    bool start(std::span<const double> u, std::size_t unknown, int direction);
    /// Starts with a step from a solution u along a given direction, which may be that of another branch through u.
    /// @param distance of the first point from u, in scaled unknowns
    bool start_along(std::span<const double> u, std::span<const double> direction, double distance);
    /// Starts at a solution u in the direction whose product with the row is positive.
    bool start_at(std::span<const double> u, std::span<const double> row);

    /// Computes the next point. @return false when the continuation has ended; `outcome` says why
    /// @throws OrderError before any start
    bool step();
    const ContinuationPoint& point() const { return point_; }
    const ContinuationPoint& previous() const { return previous_; }
    ContinuationOutcome outcome() const { return outcome_; }
    std::size_t steps() const { return steps_; }
    /// Length of the next step that will be tried, in scaled unknowns; it may be changed.
    double next_step() const { return next_step_; }
    void set_next_step(double length);

    /// Computes the solution between the last two points where the branch crosses the hyperplane at a fraction of the
    /// step. The problem stays evaluated there. @return false when Newton's method does not converge
    /// @param known solutions within the step, from which a better first guess follows than from its ends
    bool between(double fraction, ContinuationPoint& result, std::span<const ContinuationPoint> known = {});

private:
    ContinuationPoint point_at(std::span<const double> u) const;
    void normalise(std::vector<double>& tangent) const;
    bool correct(std::vector<double>& u, std::span<const double> row, double allowed, std::size_t& iterations);
    std::vector<double> predict(double length) const;
    bool newton(std::vector<double>& u, std::span<const double> row, double allowed, std::size_t& iterations);
    bool chords(std::vector<double>& u, std::span<const double> row, double allowed, bool renewed,
                std::size_t& iterations);
    void accelerate(std::vector<double>& step) const;
    double size_of(std::span<const double> step) const;
    bool find_tangent(ContinuationPoint& point, std::span<const double> row);
    bool begin(ContinuationPoint point);
    std::vector<double> generic_row() const;
    bool is_stationary(ContinuationPoint point, std::size_t unknown);
    bool start_across(std::span<const double> u, std::size_t unknown, int direction);
    bool closes();
    std::vector<double> guess_between(double fraction, std::span<const double> chord,
                                      std::span<const ContinuationPoint> known) const;

    std::shared_ptr<ContinuationProblem> problem_;
    ContinuationOptions options_;
    ContinuationPoint point_, previous_, first_;
    ContinuationOutcome outcome_ = ContinuationOutcome::going;
    double next_step_;
    std::size_t steps_ = 0;
    std::vector<double> step_;
    std::vector<std::vector<double>> corrections_; ///< chord corrections of the current point
    double step_growth_ = 1; ///< suggested ratio of the next step to the last one, from the work that the last one took
};

} // namespace graze
