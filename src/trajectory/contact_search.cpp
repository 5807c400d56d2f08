// The first watched event within a step, its time, and events that come close without happening.

#include "graze/trajectory/trajectory.hpp"

#include "base/special_numbers.hpp"
#include "trajectory/series.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace graze {

namespace {

/// Share of a step after a contact in which events are searched that may be earlier, or simultaneous, once the errors
/// of polynomials have been removed.
constexpr double behind = 1e-4;

/// Largest share of a flight that is attributed to round-off.
constexpr double most_of_flight = 1e-6;

/// Bounds the displacement of a root at s by round-off. Only roots this close are simultaneous; near the end of an
/// accumulation this is far less than the resolution of time.
/// @param left_behind value of the function at the start of an arc that began on its surface
double root_uncertainty(std::span<const double> c, double s, double step, double left_behind) {
    const double uncertain_value = 4 * epsilon * series_size(c, s), rate = std::abs(evaluate_derivative(c, s));
    const double most = 8 * epsilon * step;
    const double by_start = left_behind > 0 ? std::min(left_behind / rate, most_of_flight * s) : 0;
    return (uncertain_value < most * rate ? uncertain_value / rate : most) + by_start;
}

/// Returns the zero of a falling function if it lies after the step by at most `resolution`; negative otherwise.
double zero_just_behind(std::span<const double> c, double step, double resolution) {
    const double value = evaluate_polynomial(c, step), rate = evaluate_derivative(c, step);
    return rate < 0 && value >= 0 && value <= -rate * resolution ? step - value / rate : -1;
}

} // namespace

/// Returns the watched event that happens first within `step`, which is reduced to its time. Roots are compared after
/// they have been moved onto the surfaces: for coinciding surfaces they then differ by round-off only.
std::size_t Trajectory::find_contact(double& step, const StepPreview& preview, std::size_t lane) {
    const auto& mode = *compiled_mode_;
    const double whole = step;
    const bool looked_ahead = whole == preview.length(lane) && whole >= previous_step_;
    double uncertain = 0; // uncertainty of the first root
    std::size_t first = no_event;
    together_.clear();
    for (std::size_t w = 0; w < mode.watched.size(); ++w) {
        Watch& watch = watches_[w];
        if (watch.side == 0)
            continue;
        const std::size_t event = mode.watched[w];
        note_size(w);
        if (looked_ahead && first == no_event && watch.side > 0 && watch.strip == 0 &&
            preview.least(w, lane) > std::max(touch_distance(event, preview.size(w, lane)), least_touch(event)))
            continue;
        Root root{};
        if (!find_fall(w, first == no_event ? whole : std::min(whole, step + std::max(uncertain, behind * whole)),
                       root))
            continue;
        if (root.at > 0)
            root.at = std::min(on_surface(w, root.at), whole);
        const double uncertain_too =
            root_uncertainty(shifted_series(w), root.at, whole, watch.strip == 1 ? std::abs(event_series(w)[0]) : 0);
        if (first != no_event) {
            const double apart = root.at - step;
            double slack = uncertain + uncertain_too;
            if (std::abs(apart) > slack && std::abs(apart) <= behind * whole)
                slack += error_of_root(first, step) + error_of_root(w, root.at);
            if (apart >= -slack) {
                if (apart <= slack)
                    together_.push_back(event);
                continue;
            }
        }
        together_.clear();
        uncertain = uncertain_too;
        first = w;
        step = root.at;
    }
    if (first != no_event && step + uncertain >= whole)
        find_simultaneous(first, step, uncertain);
    if (first == no_event)
        first = passed_with_period(whole, preview, lane);
    // A radicand is often the event function itself, as an indentation to the power 3/2: the contact ends where the
    // series do. Steps approach this point but do not pass it: the last one is followed by at most a few of its
    // lengths.
    const bool at_branch = mode.has_roots && (branch_ahead_ < states_ || whole <= shortest_step());
    for (std::size_t w = 0; first == no_event && at_branch && w < mode.watched.size(); ++w)
        if (const double zero = zero_just_behind(event_series(w), whole, 16 * shortest_step());
            watches_[w].side > 0 && zero >= 0) {
            first = w;
            step = zero;
        }
    if (first == no_event && mode.ends_at_root)
        first = fallen_to_roundoff(step);
    std::stable_sort(touches_.begin(), touches_.end(),
                     [](const Touch& a, const Touch& b) { return a.root.at < b.root.at; });
    return first;
}

