#include "graze/branch/continuation.hpp"

#include "branch/longest_step.hpp"
#include "graze/base/input_error.hpp"
#include "graze/base/require.hpp"
#include "orbit/newton.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace graze {

namespace {

constexpr double growth = 2, shrinkage = 0.5;
/// Corrections longer than this share of the step may lead onto another branch and are rejected.
constexpr double largest_correction = 0.5;
/// Largest correction of the first point on another branch, relative to its distance: branches may cross obliquely.
constexpr double farthest = 1e3;
/// Steps whose convergence takes more iterations than this are followed by smaller ones.
constexpr std::size_t good_iterations = 3;
/// Distance to the first point, in scaled unknowns, below which a branch counts as closed.
constexpr double same_point = 1e-6;

/// Returns a point of the cubic Hermite interpolant of two points and their tangents: f = 0 at the first, 1 at the
/// second.
/// @param length between them
std::vector<double> on_cubic(const ContinuationPoint& first, const ContinuationPoint& second, double length, double f) {
    const double g = 1 - f;
    std::vector<double> result(first.u.size());
    for (std::size_t i = 0; i < result.size(); ++i)
        result[i] = g * g * (1 + 2 * f) * first.u[i] + f * f * (3 - 2 * f) * second.u[i] +
                    length * f * g * (g * first.tangent[i] - f * second.tangent[i]);
    return result;
}

/// Adds a correction. @param moved set to the total correction since `begin`
void advance(std::vector<double>& u, std::span<const double> step, std::span<const double> begin,
             std::vector<double>& moved) {
    moved.resize(u.size());
    for (std::size_t i = 0; i < u.size(); ++i) {
        u[i] += step[i];
        moved[i] = u[i] - begin[i];
    }
}

void require(bool good, const char* problem, const char* remedy) {
    if (!good)
        throw InputError(problem, remedy);
}

} // namespace

void ContinuationOptions::validate() const {
    require(smallest_step > 0 && std::isfinite(smallest_step), "the smallest step is not positive",
            "give a positive number");
    require(largest_step >= smallest_step && std::isfinite(largest_step),
            "the largest step is smaller than the smallest", "make it larger");
    require(first_step > 0 && std::isfinite(first_step), "the first step is not positive", "give a positive number");
    require_accuracy(accuracy);
    require(largest_angle > 0 && largest_angle < 1.5, "the largest angle is out of range",
            "choose between 0 and 1.5 radians");
    require(iterations > 0, "no iterations are allowed", "allow at least one");
}

std::string_view name_of(ContinuationOutcome outcome) {
    switch (outcome) {
    case ContinuationOutcome::going:
        return "going";
    case ContinuationOutcome::closed:
        return "closed";
    case ContinuationOutcome::no_convergence:
        return "no convergence";
    case ContinuationOutcome::undefined:
        return "undefined";
    case ContinuationOutcome::singular:
        return "singular";
    }
    return "";
}

Continuation::Continuation(std::shared_ptr<ContinuationProblem> problem, const ContinuationOptions& options)
    : problem_(required(std::move(problem), "a problem")), options_(options), next_step_(options.first_step) {
    options_.validate();
    step_.resize(problem_->unknowns());
}

void Continuation::set_next_step(double length) {
    if (!(length > 0))
        throw InputError(fmt::format("the next step cannot have the length {}", length), "give a positive one");
    next_step_ = std::clamp(length, options_.smallest_step, options_.largest_step);
}

double Continuation::product(std::span<const double> a, std::span<const double> b) const {
    const auto scales = problem_->scales(), weights = problem_->weights();
    double sum = 0;
    for (std::size_t i = 0; i < a.size(); ++i)
        sum += a[i] / scales[i] * (b[i] / scales[i]) * (weights.empty() ? 1 : weights[i]);
    return sum;
}

/// Computes the row whose product with a vector is the scaled inner product with the direction.
void Continuation::weigh(std::span<const double> direction, std::vector<double>& row) const {
    const auto scales = problem_->scales(), weights = problem_->weights();
    row.resize(direction.size());
    for (std::size_t i = 0; i < direction.size(); ++i)
        row[i] = direction[i] / (scales[i] * scales[i]) * (weights.empty() ? 1 : weights[i]);
}

