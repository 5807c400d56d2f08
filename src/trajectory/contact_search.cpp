// Which watched event happens first within a step, when exactly, and which come close without happening.

#include "graze/trajectory/trajectory.hpp"

#include "trajectory/series.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace graze {

namespace {

/// Share of a step behind a contact in which others are sought that may come before it, or at the same time, once the
/// errors of polynomials have been removed.
constexpr double behind = 1e-4;

/// Share of a flight that is never put down to round-off.
constexpr double most_of_flight = 1e-6;

/// How far round-off may have moved a root at s. Only what lies as close is simultaneous, which near the end of an
/// accumulation is far less than the resolution of time.
/// @param left_behind what the function was at the start of an arc that began on its surface
double root_uncertainty(std::span<const double> c, double s, double step, double left_behind) {
    constexpr double epsilon = std::numeric_limits<double>::epsilon();
    const double uncertain_value = 4 * epsilon * series_size(c, s), rate = std::abs(evaluate_derivative(c, s));
    const double most = 8 * epsilon * step;
    const double by_start = left_behind > 0 ? std::min(left_behind / rate, most_of_flight * s) : 0;
    return (uncertain_value < most * rate ? uncertain_value / rate : most) + by_start;
}

/// Where a function that falls reaches zero, if that lies behind a step by no more than `resolution`; negative
/// otherwise.
double zero_just_behind(std::span<const double> c, double step, double resolution) {
    const double value = evaluate_polynomial(c, step), rate = evaluate_derivative(c, step);
    return rate < 0 && value >= 0 && value <= -rate * resolution ? step - value / rate : -1;
}

} // namespace

/// The watched event that happens first within `step`, which becomes the time until then. Roots are compared when they
/// have been moved onto the surfaces themselves: those of surfaces that coincide then differ by round-off alone.
std::size_t Trajectory::find_contact(double& step, const Outlook& outlook, std::size_t lane) {
    const auto& mode = *compiled_mode_;
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
        note_size(w);
        if (looked_ahead && first == no_event && watch.side > 0 && watch.strip == 0 &&
            outlook.least(w, lane) > std::max(touch_distance(event, outlook.size(w, lane)), least_touch(event)))
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
        look_beyond(first, step, uncertain);
    if (first == no_event)
        first = passed_with_period(whole, outlook, lane);
    // What stands under a root is often what an event watches, as an indentation to the power 3/2: the contact ends
    // where the series do. Steps go there, but not beyond: the last leaves a few of its lengths.
    const bool at_branch = mode.has_roots && (branch_ahead_ < states_ || whole <= shortest_step());
    for (std::size_t w = 0; first == no_event && at_branch && w < mode.watched.size(); ++w)
        if (const double zero = zero_just_behind(event_series(w), whole, 16 * shortest_step());
            watches_[w].side > 0 && zero >= 0) {
            first = w;
            step = zero;
        }
    std::stable_sort(touches_.begin(), touches_.end(),
                     [](const Touch& a, const Touch& b) { return a.root.at < b.root.at; });
    return first;
}

