#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace graze {

/// Smooth equations F(u) = 0, one fewer than unknowns: their solutions form branches.
class ContinuationProblem {
public:
    virtual ~ContinuationProblem() = default;
    virtual std::size_t unknowns() const = 0;
    /// Sizes by which unknowns are measured; constant between calls of `evaluate` that belong to one step.
    virtual std::span<const double> scales() const = 0;
    /// How much unknowns count in lengths and angles: 0 for those that only repeat what others say. 1 for all, if
    /// empty.
    virtual std::span<const double> weights() const { return {}; }
    /// Evaluates F and its derivatives at u, which are kept for `solve`. @return false where F is not defined
    virtual bool evaluate(std::span<const double> u) = 0;
    /// Solves derivatives * step = -F (0 if homogeneous) together with row . step = right.
    /// @param determinant if not null: of the whole matrix, up to a positive factor that varies smoothly
    /// @return false when the matrix is singular
    virtual bool solve(std::span<const double> row, double right, bool homogeneous, std::span<double> step,
                       double* determinant) = 0;
    /// Whether F alone can be evaluated, by `chord`; and whether that costs so much less than derivatives that those of
    /// the last point are worth a try.
    virtual bool has_chords() const { return false; }
    virtual bool derivatives_are_expensive() const { return false; }
    /// Solves derivatives * step = -F(u) together with row . step = 0, with the derivatives of the last `evaluate`,
    /// which stay. @return false where F is not defined or the matrix is singular
    virtual bool chord(std::span<const double>, std::span<const double>, std::span<double>) { return false; }
    /// Called before each step with the point from which it goes: scales may be chosen anew.
    virtual void accept(std::span<const double>) {}
    /// Takes whole periods out of the difference of two solutions, where some unknowns are angles.
    virtual void reduce(std::span<double>) const {}
};

/// Equations given by functions, solved with dense matrices: for problems of moderate size.
class DenseProblem : public ContinuationProblem {
public:
    /// @param residuals of u: unknowns - 1 values
    /// @param jacobian of u: (unknowns - 1) x unknowns, row by row; central differences if empty
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

/// A solution with the direction of the branch through it.
struct ContinuationPoint {
    std::vector<double> u;
    std::vector<double> tangent; ///< of length 1 in units of the scales
    double arclength = 0;        ///< since the start, in units of the scales
    double determinant = 0;      ///< of the derivatives bordered by the tangent: changes sign at branch points
    std::size_t iterations = 0;  ///< of Newton's method
};

struct ContinuationOptions {
    double first_step = 0.01;    ///< arclength, in units of the scales
    double smallest_step = 1e-8; ///< below which it gives up
    double largest_step = 0.05;
    double accuracy = 1e-10;     ///< last correction, in units of the scales
    double largest_angle = 0.35; ///< between tangents of successive points, in radians
    std::size_t iterations = 7;  ///< of Newton's method, for each point
    /// @throws InputError naming the option that is out of range
    void validate() const;
};

enum class ContinuationOutcome {
    going,
    closed,         ///< back at the first point
    no_convergence, ///< steps have become smaller than the smallest
    undefined,      ///< F is not defined at the first point, or nowhere beyond the last
    singular,       ///< no single branch passes through the first point
};
std::string_view name_of(ContinuationOutcome outcome);

/// Follows a branch by pseudo-arclength continuation (H. B. Keller, 1977; E. Allgower and K. Georg, "Introduction to
/// Numerical Continuation Methods", 2003): a step along the tangent, corrected by Newton's method in the hyperplane
/// across it. The step grows and shrinks with how fast that converges and how much the branch bends. Knows nothing of
/// what the unknowns mean. One can stop after any step, look at the point, and go on.
class Continuation {
public:
    /// @param problem must outlive this. @throws InputError for options out of range
    explicit Continuation(ContinuationProblem& problem, const ContinuationOptions& options = {});

    /// Begins near u, which is corrected at a fixed value of one unknown if possible, along the branch in the direction
    /// in which that unknown grows (direction > 0) or falls. @return whether it has begun; `outcome` says why not
    bool start(std::span<const double> u, std::size_t unknown, int direction);
    /// Begins with a step from u, a solution, along a direction that need not be that of the branch through it: onto
    /// another branch. @param distance of the first point from u, in units of the scales
    bool start_along(std::span<const double> u, std::span<const double> direction, double distance);
    /// Begins at a solution u in the direction whose product with the row is positive.
    bool start_at(std::span<const double> u, std::span<const double> row);

    /// Makes the next point. @return false when there is none; `outcome` says why
    /// @throws std::logic_error before anything has been started
    bool step();
    const ContinuationPoint& point() const { return point_; }
    const ContinuationPoint& previous() const { return previous_; }
    ContinuationOutcome outcome() const { return outcome_; }
    std::size_t steps() const { return steps_; }
    /// Length of the next step that will be tried, in units of the scales; may be changed.
    double next_step() const { return next_step_; }
    void set_next_step(double length);

    /// A solution between the last two points, where the branch crosses a hyperplane at a fraction of the way.
    /// The problem is left evaluated there. @return false when Newton's method does not converge
    bool between(double fraction, ContinuationPoint& result);

private:
    void require_point(std::span<const double> u) const;
    double product(std::span<const double> a, std::span<const double> b) const;
    bool correct(std::vector<double>& u, std::span<const double> row, double allowed, std::size_t& iterations);
    std::vector<double> predict(double length) const;
    bool newton(std::vector<double>& u, std::span<const double> row, double allowed, std::size_t& iterations);
    bool chords(std::vector<double>& u, std::span<const double> row, double allowed, bool renewed,
                std::size_t& iterations);
    void accelerate(std::vector<double>& step) const;
    double size_of(std::span<const double> step) const;
    bool find_tangent(ContinuationPoint& point, std::span<const double> row);
    bool begin(ContinuationPoint point);
    std::vector<double> any_row() const;
    bool stands_still(ContinuationPoint point, std::size_t unknown);
    bool start_across(std::span<const double> u, std::size_t unknown, int direction);
    bool closes();
    void weigh(std::span<const double> direction, std::vector<double>& row) const;

    ContinuationProblem* problem_;
    ContinuationOptions options_;
    ContinuationPoint point_, previous_, first_;
    ContinuationOutcome outcome_ = ContinuationOutcome::going;
    double next_step_;
    std::size_t steps_ = 0;
    std::vector<double> step_;
    std::vector<std::vector<double>> made_; ///< corrections by chords, of one point
    double pace_ = 1;                       ///< of the next step to the last one, as far as the work for it says
};

} // namespace graze