double Continuation::size_of(std::span<const double> step) const {
    const auto scales = problem_->scales();
    double size = 0;
    for (std::size_t i = 0; i < step.size(); ++i)
        size = std::isnan(step[i]) ? std::numeric_limits<double>::infinity()
                                   : std::max(size, std::abs(step[i]) / scales[i]);
    return size;
}

/// Corrects u in the hyperplane orthogonal to a row, and evaluates there. @param allowed largest total correction
bool Continuation::correct(std::vector<double>& u, std::span<const double> row, double allowed,
                           std::size_t& iterations) {
    for (const bool renewed : {false, true}) {
        std::vector<double> trial = u;
        if (!problem_->has_chords() || (!renewed && !problem_->derivatives_are_expensive()) ||
            !chords(trial, row, allowed, renewed, iterations))
            continue;
        u = std::move(trial);
        return true;
    }
    return newton(u, row, allowed, iterations);
}

bool Continuation::newton(std::vector<double>& u, std::span<const double> row, double allowed,
                          std::size_t& iterations) {
    const std::vector<double> begin = u;
    std::vector<double> moved;
    double before = 0;
    for (iterations = 1; iterations <= options_.iterations; ++iterations) {
        if (!problem_->evaluate(u) || !problem_->solve(row, 0, false, step_, nullptr))
            return false;
        advance(u, step_, begin, moved);
        const double size = size_of(step_);
        if (!std::isfinite(size) || std::sqrt(product(moved, moved)) > allowed)
            return false;
        // Newton's method converges quadratically, so this correction was the last. A small one that is not smaller
        // than the one before is round-off.
        constexpr double round_off = 1e-11;
        const bool small = size < options_.accuracy || (iterations > 2 && size < round_off && size > 0.5 * before);
        if (small || (iterations > 1 && size < 0.1 * before && size * size < options_.accuracy * 1e-4)) {
            step_growth_ = iterations <= good_iterations ? growth : shrinkage;
            if (!problem_->evaluate(u))
                return false;
            if (small)
                return true;
            // For strongly expanding orbits the flow is less accurate than required and depends on the integration
            // steps: one more correction finds the solution for the current steps.
            const double left = problem_->solve(row, 0, false, step_, nullptr) ? size_of(step_) : 0;
            if (!(left > options_.accuracy && left <= before))
                return true;
            advance(u, step_, begin, moved);
            return problem_->evaluate(u);
        }
        if (iterations > 2 && size > before)
            return false;
        before = size;
    }
    return false;
}

/// Corrects with the derivatives of a nearby point, improved by Broyden updates (C. G. Broyden 1965): the stored ones
/// or, if `renewed`, those at the start. The derivatives at the end, which are needed anyway, verify the solution.
bool Continuation::chords(std::vector<double>& u, std::span<const double> row, double allowed, bool renewed,
                          std::size_t& iterations) {
    // Corrections that shrink less than by this factor converge more slowly than Newton's method.
    constexpr double slow = 0.5;
    // Corrections end where the next one is estimated below this share of the accuracy; a last one with new derivatives
    // is made where it exceeds this.
    constexpr double enough = 1e-4;
    constexpr std::size_t most = 12, few = 6;
    // Ratio of the second correction to the first below which Newton's method would take three iterations.
    constexpr double fast = 0.1;
    const std::vector<double> begin = u;
    std::vector<double> moved, step(u.size());
    double before = 0;
    bool quick = true;
    corrections_.clear();
    for (iterations = 1;; ++iterations) {
        const bool first = renewed && iterations == 1;
        if (iterations > most || (first && !problem_->evaluate(u)) ||
            !(first ? problem_->solve(row, 0, false, step, nullptr) : problem_->chord(u, row, step)))
            return false;
        accelerate(step);
        advance(u, step, begin, moved);
        const double size = size_of(step);
        if (!std::isfinite(size) || std::sqrt(product(moved, moved)) > allowed)
            return false;
        if (iterations == 2)
            quick = size < fast * before || size < options_.accuracy;
        const double ratio = iterations > 1 ? size / before : 1;
        if (size * std::min(ratio, 1.0) < enough * options_.accuracy)
            break;
        if (ratio > slow && iterations > 1) {
            if (size < options_.accuracy)
                break; // round-off
            return false;
        }
        before = size;
        corrections_.push_back(step);
    }
    if (!problem_->derivatives_are_expensive())
        step_growth_ = quick ? growth : shrinkage;
    else if (!renewed) // additional corrections cost less than a shorter step
        step_growth_ = iterations <= few ? growth : 1;
    else // the derivatives of the last point were too inaccurate
        step_growth_ = quick ? 1 : shrinkage;
    if (!problem_->evaluate(u) || !problem_->solve(row, 0, false, step_, nullptr))
        return false;
    const double last = size_of(step_);
    if (last > options_.accuracy)
        return false;
    if (last < enough * options_.accuracy)
        return true;
    for (std::size_t i = 0; i < u.size(); ++i)
        u[i] += step_[i];
    return problem_->evaluate(u);
}