/// A contact at the end of a step has those at its time which round-off has put just behind.
/// @param first may become one that comes before in the order of the mode
void Trajectory::look_beyond(std::size_t& first, double step, double uncertain) {
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

/// A state that is set back where a step ends, at the end of its period, may have an event there that round-off has put
/// just behind: the next step begins with the next period and would not see it.
std::size_t Trajectory::passed_with_period(double step, const Outlook& outlook, std::size_t lane) {
    constexpr double error = 16 * std::numeric_limits<double>::epsilon(); // of the state, in periods
    const auto& mode = *compiled_mode_;
    for (const std::size_t i : cyclic_states_) {
        const double end = step == outlook.length(lane) ? outlook.state(i, lane) : evaluate_state(i, step);
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

/// The series of a watched event, without the factors that are zero at the start of an arc (but for one).
std::span<const double> Trajectory::shifted_series(std::size_t w) {
    const auto c = event_series(w);
    return watches_[w].strip > 0 ? c.subspan(static_cast<std::size_t>(watches_[w].strip) - 1) : c;
}

/// Where a watched event's function first falls through zero within `length`. Notes the
/// touches before.
bool Trajectory::find_fall(std::size_t w, double length, Root& root) {
    const std::size_t event = compiled_mode_->watched[w];
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
    const double size = start == RootStart::as_is ? enclosure.size : series_size(event_series(w), length);
    const double touch = std::max({touch_distance(event, size), roundoff * size, least_touch(event)});
    if (watch.side > 0 && enclosure.least > (start == RootStart::as_is ? touch : 0)) {
        if (start == RootStart::as_is)
            return false;
        // The function itself, as much larger as time goes on, may be as small as a touch for a short time; but while
        // it rises it touches nothing.
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

/// Of the minima that may be touches those that are: enclosures have overrated how large the function is.
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

/// Keeps account of the size of a watched event's function, from one step of an arc to the next: a maximum between them
/// is where the polynomial of degree 5 has it that agrees with value, slope and curvature at both.
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

/// How close to zero a minimum is a touch, of a function that is now of this size.
double Trajectory::touch_distance(std::size_t event, double size) const {
    const SimulationOptions& options = simulation_.options();
    return options.touch > 0 ? options.touch : 100 * options.tolerance * std::max(event_sizes_[event].largest, size);
}

/// What cannot be told from zero, because of what cancels in an event's function, is a touch in any case.
double Trajectory::least_touch(std::size_t event) const {
    return 4 * std::numeric_limits<double>::epsilon() * event_sizes_[event].terms;
}

/// Whether a contact at s is one without speed, to within round-off: the motion would go no deeper beyond the surface
/// than nobody can tell. Derivatives do not exist there.
bool Trajectory::is_grazing(std::size_t w, double s, double rate) {
    const auto c = event_series(w);
    if (std::abs(rate) * previous_step_ <= roundoff * series_size(c, previous_step_))
        return true;
    // A flight that leaves the surface and comes back is known relative to its own height.
    const EventSize& sizes = event_sizes_[compiled_mode_->watched[w]];
    const double noise = roundoff * std::max({sizes.of_arc, series_size(c, s), sizes.left_surface ? 0 : sizes.terms});
    double second = 0;
    for (std::size_t k = c.size(); k-- > 2;)
        second = second * s + static_cast<double>(k * (k - 1)) * c[k];
    return rate * rate <= 2 * std::abs(second) * noise;
}

/// Moves a root of the event polynomial onto the surface itself, from which the truncation of the polynomials of
/// event and states may keep it by something like the tolerance. There may be many events with roots in one step: only
/// the states on which this one depends are looked at.
double Trajectory::on_surface(std::size_t w, double s) {
    const auto c = event_series(w);
    const Function& event = simulation_.system().event(compiled_mode_->watched[w]);
    values_.resize(event.outputs());
    for (int sweep = 0; sweep < 2; ++sweep) {
        for (const std::size_t i : compiled_mode_->gradients[w].states)
            inputs_[i] = evaluate_state(i, s);
        event.evaluate(inputs_, values_, work_);
        const double value = values_[0], rate = evaluate_derivative(c, s);
        // Newton's method is safe only well away from the double root of a tangential contact.
        if (!(4 * std::abs(value * c[2]) < rate * rate))
            return s;
        s = std::max(0.0, s - value / rate);
    }
    return s;
}

/// How far round-off within an event's function, as in exp(x) - 1, may move its root at s.
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
            continue; // had it fallen, it would have been found; within round-off of zero the next step decides
        const double value = evaluate_polynomial(event_series(w), length);
        const bool barrier = simulation_.model().events[mode.watched[w]].kind == EventKind::barrier;
        if (value > 0)
            watch.side = 1;
        else if (watch.side == 0 && std::abs(value) > roundoff * series_size(event_series(w), length))
            watch.side = barrier ? 1 : -1; // left the surface it moved along: for a barrier, a contact at once
    }
}

} // namespace graze
