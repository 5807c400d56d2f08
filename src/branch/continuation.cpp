#include "graze/branch/continuation.hpp"

#include "base/enumerator_name.hpp"
#include "branch/longest_step.hpp"
#include "graze/base/input_error.hpp"
#include "graze/base/require.hpp"
#include "orbit/eigen_index.hpp"
#include "orbit/newton.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace graze {

namespace {

constexpr double step_growth = 2, shrinkage = 0.5;
/// Corrections longer than this share of the step may lead onto another branch and are rejected.
constexpr double largest_correction = 0.5;
/// Largest correction of the first point on another branch, relative to its distance: branches may cross obliquely.
constexpr double farthest_correction = 1e3;
/// Steps whose convergence takes more iterations than this are followed by smaller ones.
constexpr std::size_t good_iterations = 3;
/// Distance to the first point, in scaled unknowns, below which a branch counts as closed.
constexpr double same_point = 1e-6;

/// Returns a point of the cubic Hermite interpolant of two points and their tangents: f = 0 at the first, 1 at the
/// second.
/// @param length between them
std::vector<double> on_cubic(const ContinuationPoint& first, const ContinuationPoint& second, double length, double f) {
    const double g = 1 - f;
    return numbers_of(g * g * (1 + 2 * f) * vector_of(first.u) + f * f * (3 - 2 * f) * vector_of(second.u) +
                      length * f * g * (g * vector_of(first.tangent) - f * vector_of(second.tangent)));
}

std::vector<double> difference(std::span<const double> one, std::span<const double> other) {
    return numbers_of(vector_of(one) - vector_of(other));
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
    constexpr std::string_view names[] = {"going", "closed", "no convergence", "undefined", "singular"};
    return enumerator_name(names, outcome, "");
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

/// Scales a tangent to unit length.
void Continuation::normalise(std::vector<double>& tangent) const {
    entries_of(tangent) /= problem_->length_of(tangent);
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
    double before = 0;
    for (iterations = 1; iterations <= options_.iterations; ++iterations) {
        if (!problem_->evaluate(u) || !problem_->solve(row, 0, false, step_, nullptr))
            return false;
        entries_of(u) += vector_of(step_);
        const double size = size_of(step_);
        if (!std::isfinite(size) || problem_->length_of(difference(u, begin)) > allowed)
            return false;
        // Newton's method converges quadratically, so this correction was the last. A small one that is not smaller
        // than the one before is round-off.
        constexpr double least_round_off = 1e-11;
        const double round_off = std::max(least_round_off, problem_->round_off());
        const bool small = size < options_.accuracy || (iterations > 2 && size < round_off && size > 0.5 * before);
        if (small || (iterations > 1 && size < 0.1 * before && size * size < options_.accuracy * 1e-4)) {
            step_growth_ = iterations <= good_iterations ? step_growth : shrinkage;
            if (!problem_->evaluate(u))
                return false;
            if (small)
                return true;
            // For strongly expanding orbits the flow is less accurate than required and depends on the integration
            // steps: one more correction finds the solution for the current steps.
            const double left = problem_->solve(row, 0, false, step_, nullptr) ? size_of(step_) : 0;
            if (!(left > options_.accuracy && left <= before))
                return true;
            entries_of(u) += vector_of(step_);
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
    std::vector<double> step(u.size());
    double before = 0;
    bool quick = true;
    corrections_.clear();
    for (iterations = 1;; ++iterations) {
        const bool first = renewed && iterations == 1;
        if (iterations > most || (first && !problem_->evaluate(u)) ||
            !(first ? problem_->solve(row, 0, false, step, nullptr) : problem_->chord(u, row, step)))
            return false;
        accelerate(step);
        entries_of(u) += vector_of(step);
        const double size = size_of(step);
        if (!std::isfinite(size) || problem_->length_of(difference(u, begin)) > allowed)
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
        step_growth_ = quick ? step_growth : shrinkage;
    else if (!renewed) // additional corrections cost less than a shorter step
        step_growth_ = iterations <= few ? step_growth : 1;
    else // the derivatives of the last point were too inaccurate
        step_growth_ = quick ? 1 : shrinkage;
    if (!problem_->evaluate(u) || !problem_->solve(row, 0, false, step_, nullptr))
        return false;
    const double last = size_of(step_);
    if (last > options_.accuracy)
        return false;
    if (last < enough * options_.accuracy)
        return true;
    entries_of(u) += vector_of(step_);
    return problem_->evaluate(u);
}

/// Applies the Broyden updates of the previous corrections to the next one (as in C. T. Kelley, "Solving Nonlinear
/// Equations with Newton's Method", SIAM 2003, chapter 4).
void Continuation::accelerate(std::vector<double>& step) const {
    for (std::size_t j = 0; j < corrections_.size(); ++j) {
        const std::vector<double>& one = corrections_[j];
        const double share = problem_->product(one, step) / problem_->product(one, one);
        if (j + 1 == corrections_.size())
            entries_of(step) /= 1 - share;
        else
            entries_of(step) += share * vector_of(corrections_[j + 1]);
    }
}

/// Computes the tangent at the point of the last evaluation, oriented by the row.
bool Continuation::find_tangent(ContinuationPoint& point, std::span<const double> row) {
    point.tangent.resize(point.u.size());
    if (!problem_->solve(row, 1, true, point.tangent, &point.determinant))
        return false;
    const double length = problem_->length_of(point.tangent);
    if (!(length > 0) || !std::isfinite(length))
        return false;
    entries_of(point.tangent) /= length;
    // By Cramer's rule this is the determinant bordered by the tangent instead of the row.
    point.determinant *= length;
    return true;
}

bool Continuation::begin(ContinuationPoint point) {
    point.arclength = 0;
    problem_->accept(point.u);
    normalise(point.tangent); // the scales may have changed
    point_ = previous_ = first_ = std::move(point);
    steps_ = 0;
    outcome_ = ContinuationOutcome::going;
    return true;
}

bool Continuation::start(std::span<const double> u, std::size_t unknown, int direction) {
    ContinuationPoint point = point_at(u);
    require_index(unknown, u.size(), "unknown");
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
    ContinuationPoint point = point_at(u);
    if (!problem_->evaluate(point.u) || !find_tangent(point, generic_row()))
        return false;
    std::vector<double> across = problem_->row_of(point.tangent);
    constexpr double near = 0.1;
    if (!correct(point.u, across, near, point.iterations) || !problem_->evaluate(point.u))
        return false;
    outcome_ = ContinuationOutcome::singular;
    const double rise = point.tangent[unknown] * direction;
    if (rise < 0 || (rise == 0 && direction < 0)) // where the unknown is constant, the two directions must be opposite
        entries_of(across) *= -1;
    return find_tangent(point, across) && begin(std::move(point));
}

bool Continuation::start_at(std::span<const double> u, std::span<const double> row) {
    ContinuationPoint point = point_at(u);
    require_size(row.size(), u.size(), "numbers of a row");
    require_finite(row, "a number of a row");
    outcome_ = ContinuationOutcome::undefined;
    if (!problem_->evaluate(point.u))
        return false;
    outcome_ = ContinuationOutcome::singular;
    return find_tangent(point, row) && begin(std::move(point));
}

bool Continuation::start_along(std::span<const double> u, std::span<const double> direction, double distance) {
    ContinuationPoint point = point_at(u);
    require_size(direction.size(), u.size(), "numbers of a direction");
    require_finite(direction, "a number of a direction");
    require_finite(distance, "the distance");
    const double length = problem_->length_of(direction);
    outcome_ = ContinuationOutcome::singular;
    if (!(length > 0) || !std::isfinite(length))
        return false;
    entries_of(point.u) += distance * vector_of(direction) / length;
    std::vector<double> row = problem_->row_of(direction);
    outcome_ = ContinuationOutcome::no_convergence;
    if (!correct(point.u, row, farthest_correction * std::abs(distance), point.iterations))
        return false;
    outcome_ = ContinuationOutcome::singular;
    if (distance < 0)
        entries_of(row) *= -1;
    return find_tangent(point, row) && begin(std::move(point));
}

ContinuationPoint Continuation::point_at(std::span<const double> u) const {
    require_size(u.size(), problem_->unknowns(), "unknowns");
    require_finite(u, "an unknown");
    ContinuationPoint point;
    point.u.assign(u.begin(), u.end());
    return point;
}

/// Predicts the point at a distance along the tangent: on the cubic through the last two points and their tangents, if
/// it is close to the tangent itself.
std::vector<double> Continuation::predict(double length) const {
    constexpr double largest_offset = 0.5; // share of the step
    std::vector<double> result = numbers_of(vector_of(point_.u) + length * vector_of(point_.tangent));
    const double last = steps_ == 0 ? 0 : problem_->length_of(difference(point_.u, previous_.u));
    if (!(last > 0) || !(length <= step_growth * last))
        return result;
    std::vector<double> off = difference(on_cubic(previous_, point_, last, 1 + length / last), result);
    entries_of(off) -= problem_->product(off, point_.tangent) * vector_of(point_.tangent);
    if (problem_->length_of(off) < largest_offset * length)
        entries_of(result) += vector_of(off);
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
    normalise(point_.tangent); // the scales may have changed
    const std::vector<double> row = problem_->row_of(point_.tangent);
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
        const double angle = std::acos(std::clamp(problem_->product(next.tangent, point_.tangent), -1.0, 1.0));
        if (angle > options_.largest_angle && length > 2 * options_.smallest_step)
            continue;
        next.arclength = point_.arclength + length;
        const double longest = longest_step(*problem_, point_, next, options_.largest_step);
        if (length > options_.largest_step && longest == options_.largest_step) // no longer straight
            continue;
        previous_ = std::move(point_);
        point_ = std::move(next);
        ++steps_;
        const double by_angle = angle > 0 ? 0.7 * options_.largest_angle / angle : step_growth;
        next_step_ = std::clamp(length * std::clamp(std::min(by_angle, step_growth_), shrinkage, step_growth),
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
    const std::vector<double> chord = difference(point_.u, previous_.u);
    std::vector<double> offset = difference(first_.u, previous_.u);
    problem_->reduce(offset);
    const double length2 = problem_->product(chord, chord), along = problem_->product(offset, chord) / length2;
    if (!(along > 0 && along <= 1) || problem_->product(offset, offset) > 4 * length2 ||
        problem_->product(first_.tangent, point_.tangent) < 0.5 * problem_->length_of(first_.tangent))
        return false;
    ContinuationPoint here;
    if (!between(along, here))
        return false;
    offset = difference(here.u, first_.u);
    problem_->reduce(offset);
    return problem_->length_of(offset) < same_point;
}

/// Predicts the solution at a fraction of the step by a cubic through two solutions and their tangents: the ends, or
/// the nearest known solution and another that is not nearer to it than the place itself.
std::vector<double> Continuation::guess_between(double fraction, std::span<const double> chord,
                                                std::span<const ContinuationPoint> known) const {
    const double length = point_.arclength - previous_.arclength, square = problem_->product(chord, chord);
    const auto place = [&](const ContinuationPoint* one) { return (one->arclength - previous_.arclength) / length; };
    const auto distance = [&](const ContinuationPoint* one) { return std::abs(place(one) - fraction); };
    std::vector<const ContinuationPoint*> all{&previous_, &point_};
    for (const ContinuationPoint& one : known)
        all.push_back(&one);
    const ContinuationPoint* const nearest = *std::ranges::min_element(all, {}, distance);
    std::erase_if(all, [&](const ContinuationPoint* one) {
        return one == nearest || std::abs(place(one) - place(nearest)) < distance(nearest);
    });
    if (problem_->has_chords() || known.empty() || all.empty()) // corrections by chords cost little
        return on_cubic(previous_, point_, length, fraction);
    const ContinuationPoint* const other = *std::ranges::min_element(all, {}, distance);
    // Rates per fraction: the hyperplanes are orthogonal to the chord.
    constexpr double least = 0.1; // cosine of the angle between a tangent and the chord
    const double along_nearest = problem_->product(nearest->tangent, chord),
                 along_other = problem_->product(other->tangent, chord);
    if (!(std::min(along_nearest, along_other) > least * std::sqrt(square)))
        return on_cubic(previous_, point_, length, fraction);
    const double part = place(other) - place(nearest);
    const ContinuationPoint first{nearest->u, numbers_of(square / along_nearest * vector_of(nearest->tangent))},
        second{other->u, numbers_of(square / along_other * vector_of(other->tangent))};
    return on_cubic(first, second, part, (fraction - place(nearest)) / part);
}

bool Continuation::between(double fraction, ContinuationPoint& result, std::span<const ContinuationPoint> known) {
    if (steps_ == 0)
        throw OrderError("there are no two points to look between before the first step");
    require_finite(fraction, "the fraction");
    const double length = point_.arclength - previous_.arclength;
    const std::vector<double> chord = difference(point_.u, previous_.u), row = problem_->row_of(chord);
    result.u = guess_between(fraction, chord, known);
    // Shift it into the hyperplane.
    const std::vector<double> offset =
        numbers_of(vector_of(previous_.u) + fraction * vector_of(chord) - vector_of(result.u));
    entries_of(result.u) += problem_->product(offset, chord) / problem_->product(chord, chord) * vector_of(chord);
    if (!correct(result.u, row, length, result.iterations) || !find_tangent(result, row))
        return false;
    result.arclength = previous_.arclength + fraction * length;
    return true;
}

} // namespace graze