/// Applies the Broyden updates of the previous corrections to the next one (as in C. T. Kelley, "Solving Nonlinear
/// Equations with Newton's Method", SIAM 2003, chapter 4).
void Continuation::accelerate(std::vector<double>& step) const {
    for (std::size_t j = 0; j < corrections_.size(); ++j) {
        const std::vector<double>& one = corrections_[j];
        const double share = product(one, step) / product(one, one);
        if (j + 1 == corrections_.size()) {
            for (double& entry : step)
                entry /= 1 - share;
        } else {
            for (std::size_t i = 0; i < step.size(); ++i)
                step[i] += share * corrections_[j + 1][i];
        }
    }
}

/// Computes the tangent at the point of the last evaluation, oriented by the row.
bool Continuation::find_tangent(ContinuationPoint& point, std::span<const double> row) {
    point.tangent.resize(point.u.size());
    if (!problem_->solve(row, 1, true, point.tangent, &point.determinant))
        return false;
    const double length = std::sqrt(product(point.tangent, point.tangent));
    if (!(length > 0) || !std::isfinite(length))
        return false;
    for (double& entry : point.tangent)
        entry /= length;
    // By Cramer's rule this is the determinant bordered by the tangent instead of the row.
    point.determinant *= length;
    return true;
}

bool Continuation::begin(ContinuationPoint point) {
    point.arclength = 0;
    problem_->accept(point.u);
    // Scales may have changed.
    const double length = std::sqrt(product(point.tangent, point.tangent));
    for (double& entry : point.tangent)
        entry /= length;
    point_ = previous_ = first_ = std::move(point);
    steps_ = 0;
    outcome_ = ContinuationOutcome::going;
    return true;
}

bool Continuation::start(std::span<const double> u, std::size_t unknown, int direction) {
    require_point(u);
    require_index(unknown, u.size(), "unknown");
    ContinuationPoint point;
    point.u.assign(u.begin(), u.end());
    std::vector<double> row(u.size(), 0.0);
    row[unknown] = 1 / problem_->scales()[unknown];
    const double far = 1e3 * static_cast<double>(u.size());
    outcome_ = ContinuationOutcome::undefined;
    if (!problem_->evaluate(point.u))
        return false;
    outcome_ = ContinuationOutcome::no_convergence;
    // Where the unknown is constant along the branch, fixing it would select a point by round-off.
    if (is_stationary(point, unknown) || !correct(point.u, row, far, point.iterations))
        return start_across(u, unknown, direction);
    outcome_ = ContinuationOutcome::singular;
    row[unknown] = (direction < 0 ? -1 : 1) / problem_->scales()[unknown];
    return find_tangent(point, row) && begin(std::move(point));
}

/// Returns a row that is unlikely to be orthogonal to the tangent of any problem.
std::vector<double> Continuation::generic_row() const {
    std::vector<double> row(problem_->unknowns());
    for (std::size_t i = 0; i < row.size(); ++i)
        row[i] = std::cos(2.4 * static_cast<double>(i)) / problem_->scales()[i];
    return row;
}

