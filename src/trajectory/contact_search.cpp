// Which watched event happens first within a step, when exactly, and which come close without happening.

#include "graze/trajectory/trajectory.hpp"

#include "trajectory/series.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace graze {

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

/// How far round-off may have moved a root at s. Only what lies as close is simultaneous, which near the end of an
/// accumulation is far less than the resolution of time.
double root_uncertainty(std::span<const double> c, double s, double step) {
    constexpr double epsilon = std::numeric_limits<double>::epsilon();
    const double uncertain_value = 4 * epsilon * series_size(c, s), rate = std::abs(evaluate_derivative(c, s));
    const double most = 8 * epsilon * step;
    return uncertain_value < most * rate ? uncertain_value / rate : most;
}

} // namespace

/// The watched event that happens first within `step`, which becomes the time until then.
std::size_t Trajectory::find_contact(double& step, const Outlook& outlook, std::size_t lane) {
    const auto& mode = simulation_->compiled().mode(mode_);
    const double whole = step;
    const bool looked_ahead = whole == outlook.length(lane) && whole >= previous_step_;
    double uncertain = 0; // of the first root
    std::size_t first = no_event;
    together_.clear();
    for (std::size_t w = 0; w < mode.watched.size(); ++w) {
        Watch& watch = watches_[w];
        if (watch.side == 0)
            continue;
        const std::size_t event = mode.watched[w];
        if (looked_ahead && first == no_event && watch.side > 0 && watch.strip == 0 &&
            outlook.least(w, lane) > touch_distance(event, outlook.size(w, lane)))
            continue;
        Root root{};
        if (!find_fall(w, whole, std::min(whole, step + uncertain), root))
            continue;
        const double uncertain_too = root_uncertainty(shifted_series(w), root.at, whole);
        if (first != no_event && root.at >= step - (uncertain + uncertain_too)) {
            together_.push_back(event); // the search ended just behind the first
            continue;
        }
        together_.clear();
        uncertain = uncertain_too;
        first = w;
        step = root.at;
    }
    if (first != no_event && step > 0)
        step = std::min(on_surface(first, step), whole);
    std::stable_sort(touches_.begin(), touches_.end(),
                     [](const Touch& a, const Touch& b) { return a.root.at < b.root.at; });
    return first;
}

/// The series of a watched event, without the factors that are zero at the start of an arc (but for one).
std::span<const double> Trajectory::shifted_series(std::size_t w) {
    const auto c = event_series(w);
    return watches_[w].strip > 0 ? c.subspan(static_cast<std::size_t>(watches_[w].strip) - 1) : c;
}

/// Where a watched event's function first falls through zero within `length`, of a step of length `whole`. Notes the
/// touches before.
bool Trajectory::find_fall(std::size_t w, double whole, double length, Root& root) {
    const std::size_t event = simulation_->compiled().mode(mode_).watched[w];
    const Watch& watch = watches_[w];
    const auto c = shifted_series(w);
    const RootStart start = watch.strip > 0 ? RootStart::deflate : RootStart::as_is;
    if (start == RootStart::as_is && watch.side > 0 && c[0] <= 0) {
        // It fell through zero in the round-off between two steps, or has touched zero there and rises again.
        const double noise = roundoff * series_size(c, length);
        const std::size_t leading = -c[0] <= noise ? leading_index(c, length, noise) : 0;
        return leading == 0 || c[leading] < 0 ||
               roots_.first_falling(c.subspan(leading - 1), length, RootStart::deflate, root);
    }
    const RootFinder::Enclosure enclosure = RootFinder::enclosure(c, length, start);
    // A deflated polynomial is a rate: its size is none of the function's.
    const bool whole_function = start == RootStart::as_is && !(whole < previous_step_);
    const double touch = touch_distance(
        event, whole_function ? enclosure.size : series_size(event_series(w), std::max(length, previous_step_)));
    // The deflated polynomial is positive where the polynomial itself may be as small as a touch.
    if (watch.side > 0 && enclosure.least > (start == RootStart::as_is ? touch : infinity))
        return false;
    found_touches_.clear();
    const bool found = roots_.first_falling(c, length, start, root, touch, &found_touches_);
    if (simulation_->model().events[event].kind == EventKind::barrier && watch.strip <= 1)
        for (const Root& found_touch : found_touches_)
            touches_.push_back({w, found_touch});
    return found;
}

/// How close to zero a minimum is a touch. The size of an event's function is the greatest that its series has had.
double Trajectory::touch_distance(std::size_t event, double size) {
    const SimulationOptions& options = simulation_->options();
    event_sizes_[event] = std::max(event_sizes_[event], size);
    return options.touch > 0 ? options.touch : 100 * options.tolerance * event_sizes_[event];
}

/// Moves a root of the event polynomial onto the surface itself, from which the truncation of the polynomials of
/// event and states may keep it by something like the tolerance.
double Trajectory::on_surface(std::size_t w, double s) {
    const auto c = event_series(w);
    const auto& events = simulation_->compiled().mode(mode_).events;
    values_.resize(events.outputs());
    for (int sweep = 0; sweep < 2; ++sweep) {
        for (std::size_t i = 0; i < states_; ++i)
            inputs_[i] = evaluate_state(i, s);
        events.evaluate(inputs_, values_, work_);
        const double rate = evaluate_derivative(c, s);
        // Newton's method is safe only well away from the double root of a tangential contact.
        if (!(4 * std::abs(values_[w] * c[2]) < rate * rate))
            return s;
        s = std::max(0.0, s - values_[w] / rate);
    }
    return s;
}

void Trajectory::update_sides(double length) {
    const auto& mode = simulation_->compiled().mode(mode_);
    for (std::size_t w = 0; w < mode.watched.size(); ++w) {
        Watch& watch = watches_[w];
        watch.strip = 0;
        if (watch.side > 0)
            continue; // had it fallen, it would have been found; within round-off of zero the next step decides
        const double value = evaluate_polynomial(event_series(w), length);
        const bool barrier = simulation_->model().events[mode.watched[w]].kind == EventKind::barrier;
        if (value > 0)
            watch.side = 1;
        else if (watch.side == 0 && std::abs(value) > roundoff * series_size(event_series(w), length))
            watch.side = barrier ? 1 : -1; // left the surface it moved along: for a barrier, a contact at once
    }
}

} // namespace graze
