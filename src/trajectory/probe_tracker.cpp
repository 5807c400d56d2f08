#include "trajectory/probe_tracker.hpp"

#include "base/special_numbers.hpp"
#include "flow/single_crossing.hpp"
#include "tape/smallest_size.hpp"
#include "trajectory/series.hpp"

#include <algorithm>
#include <cmath>

namespace graze {

ProbeTracker::ProbeTracker(const Simulation& simulation, std::span<const double> phase_values,
                           std::span<const double> periods)
    : simulation_(simulation), phase_values_(phase_values.begin(), phase_values.end()),
      periods_(periods.begin(), periods.end()), roots_(simulation.order()), tracked_(simulation.probes().size()),
      work_(static_cast<std::size_t>(simulation.order()) + 1), gathered_(work_.size()) {
    for (std::size_t p = 0; p < tracked_.size(); ++p) {
        const Probe& probe = simulation.probes()[p];
        if (probe.kind != Probe::Kind::phase) {
            followed_.push_back({probe.kind, probe.direction, simulation.series_of_probe(p)});
            expressions_.push_back(p);
            continue;
        }
        followed_.push_back({probe.kind, Direction::both, probe.state});
        auto phase = std::find_if(phases_.begin(), phases_.end(),
                                  [&](const Phase& known) { return known.state == probe.state; });
        if (phase == phases_.end()) {
            phase = phases_.insert(phase, Phase{probe.state, {}, {}});
            for (std::size_t mode = 0; mode < simulation.model().modes.size(); ++mode) {
                const std::size_t degree = simulation.system().mode(mode).tape.degrees[probe.state];
                phase->sizes.push_back(std::min(work_.size() - 1, degree) + 1);
            }
        }
        phase->probes.push_back(p);
    }
    found_.reserve(16);
    changes_.reserve(16);
    found_roots_.reserve(static_cast<std::size_t>(simulation.order()) + 1);
}

void ProbeTracker::start(std::span<const double> state) {
    arc_start_ = true;
    for (std::size_t p = 0; p < tracked_.size(); ++p) {
        tracked_[p] = {};
        const Probe& probe = simulation_.probes()[p];
        if (probe.kind == Probe::Kind::phase)
            locate(p, state[probe.state]);
    }
}

void ProbeTracker::locate(std::size_t index, double value) {
    bounds_known_ = false;
    const double period = periods_[simulation_.probes()[index].state];
    const double target = phase_values_[index];
    const double slack = roundoff * period;
    Tracked& tracked = tracked_[index];
    const double turns = (value - target) / period;
    tracked.lower = target + std::floor(turns) * period;
    tracked.upper = tracked.lower + period;
    tracked.lower_slack = tracked.upper_slack = 0;
    tracked.on_section = value - tracked.lower <= slack;
    if (tracked.upper - value <= slack) {
        tracked.on_section = true;
        tracked.lower = tracked.upper;
        tracked.upper += period;
    }
}

/// A start on the section is not a passage, in whichever direction the phase moves.
void ProbeTracker::leave_section(std::size_t index, std::span<const double> c, double length) {
    const double period = periods_[simulation_.probes()[index].state];
    const std::size_t leading = leading_index(c, length, roundoff * period);
    if (leading == 0)
        return;
    bounds_known_ = false;
    Tracked& tracked = tracked_[index];
    tracked.on_section = false;
    if (c[leading] > 0) {
        tracked.lower_slack = roundoff * period;
    } else {
        tracked.upper = tracked.lower;
        tracked.lower -= period;
        tracked.upper_slack = roundoff * period;
    }
}

void ProbeTracker::shift(std::size_t state, double shift) {
    bounds_known_ = false;
    for (const Phase& phase : phases_)
        if (phase.state == state)
            for (const std::size_t probe : phase.probes) {
                tracked_[probe].lower += shift;
                tracked_[probe].upper += shift;
            }
}

void ProbeTracker::relocate(std::size_t state, double before, double after) {
    const double period = periods_[state];
    const double turns = std::round((after - before) / period);
    // A jump by whole periods shifts the sections too: a pending passage must be neither lost nor repeated.
    if (std::abs(after - before - turns * period) <= 16 * roundoff * period)
        return shift(state, turns * period);
    for (const Phase& phase : phases_)
        if (phase.state == state)
            for (const std::size_t probe : phase.probes)
                locate(probe, after);
}

void ProbeTracker::cut(const Step& step, double s) {
    bounds_known_ = false;
    for (std::size_t i = changes_.size(); i-- > 0;)
        tracked_[changes_[i].probe] = changes_[i].before;
    for (const Change& one : changes_)
        if ((one.at == unplaced ? place(one.probe, step) : one.at) <= s)
            change(one.probe, one.direction);
}

std::span<const ProbeTracker::Found> ProbeTracker::search(const Step& step) {
    found_.clear();
    changes_.clear();
    if (!bounds_known_)
        find_bounds();
    for (const Phase& phase : phases_) {
        const double* const series = step.states[phase.state].first;
        const double now = series[0], end = now + series[step.states[phase.state].stride] * step.length;
        if (!phase.is_line(step.mode) || !(std::min(now, end) > phase.low && std::max(now, end) < phase.high))
            search_phases(phase, step);
    }
    for (const std::size_t probe : expressions_)
        search_expression(probe, step);
    arc_start_ = false;
    if (found_.size() > 1)
        sort_found();
    return found_;
}

void ProbeTracker::sort_found() {
    const auto is_before = [](const Found& a, const Found& b) {
        return a.at < b.at || (a.at == b.at && a.probe < b.probe);
    };
    if (!std::is_sorted(found_.begin(), found_.end(), is_before)) // sorting allocates memory
        std::stable_sort(found_.begin(), found_.end(), is_before);
}

/// Finds an interval of the phase in which no probe's value is near, with a margin larger than round-off and slack.
/// Outside it, each probe is tested.
void ProbeTracker::find_bounds() {
    for (Phase& phase : phases_) {
        phase.low = -infinity;
        phase.high = infinity;
        for (const std::size_t probe : phase.probes) {
            const Tracked& tracked = tracked_[probe];
            const double margin = 4 * roundoff * (std::abs(tracked.lower) + std::abs(tracked.upper));
            phase.low = std::max(phase.low, tracked.on_section ? infinity : tracked.lower + margin);
            phase.high = std::min(phase.high, tracked.upper - margin);
        }
    }
    bounds_known_ = true;
}

ProbeTracker::Reach ProbeTracker::reach_of_line(double change) {
    const double most = std::abs(change) * (1 + roundoff);
    return {change < 0 ? 0 : most, change > 0 ? 0 : most, most};
}

ProbeTracker::Reach ProbeTracker::reach_of_series(std::span<const double> c, double length) {
    const double most = size_beyond_start(c, length) * (1 + roundoff);
    return {most, most, most};
}

void ProbeTracker::search_phases(const Phase& phase, const Step& step) {
    const std::span<const double> c = without_gaps(step.states[phase.state], phase.sizes[step.mode]);
    const Reach reach = phase.is_line(step.mode) ? reach_of_line(step.states[phase.state][1] * step.length)
                                                 : reach_of_series(c, step.length);
    for (const std::size_t probe : phase.probes)
        if (tracked_[probe].on_section || tracked_[probe].is_near(c[0], reach))
            search_phase(probe, step, c, reach);
}

/// Most steps are excluded by a cheap test.
void ProbeTracker::search_expression(std::size_t probe, const Step& step) {
    const Followed& followed = followed_[probe];
    const std::span<const double> c = without_gaps(step.observed[followed.index], work_.size());
    const bool crossing = followed.kind == Probe::Kind::crossing;
    const roots::ClearSign clear =
        crossing ? roots::clear_sign<false>(c, step.length) : roots::clear_sign<true>(c, step.length);
    if (clear.sign == 0 || clear.sign != tracked_[probe].side)
        search_series(probe, crossing ? c : rate_of(c), step.length, clear);
}

/// Returns the coefficients of the derivative; valid until the next call.
std::span<const double> ProbeTracker::rate_of(std::span<const double> c) {
    for (std::size_t k = 0; k + 1 < c.size(); ++k)
        work_[k] = static_cast<double>(k + 1) * c[k + 1];
    return {work_.data(), c.size() - 1};
}

void ProbeTracker::change(std::size_t index, int direction) {
    const Probe& probe = simulation_.probes()[index];
    Tracked& tracked = tracked_[index];
    if (probe.kind != Probe::Kind::phase) {
        tracked.side = direction;
        return;
    }
    bounds_known_ = false;
    const double period = periods_[probe.state];
    tracked.lower += direction * period;
    tracked.upper += direction * period;
    (direction > 0 ? tracked.lower_slack : tracked.upper_slack) = roundoff * period;
    (direction > 0 ? tracked.upper_slack : tracked.lower_slack) = 0;
}

void ProbeTracker::note(std::size_t probe, double at, int direction, bool at_contact) {
    changes_.push_back({probe, at, direction, tracked_[probe]});
    change(probe, direction);
    if (followed_[probe].wants(direction))
        found_.push_back({probe, at, direction, at_contact});
}

/// A function that starts a step on the other side than it was last known to be has crossed in between, except at the
/// start of an arc: the effect of a jump may be an extremum, but is not a crossing by the motion.
void ProbeTracker::begin_on(int side, std::size_t probe) {
    Tracked& tracked = tracked_[probe];
    if (tracked.side != 0 && side != tracked.side && (!arc_start_ || followed_[probe].kind == Probe::Kind::extremum))
        note(probe, 0, side, arc_start_);
    tracked.side = side;
}

/// @param clear the result of the cheap test
void ProbeTracker::search_series(std::size_t probe, std::span<const double> c, double length, roots::ClearSign clear) {
    // The sign of a function that has decayed, such as exp(-t), is unknown: it is taken to be unchanged.
    if (clear.size < smallest_size)
        return;
    if (clear.sign != 0)
        return begin_on(clear.sign, probe);
    const int now = c[0] > 0 ? 1 : -1;
    const bool as_before = now == tracked_[probe].side;
    if (std::abs(c[0]) <= 2 * roundoff * clear.size) {
        const double noise = roundoff * (std::abs(c[0]) + size_beyond_start(c, length));
        if (std::abs(c[0]) <= noise)
            return search_from_zero(probe, c, length, noise);
    }
    begin_on(now, probe);
    if (const auto single = roots::single_crossing(c, length)) {
        if (single->crosses)
            note(probe, followed_[probe].wants(-now) ? single->place(c, length) : unplaced, -now, false);
    } else if (!as_before || roots::kept_sign(c, length) != now) {
        note_crossings(probe, c, length, RootStart::as_is);
    }
}

/// Searches a function that is zero to within round-off at the beginning of the step.
void ProbeTracker::search_from_zero(std::size_t probe, std::span<const double> c, double length, double noise) {
    const std::size_t leading = leading_index(c, length, noise);
    if (leading == 0)
        return; // zero throughout, to within round-off
    if (const int now = c[0] > 0 ? 1 : -1; now == tracked_[probe].side && roots::kept_sign(c, length) == now)
        return;
    begin_on(c[leading] > 0 ? 1 : -1, probe);
    note_crossings(probe, c.subspan(leading - 1), length, RootStart::deflate);
}

void ProbeTracker::note_crossings(std::size_t probe, std::span<const double> c, double length, RootStart start) {
    roots_.crossings(c, length, start, found_roots_);
    for (const Root& root : found_roots_) {
        const int direction = root.kind == RootKind::rising ? 1 : -1;
        if (direction == tracked_[probe].side)
            continue; // moves away from a zero that was counted already
        note(probe, root.at, direction, false);
    }
}

/// Returns the location of a probe's only crossing within the step just searched.
double ProbeTracker::place(std::size_t probe, const Step& step) {
    const Followed& followed = followed_[probe];
    const std::span<const double> series = without_gaps(step.observed[followed.index], work_.size());
    const std::span<const double> c = followed.kind == Probe::Kind::crossing ? series : rate_of(series);
    const auto single = roots::single_crossing(c, step.length);
    return single ? single->place(c, step.length) : unplaced;
}

std::span<const double> ProbeTracker::gather(const Series& series, std::size_t size) {
    for (std::size_t k = 0; k < size; ++k)
        gathered_[k] = series[k];
    return {gathered_.data(), size};
}

void ProbeTracker::search_phase(std::size_t index, const Step& step, std::span<const double> c, const Reach& reach) {
    Tracked& tracked = tracked_[index];
    if (tracked.on_section) {
        leave_section(index, c, step.length);
        if (tracked.on_section)
            return;
    }
    for (double from = 0; tracked.is_near(c[0], reach);) {
        int direction = 0;
        double at = 0;
        const auto try_target = [&](double offset, int towards) {
            if (std::abs(offset) > reach.most)
                return;
            if (from == 0 && offset * towards >= 0) { // passed between two steps
                direction = towards;
                at = 0;
                return;
            }
            if ((towards > 0 ? reach.up : reach.down) == 0)
                return;
            std::copy(c.begin(), c.end(), work_.begin());
            work_[0] = offset;
            roots_.crossings(std::span(work_).first(c.size()), step.length, RootStart::as_is, found_roots_);
            for (const Root& root : found_roots_)
                if ((root.kind == RootKind::rising) == (towards > 0) && root.at >= from &&
                    (direction == 0 || root.at < at)) {
                    direction = towards;
                    at = root.at;
                    return;
                }
        };
        try_target(tracked.beyond_upper(c[0]), 1);
        if (direction == 0 || at > 0)
            try_target(tracked.beyond_lower(c[0]), -1);
        if (direction == 0)
            break;
        note(index, at, direction, false);
        from = std::max(at, std::numeric_limits<double>::min());
    }
}

} // namespace graze