bool Continuation::is_stationary(ContinuationPoint point, std::size_t unknown) {
    constexpr double still = 1e-7;
    return problem_->evaluate(point.u) && find_tangent(point, generic_row()) &&
           std::abs(point.tangent[unknown]) < still * problem_->scales()[unknown];
}

/// Starts where the unknown cannot be fixed, as at a fold: corrects orthogonally to the branch instead.
bool Continuation::start_across(std::span<const double> u, std::size_t unknown, int direction) {
    ContinuationPoint point;
    point.u.assign(u.begin(), u.end());
    if (!problem_->evaluate(point.u) || !find_tangent(point, generic_row()))
        return false;
    std::vector<double> across;
    weigh(point.tangent, across);
    constexpr double near = 0.1;
    if (!correct(point.u, across, near, point.iterations) || !problem_->evaluate(point.u))
        return false;
    outcome_ = ContinuationOutcome::singular;
    const double rise = point.tangent[unknown] * direction;
    if (rise < 0 || (rise == 0 && direction < 0)) // where the unknown is constant, the two directions must be opposite
        for (double& entry : across)
            entry = -entry;
    return find_tangent(point, across) && begin(std::move(point));
}

bool Continuation::start_at(std::span<const double> u, std::span<const double> row) {
    require_point(u);
    require_size(row.size(), u.size(), "numbers of a row");
    require_finite(row, "a number of a row");
    ContinuationPoint point;
    point.u.assign(u.begin(), u.end());
    outcome_ = ContinuationOutcome::undefined;
    if (!problem_->evaluate(point.u))
        return false;
    outcome_ = ContinuationOutcome::singular;
    return find_tangent(point, row) && begin(std::move(point));
}

bool Continuation::start_along(std::span<const double> u, std::span<const double> direction, double distance) {
    require_point(u);
    require_size(direction.size(), u.size(), "numbers of a direction");
    require_finite(direction, "a number of a direction");
    require_finite(distance, "the distance");
    const double length = std::sqrt(product(direction, direction));
    outcome_ = ContinuationOutcome::singular;
    if (!(length > 0) || !std::isfinite(length))
        return false;
    ContinuationPoint point;
    point.u.assign(u.begin(), u.end());
    for (std::size_t i = 0; i < u.size(); ++i)
        point.u[i] += distance * direction[i] / length;
    std::vector<double> row;
    weigh(direction, row);
    outcome_ = ContinuationOutcome::no_convergence;
    if (!correct(point.u, row, farthest * std::abs(distance), point.iterations))
        return false;
    outcome_ = ContinuationOutcome::singular;
    if (distance < 0)
        for (double& entry : row)
            entry = -entry;
    return find_tangent(point, row) && begin(std::move(point));
}

void Continuation::require_point(std::span<const double> u) const {
    require_size(u.size(), problem_->unknowns(), "unknowns");
    require_finite(u, "an unknown");
}

/// Predicts the point at a distance along the tangent: on the cubic through the last two points and their tangents, if
/// it is close to the tangent itself.
std::vector<double> Continuation::predict(double length) const {
    constexpr double largest_offset = 0.5; // share of the step
    const std::size_t count = point_.u.size();
    std::vector<double> result(count), chord(count);
    for (std::size_t i = 0; i < count; ++i) {
        result[i] = point_.u[i] + length * point_.tangent[i];
        chord[i] = point_.u[i] - previous_.u[i];
    }
    const double last = steps_ == 0 ? 0 : std::sqrt(product(chord, chord));
    if (!(last > 0) || !(length <= growth * last))
        return result;
    std::vector<double> off = on_cubic(previous_, point_, last, 1 + length / last);
    for (std::size_t i = 0; i < count; ++i)
        off[i] -= result[i];
    const double along = product(off, point_.tangent);
    for (std::size_t i = 0; i < count; ++i)
        off[i] -= along * point_.tangent[i];
    if (std::sqrt(product(off, off)) < largest_offset * length)
        for (std::size_t i = 0; i < count; ++i)
            result[i] += off[i];
    return result;
}