/// Where a radicand is the function of an event, steps shrink with it. It is a difference of states, whose last digits
/// change no more when it is near zero: then the event happens. @param step receives the time of its zero
std::size_t Trajectory::fallen_to_roundoff(double& step) {
    const auto& mode = *compiled_mode_;
    for (std::size_t w = 0; w < mode.watched.size(); ++w) {
        const auto c = event_series(w);
        const double time = -c[0] / c[1];
        if (watches_[w].side > 0 && c[0] >= 0 && c[1] < 0 && std::isfinite(time) &&
            c[0] <= roundoff * event_sizes_[mode.watched[w]].terms && time < largest_step_) {
            step = time;
            return w;
        }
    }
    return no_event;
}

/// Adds the events that are simultaneous with a contact at the end of a step but that round-off has put just after it.
/// @param first may become an event that precedes in the order of the mode
void Trajectory::find_simultaneous(std::size_t& first, double step, double uncertain) {
    const auto& watched = compiled_mode_->watched;
    for (std::size_t w = 0; w < watched.size(); ++w) {
        if (w == first || watches_[w].side <= 0 ||
            std::find(together_.begin(), together_.end(), watched[w]) != together_.end())
            continue;
        const auto c = shifted_series(w);
        const double reach = uncertain + root_uncertainty(c, step, step, 0);
        const double value = evaluate_polynomial(c, step), rate = evaluate_derivative(c, step);
        if (!(value > 0 && value + reach * rate <= 0))
            continue;
        together_.push_back(watched[w < first ? first : w]);
        first = std::min(first, w);
    }
}

/// Finds an event at the end of a period, where a cyclic state is reset, that round-off has put just after the step:
/// the next step begins with the next period and would not find it.
std::size_t Trajectory::passed_with_period(double step, const StepPreview& preview, std::size_t lane) {
    constexpr double error = 16 * std::numeric_limits<double>::epsilon(); // error of the state, in periods
    const auto& mode = *compiled_mode_;
    for (const std::size_t i : cyclic_states_) {
        const double end = step == preview.length(lane) ? preview.state(i, lane) : evaluate_state(i, step);
        if (end >= 0 && end < periods_[i])
            continue;
        for (std::size_t w = 0; w < mode.watched.size(); ++w) {
            const auto& states = mode.gradients[w].states;
            const auto at = std::find(states.begin(), states.end(), i);
            if (watches_[w].side <= 0 || at == states.end())
                continue;
            const double value = evaluate_polynomial(event_series(w), step);
            if (!(value >= 0) || !(evaluate_derivative(event_series(w), step) < 0))
                continue;
            for (const std::size_t state : states)
                inputs_[state] = evaluate_state(state, step);
            values_.resize(std::max(mode.events.outputs(), states.size()));
            mode.gradients[w].values.evaluate(inputs_, values_, work_);
            if (value <= error * periods_[i] * std::abs(values_[static_cast<std::size_t>(at - states.begin())]))
                return w;
        }
    }
    return no_event;
}

/// Returns the series of a watched event without the leading zero coefficients at the start of an arc (except one).
std::span<const double> Trajectory::shifted_series(std::size_t w) {
    const auto c = event_series(w);
    return watches_[w].strip > 0 ? c.subspan(static_cast<std::size_t>(watches_[w].strip) - 1) : c;
}

