#include "branch/locked_curve.hpp"

#include "base/special_numbers.hpp"
#include "orbit/eigen_index.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

namespace graze {

namespace {

constexpr double steps_around = 32;

} // namespace

double LockedCurve::least() const {
    double value = infinity;
    for (const auto* const some : {&points, &extremes})
        for (const LockedPoint& one : *some)
            value = std::min(value, one.parameter);
    return value;
}

double LockedCurve::greatest() const {
    double value = -infinity;
    for (const auto* const some : {&points, &extremes})
        for (const LockedPoint& one : *some)
            value = std::max(value, one.parameter);
    return value;
}

LockedCurveFinder::LockedCurveFinder(const TorusSetting& setting, const Torus& circle, const Resonance& resonance,
                                     double parameter, const ContinuationOptions& options, double tolerance)
    : circle_(circle), resonance_(resonance), parameter_(parameter), tolerance_(tolerance),
      problem_(std::make_shared<LockedOrbitProblem>(setting, resonance.denominator)), options_(options) {
    constexpr int parts = 64;
    const auto q = static_cast<double>(resonance.denominator);
    for (int k = 0; k < parts; ++k)
        length_ +=
            problem_->length_of(problem_->around_circle(circle, k / (q * parts), resonance.numerator)) / (q * parts);
    options_.first_step = options_.largest_step = length_ / steps_around;
    options_.smallest_step = 1e-6 * length_;
    options_.largest_angle = 0.2;
    // Accuracy is relative to the circle, which may be small.
    options_.accuracy = std::clamp(1e-2 * options.accuracy * length_, 1e-15, options.accuracy);
    options_.iterations = 10;
}

/// Starts at the orbit in the plane across a direction, near states on the circle.
bool LockedCurveFinder::start_beside(Continuation& continuation, const std::vector<double>& u,
                                     const std::vector<double>& direction) {
    constexpr double beside = 1e-2, apart = 0.1; // shares of the length of the curve
    const double distance = beside * length_;
    std::vector<double> from = u;
    entries_of(from) -= distance / problem_->length_of(direction) * vector_of(direction);
    if (!continuation.start_along(from, direction, distance))
        return false;
    // Not an orbit of fewer returns, such as that about which the torus lies.
    const auto q = static_cast<double>(resonance_.denominator);
    const std::vector<double>& found = continuation.point().u;
    std::vector<double> off = found;
    entries_of(off) -= vector_of(u);
    off.back() = 0;
    start_offset_ = problem_->length_of(off);
    return problem_->separation(found) > apart * length_ / std::sqrt(q) &&
           start_offset_ < q * length_ / std::numbers::pi;
}

/// Starts at the orbit whose place around the circle is that of an angle.
bool LockedCurveFinder::start(Continuation& continuation, double turns) {
    return start_beside(continuation, problem_->on_circle(circle_, turns, resonance_.numerator, parameter_),
                        problem_->around_circle(circle_, turns, resonance_.numerator));
}

/// Starts at the orbit whose distance from the centre of the circle is that of an angle. Within a tongue only few
/// places around the circle have an orbit near.
bool LockedCurveFinder::start_across(Continuation& continuation, double turns) {
    Torus centre = circle_;
    centre.terms.resize(1);
    const std::vector<double> u = problem_->on_circle(circle_, turns, resonance_.numerator, parameter_);
    std::vector<double> outwards = u;
    entries_of(outwards) -= vector_of(problem_->on_circle(centre, turns, resonance_.numerator, parameter_));
    if (!start_beside(continuation, u, outwards))
        return false;
    const ContinuationPoint found = continuation.point();
    return continuation.start_at(found.u,
                                 problem_->row_of(problem_->around_circle(circle_, turns, resonance_.numerator)));
}

LockedPoint LockedCurveFinder::described(const ContinuationPoint& at) {
    problem_->evaluate(at.u);
    return {at.u, at.tangent, at.arclength, at.u[problem_->parameter_place()], problem_->drift(at.tangent)};
}

std::optional<LockedCurveFinder::Spread> LockedCurveFinder::spread() {
    constexpr int angles = 5;
    Spread result{infinity, -infinity, 0, 0, {}};
    for (int k = 0; k < angles; ++k) {
        Continuation there(problem_, options_);
        if (!start(there, k / (static_cast<double>(angles) * static_cast<double>(resonance_.denominator))))
            return std::nullopt;
        const ContinuationPoint& at = there.point();
        const double parameter = at.u[problem_->parameter_place()], error = problem_->parameter_error(at.tangent);
        result.least = std::min(result.least, parameter);
        result.greatest = std::max(result.greatest, parameter);
        result.round_off = std::max({result.round_off, epsilon * error, epsilon * std::abs(parameter)});
        result.error = std::max({result.error, tolerance_ * error, epsilon * std::abs(parameter)});
        if (!result.orbit)
            result.orbit = described(at);
    }
    return result;
}

/// Returns angles in the order in which the points of the circle are dense: there the motion is slow, and orbits are
/// near.
std::vector<double> LockedCurveFinder::angles_by_slowness() const {
    constexpr int angles = 16;
    std::vector<std::pair<double, double>> found;
    for (int k = 0; k < angles; ++k) {
        const double turns = k / (angles * static_cast<double>(resonance_.denominator));
        found.emplace_back(problem_->length_of(problem_->around_circle(circle_, turns, resonance_.numerator)), turns);
    }
    std::ranges::sort(found);
    std::vector<double> turns;
    for (const auto& one : found)
        turns.push_back(one.second);
    return turns;
}

/// Locates the extreme of the parameter within the last step, by false position with halved weights (Illinois).
void LockedCurveFinder::locate_extreme(Continuation& continuation, LockedCurve& curve) {
    constexpr double enough = 1e-10; // of the step: the parameter is stationary there
    const std::size_t place = problem_->parameter_place();
    double low = 0, high = 1, at_low = continuation.previous().tangent[place],
           at_high = continuation.point().tangent[place];
    int side = 0;
    ContinuationPoint there;
    for (int iteration = 0; iteration < 60 && high - low > enough; ++iteration) {
        const double middle = (low * at_high - high * at_low) / (at_high - at_low);
        if (!continuation.between(middle, there))
            break;
        const double rate = there.tangent[place];
        const bool above = (rate > 0) == (at_high > 0);
        (above ? high : low) = middle;
        (above ? at_high : at_low) = rate;
        if (rate == 0 || (side != 0 && std::abs(rate) < 1e-14 * problem_->scales()[place]))
            break;
        if (above == (side > 0) && side != 0)
            (above ? at_low : at_high) *= 0.5;
        side = above ? 1 : -1;
    }
    if (!there.u.empty())
        curve.extremes.push_back(described(there));
    problem_->evaluate(continuation.point().u);
}

/// True when the last step has come to the first orbit from another return on, which is then the last point.
bool LockedCurveFinder::closes(Continuation& continuation, LockedCurve& curve) {
    constexpr double beside = 0.25; // share of the step
    const ContinuationPoint &before = continuation.previous(), &now = continuation.point();
    std::vector<double> chord = now.u;
    entries_of(chord) -= vector_of(before.u);
    const double square = problem_->product(chord, chord);
    for (std::size_t k = 0; k < resonance_.denominator; ++k) {
        std::vector<double> offset = problem_->later(curve.points.front().u, k);
        entries_of(offset) -= vector_of(before.u);
        const double along = problem_->product(offset, chord) / square;
        entries_of(offset) -= along * vector_of(chord);
        if (!(along > 0 && along <= 1) || problem_->product(offset, offset) > beside * beside * square)
            continue;
        ContinuationPoint there;
        if (!continuation.between(along, there))
            continue;
        curve.shift = k;
        curve.closed = true;
        curve.points.push_back(described(there));
        return true;
    }
    return false;
}

LockedCurve LockedCurveFinder::follow(double farthest) {
    LockedCurve curve = followed(farthest);
    // The next point of the circle is 1/q of a turn further; others are orbits of other rotation numbers. That is seen
    // only where the curve closes, unless the orbit is near those points of the circle from which it was looked for.
    const auto q = static_cast<long>(resonance_.denominator);
    const bool goes_around = ((static_cast<long>(curve.shift) * resonance_.numerator - 1) % q + q) % q == 0 || q == 1;
    if (curve.closed ? !goes_around : !(start_offset_ < length_)) {
        curve.closed = false;
        curve.extremes.clear();
        curve.problem = "orbits that were found do not go around with that rotation number";
    }
    return curve;
}

LockedCurve LockedCurveFinder::followed(double farthest) {
    constexpr std::size_t most_steps = 500, fewest_steps = 4;
    const std::size_t place = problem_->parameter_place();
    LockedCurve curve;
    Continuation continuation(problem_, options_);
    bool found = false;
    for (const bool across : {false, true})
        for (const double turns : angles_by_slowness())
            if (!found)
                found = across ? start_across(continuation, turns) : start(continuation, turns);
    if (!found) {
        curve.problem = "no orbit was found";
        return curve;
    }
    curve.points.push_back(described(continuation.point()));
    while (!curve.closed && continuation.steps() < most_steps) {
        if (!continuation.step()) {
            curve.problem = fmt::format("their curve was lost at {:.10g}", continuation.point().u[place]);
            return curve;
        }
        const ContinuationPoint& now = continuation.point();
        if (!(std::abs(now.u[place] - parameter_) <= farthest)) {
            curve.problem = fmt::format("they go on beyond {:.10g}", now.u[place]);
            return curve;
        }
        if ((continuation.previous().tangent[place] > 0) != (now.tangent[place] > 0))
            locate_extreme(continuation, curve);
        if (continuation.steps() < fewest_steps || !closes(continuation, curve))
            curve.points.push_back(described(now));
    }
    if (!curve.closed)
        curve.problem = "their curve does not close";
    return curve;
}

} // namespace graze