bool Continuation::step() {
    if (outcome_ != ContinuationOutcome::going)
        return false;
    if (point_.u.empty())
        throw OrderError("a continuation has no point to step from before it is started");
    bool undefined = false;
    problem_->accept(point_.u);
    double length = std::clamp(next_step_, options_.smallest_step,
                               longest_step(*problem_, previous_, point_, options_.largest_step));
    const double unit = std::sqrt(product(point_.tangent, point_.tangent)); // the scales may have changed
    for (double& entry : point_.tangent)
        entry /= unit;
    std::vector<double> row;
    weigh(point_.tangent, row);
    for (;; length *= shrinkage) {
        if (length < options_.smallest_step) {
            outcome_ = undefined ? ContinuationOutcome::undefined : ContinuationOutcome::no_convergence;
            return false;
        }
        ContinuationPoint next;
        const std::vector<double> predicted = next.u = predict(length);
        if (!correct(next.u, row, largest_correction * length, next.iterations)) {
            undefined = !problem_->evaluate(predicted);
            continue;
        }
        undefined = false;
        if (!find_tangent(next, row))
            continue;
        const double angle = std::acos(std::clamp(product(next.tangent, point_.tangent), -1.0, 1.0));
        if (angle > options_.largest_angle && length > 2 * options_.smallest_step)
            continue;
        next.arclength = point_.arclength + length;
        const double longest = longest_step(*problem_, point_, next, options_.largest_step);
        if (length > options_.largest_step && longest == options_.largest_step) // no longer straight
            continue;
        previous_ = std::move(point_);
        point_ = std::move(next);
        ++steps_;
        const double by_angle = angle > 0 ? 0.7 * options_.largest_angle / angle : growth;
        next_step_ = std::clamp(length * std::clamp(std::min(by_angle, step_growth_), shrinkage, growth),
                                options_.smallest_step, longest);
        if (closes())
            outcome_ = ContinuationOutcome::closed;
        else
            problem_->evaluate(point_.u);
        return true;
    }
}

/// True when the branch has returned to its first point within the last step.
bool Continuation::closes() {
    if (steps_ < 3)
        return false;
    std::vector<double> chord(point_.u.size()), offset(point_.u.size());
    for (std::size_t i = 0; i < chord.size(); ++i) {
        chord[i] = point_.u[i] - previous_.u[i];
        offset[i] = first_.u[i] - previous_.u[i];
    }
    problem_->reduce(offset);
    const double length2 = product(chord, chord), along = product(offset, chord) / length2;
    if (!(along > 0 && along <= 1) || product(offset, offset) > 4 * length2 ||
        product(first_.tangent, point_.tangent) < 0.5 * std::sqrt(product(first_.tangent, first_.tangent)))
        return false;
    ContinuationPoint here;
    if (!between(along, here))
        return false;
    for (std::size_t i = 0; i < offset.size(); ++i)
        offset[i] = here.u[i] - first_.u[i];
    problem_->reduce(offset);
    return std::sqrt(product(offset, offset)) < same_point;
}

bool Continuation::between(double fraction, ContinuationPoint& result) {
    if (steps_ == 0)
        throw OrderError("there are no two points to look between before the first step");
    require_finite(fraction, "the fraction");
    const std::size_t count = point_.u.size();
    const double length = point_.arclength - previous_.arclength;
    std::vector<double> chord(count), row;
    // Predict by the cubic, shifted into the hyperplane.
    const double f = fraction;
    result.u = on_cubic(previous_, point_, length, f);
    for (std::size_t i = 0; i < count; ++i)
        chord[i] = point_.u[i] - previous_.u[i];
    std::vector<double> offset(count);
    for (std::size_t i = 0; i < count; ++i)
        offset[i] = previous_.u[i] + f * chord[i] - result.u[i];
    const double shift = product(offset, chord) / product(chord, chord);
    for (std::size_t i = 0; i < count; ++i)
        result.u[i] += shift * chord[i];
    weigh(chord, row);
    if (!correct(result.u, row, length, result.iterations) || !find_tangent(result, row))
        return false;
    result.arclength = previous_.arclength + f * length;
    return true;
}

} // namespace graze