/// Finds where a watched event's function first falls through zero within `length`. Records the touches before.
bool Trajectory::find_fall(std::size_t w, double length, Root& root) {
    const std::size_t event = compiled_mode_->watched[w];
    const Watch& watch = watches_[w];
    const auto c = shifted_series(w);
    const RootStart start = watch.strip > 0 ? RootStart::deflate : RootStart::as_is;
    if (start == RootStart::as_is && watch.side > 0 && c[0] <= 0) {
        // It fell through zero within the round-off between two steps, or touched zero there and rises again.
        const double noise = roundoff * series_size(c, length);
        const std::size_t leading = -c[0] <= noise ? leading_index(c, length, noise) : 0;
        return leading == 0 || c[leading] < 0 ||
               roots_.first_falling(c.subspan(leading - 1), length, RootStart::deflate, root);
    }
    const RootFinder::Enclosure enclosure = RootFinder::enclosure(c, length, start);
    // A deflated polynomial is a rate: use the size of the function itself.
    const double size = start == RootStart::as_is ? enclosure.size : series_size(event_series(w), length);
    const double touch = std::max({touch_distance(event, size), roundoff * size, least_touch(event)});
    if (watch.side > 0 && enclosure.least > (start == RootStart::as_is ? touch : 0)) {
        if (start == RootStart::as_is)
            return false;
        // The function (the deflated one times the time) may be as small as a touch for a short time after the start;
        // while it rises there is no touch.
        const double small = std::min(touch / enclosure.least, length);
        if (RootFinder::trend(c, small) > 0)
            return false;
    }
    found_touches_.clear();
    const bool found = roots_.first_falling(c, length, start, root, touch, &found_touches_);
    if (watch.strip <= 1)
        keep_touches(w, c);
    return found;
}

/// Keeps those minima that are touches: enclosures have overestimated the size of the function.
void Trajectory::keep_touches(std::size_t w, std::span<const double> c) {
    const std::size_t event = compiled_mode_->watched[w];
    const bool barrier = simulation_.model().events[event].kind == EventKind::barrier;
    for (const Root& touch : found_touches_) {
        double largest = 0;
        constexpr int samples = 16;
        for (int i = 0; i < samples; ++i)
            largest = std::max(largest, std::abs(evaluate_polynomial(c, touch.at * i / samples)));
        const bool grazing = touch.value <= roundoff * series_size(c, touch.at);
        const bool close = touch.value <= touch_distance(event, largest) ||
                           touch.value <= std::max(2 * RootFinder::resolution(c, touch.at), least_touch(event));
        if ((barrier && close) || grazing)
            touches_.push_back({w, touch, grazing});
    }
}

/// Updates the size of a watched event's function between steps of an arc: the maximum between two steps is that of the
/// quintic polynomial that agrees with value, slope and curvature at both.
void Trajectory::note_size(std::size_t w) {
    EventSize& size = event_sizes_[compiled_mode_->watched[w]];
    const Series& c = series_[states_ + w];
    const double value = c[0], rate = c[1], length = time_ - size.time;
    size.of_arc = std::max(size.of_arc, std::abs(value));
    if (size.rate * rate < 0 && std::abs(size.value) + std::abs(size.rate) * length > size.largest) {
        const double a = size.rate * length, b = size.half_second * length * length;
        const double rise = value - size.value - a - b, slope = rate * length - a - 2 * b,
                     bend = c[2] * length * length - b;
        const std::array<double, 6> quintic{size.value,
                                            a,
                                            b,
                                            10 * rise - 4 * slope + bend,
                                            -15 * rise + 7 * slope - 2 * bend,
                                            6 * rise - 3 * slope + bend};
        constexpr int samples = 16;
        for (int i = 1; i < samples; ++i) {
            double there = 0;
            for (std::size_t k = quintic.size(); k-- > 0;)
                there = there * (i / double(samples)) + quintic[k];
            size.largest = std::max(size.largest, std::abs(there));
        }
    }
    size.largest = std::max(size.largest, std::abs(value));
    size.time = time_;
    size.value = value;
    size.rate = rate;
    size.half_second = c[2];
}

/// Returns the largest minimum that counts as a touch, for the present size of the function.
double Trajectory::touch_distance(std::size_t event, double size) const {
    const SimulationOptions& options = simulation_.options();
    return options.touch > 0 ? options.touch : 100 * options.tolerance * std::max(event_sizes_[event].largest, size);
}

/// Returns the minimum below which a touch is always reported: the round-off of the function's cancelling terms.
double Trajectory::least_touch(std::size_t event) const {
    return 4 * std::numeric_limits<double>::epsilon() * event_sizes_[event].terms;
}

/// Returns whether a contact at s is at zero speed to within round-off: the motion would pass the surface by less than
/// the uncertainty. Derivatives do not exist there.
bool Trajectory::is_grazing(std::size_t w, double s, double rate) {
    const auto c = event_series(w);
    if (std::abs(rate) * previous_step_ <= roundoff * series_size(c, previous_step_))
        return true;
    // A flight that leaves the surface and returns is known relative to its own height.
    const EventSize& sizes = event_sizes_[compiled_mode_->watched[w]];
    const double noise = roundoff * std::max({sizes.of_arc, series_size(c, s), sizes.left_surface ? 0 : sizes.terms});
    double second = 0;
    for (std::size_t k = c.size(); k-- > 2;)
        second = second * s + static_cast<double>(k * (k - 1)) * c[k];
    return rate * rate <= 2 * std::abs(second) * noise;
}

/// Moves a root of the event polynomial onto the surface itself: the truncation errors of the polynomials of event and
/// states displace it by about the tolerance. Since many events may have roots in one step, only the states on which
/// this event depends are evaluated.
double Trajectory::on_surface(std::size_t w, double s) {
    const auto c = event_series(w);
    const Function& event = simulation_.system().event(compiled_mode_->watched[w]);
    values_.resize(event.outputs());
    for (int sweep = 0; sweep < 2; ++sweep) {
        for (const std::size_t i : compiled_mode_->gradients[w].states)
            inputs_[i] = evaluate_state(i, s);
        event.evaluate(inputs_, values_, work_);
        const double value = values_[0], rate = evaluate_derivative(c, s);
        // Newton's method is safe only far from the double root of a tangential contact.
        if (!(4 * std::abs(value * c[2]) < rate * rate))
            return s;
        s = std::max(0.0, s - value / rate);
    }
    return s;
}

/// Returns the displacement of a root at s by round-off inside an event's function, as in exp(x) - 1.
double Trajectory::error_of_root(std::size_t w, double s) {
    const Function& event = simulation_.system().event(compiled_mode_->watched[w]);
    values_.resize(event.outputs());
    for (const std::size_t i : compiled_mode_->gradients[w].states)
        inputs_[i] = evaluate_state(i, s);
    std::fill(uncertain_.begin(), uncertain_.end(), 0.0);
    event.error_bounds(inputs_, uncertain_, values_, work_);
    const double error = values_[0] / std::abs(evaluate_derivative(event_series(w), s)), most = most_of_flight * s;
    return error < most ? error : most;
}

void Trajectory::update_sides(double length) {
    const auto& mode = *compiled_mode_;
    for (std::size_t w = 0; w < mode.watched.size(); ++w) {
        Watch& watch = watches_[w];
        watch.strip = 0;
        if (watch.side > 0)
            continue; // a fall would have been found; within round-off of zero the next step decides
        const double value = evaluate_polynomial(event_series(w), length);
        const bool barrier = simulation_.model().events[mode.watched[w]].kind == EventKind::barrier;
        if (value > 0)
            watch.side = 1;
        else if (watch.side == 0 && std::abs(value) > roundoff * series_size(event_series(w), length))
            watch.side = barrier ? 1 : -1; // the motion has left the surface: for a barrier, a contact at once
    }
}

} // namespace graze
