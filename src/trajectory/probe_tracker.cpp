#include "trajectory/probe_tracker.hpp"

#include "flow/kept_sign.hpp"
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
        const bool phase = probe.kind == Probe::Kind::phase;
        followed_.push_back({probe.kind, phase ? probe.state : simulation.series_of_probe(p), {}});
        for (std::size_t mode = 0; phase && mode < simulation.model().modes.size(); ++mode) {
            const std::size_t degree = simulation.system().mode(mode).tape.degrees[probe.state];
            followed_.back().sizes.push_back(std::min(work_.size() - 1, degree) + 1);
        }
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

/// Beginning on the section is not a passage of it, whichever way the phase goes.
void ProbeTracker::leave_section(std::size_t index, const Step& step) {
    const Probe& probe = simulation_.probes()[index];
    const double period = periods_[probe.state];
    const std::span<const double> c = series_of_phase(index, step);
    const std::size_t leading = leading_index(c, step.length, roundoff * period);
    if (leading == 0)
        return;
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
    for (std::size_t p = 0; p < tracked_.size(); ++p)
        if (const Probe& probe = simulation_.probes()[p]; probe.kind == Probe::Kind::phase && probe.state == state) {
            tracked_[p].lower += shift;
            tracked_[p].upper += shift;
        }
}

void ProbeTracker::relocate(std::size_t state, double before, double after) {
    const double period = periods_[state];
    const double turns = std::round((after - before) / period);
    // A jump by whole periods moves the sections along: a passage that is due must be neither lost nor doubled.
    if (std::abs(after - before - turns * period) <= 16 * roundoff * period)
        return shift(state, turns * period);
    for (std::size_t p = 0; p < tracked_.size(); ++p)
        if (const Probe& probe = simulation_.probes()[p]; probe.kind == Probe::Kind::phase && probe.state == state)
            locate(p, after);
}

void ProbeTracker::remember_start() {
    if (!remembered_)
        tracked_at_start_ = tracked_;
    remembered_ = true;
}

void ProbeTracker::cut(double s) {
    if (!remembered_)
        return;
    tracked_ = tracked_at_start_;
    for (const Change& one : changes_)
        if (one.at <= s)
            change(one.probe, one.direction);
}

std::span<const ProbeTracker::Found> ProbeTracker::search(const Step& step) {
    found_.clear();
    changes_.clear();
    remembered_ = false;
    constexpr std::size_t none = static_cast<std::size_t>(-1);
    std::size_t phase = none; // whose reach is known
    double reach = 0;
    for (std::size_t p = 0; p < followed_.size(); ++p) {
        const std::size_t index = followed_[p].index;
        const Tracked& tracked = tracked_[p];
        if (followed_[p].kind == Probe::Kind::phase) {
            if (index != phase)
                reach = size_beyond_start(series_of_phase(p, step), step.length) * (1 + roundoff);
            phase = index;
            if (tracked.on_section || tracked.is_near(step.states[index][0], reach))
                search_phase(p, step, reach);
            continue;
        }
        const std::span<const double> c = without_gaps(step.observed[index], work_.size());
        if (followed_[p].kind == Probe::Kind::crossing) {
            search_series(p, c, step.length, false);
        } else if (tracked.side == 0 || RootFinder::trend(c, step.length) != tracked.side) {
            for (std::size_t k = 0; k + 1 < c.size(); ++k)
                work_[k] = static_cast<double>(k + 1) * c[k + 1];
            search_series(p, {work_.data(), c.size() - 1}, step.length, true);
        }
    }
    arc_start_ = false;
    const auto is_before = [](const Found& a, const Found& b) { return a.at < b.at; };
    if (!std::is_sorted(found_.begin(), found_.end(), is_before)) // sorting asks for memory
        std::stable_sort(found_.begin(), found_.end(), is_before);
    return found_;
}

void ProbeTracker::change(std::size_t index, int direction) {
    const Probe& probe = simulation_.probes()[index];
    Tracked& tracked = tracked_[index];
    if (probe.kind != Probe::Kind::phase) {
        tracked.side = direction;
        return;
    }
    const double period = periods_[probe.state];
    tracked.lower += direction * period;
    tracked.upper += direction * period;
    (direction > 0 ? tracked.lower_slack : tracked.upper_slack) = roundoff * period;
    (direction > 0 ? tracked.upper_slack : tracked.lower_slack) = 0;
}

void ProbeTracker::note(std::size_t probe, double at, int direction, bool at_contact) {
    changes_.push_back({probe, at, direction});
    change(probe, direction);
    const Direction wanted = simulation_.probes()[probe].direction;
    if (simulation_.probes()[probe].kind == Probe::Kind::phase || wanted == Direction::both ||
        (wanted == Direction::rising) == (direction > 0))
        found_.push_back({probe, at, direction, at_contact});
}

void ProbeTracker::search_series(std::size_t probe, std::span<const double> c, double length, bool extremum) {
    Tracked& tracked = tracked_[probe];
    int now = c[0] > 0 ? 1 : -1;
    if (now == tracked.side && roots::kept_sign(c, length) == now)
        return;
    remember_start();
    const double noise = roundoff * (std::abs(c[0]) + size_beyond_start(c, length));
    RootStart start = RootStart::as_is;
    if (std::abs(c[0]) <= noise) {
        const std::size_t leading = leading_index(c, length, noise);
        if (leading == 0)
            return; // zero throughout, to within round-off
        now = c[leading] > 0 ? 1 : -1;
        c = c.subspan(leading - 1);
        start = RootStart::deflate;
    }
    // A changed sign at the start is a passage that fell between two steps; at the start of an arc it is the
    // doing of a jump, which makes an extremum but is no crossing by the motion.
    if (tracked.side != 0 && now != tracked.side && (!arc_start_ || extremum))
        note(probe, 0, now, arc_start_);
    tracked.side = tracked_at_start_[probe].side = now;
    roots_.crossings(c, length, start, found_roots_);
    for (const Root& root : found_roots_) {
        const int direction = root.kind == RootKind::rising ? 1 : -1;
        if (direction == tracked.side)
            continue; // leaves a zero that was already counted
        note(probe, root.at, direction, false);
    }
}

/// Coefficients of one lane, side by side; valid until the next ones are asked for.
std::span<const double> ProbeTracker::without_gaps(const Series& series, std::size_t size) {
    if (series.stride == 1)
        return {series.first, size};
    for (std::size_t k = 0; k < size; ++k)
        gathered_[k] = series[k];
    return {gathered_.data(), size};
}

/// Without the coefficients that are zero: the rate of a phase may be constant.
std::span<const double> ProbeTracker::series_of_phase(std::size_t probe, const Step& step) {
    const Followed& followed = followed_[probe];
    return without_gaps(step.states[followed.index], followed.sizes[step.mode]);
}

void ProbeTracker::search_phase(std::size_t index, const Step& step, double reach) {
    remember_start();
    Tracked& tracked = tracked_[index];
    if (tracked.on_section) {
        leave_section(index, step);
        tracked_at_start_[index] = tracked;
        if (tracked.on_section)
            return;
    }
    const std::span<const double> c = series_of_phase(index, step);
    for (double from = 0; tracked.is_near(c[0], reach);) {
        int direction = 0;
        double at = 0;
        const auto try_target = [&](double offset, int towards) {
            if (std::abs(offset) > reach)
                return;
            std::copy(c.begin(), c.end(), work_.begin());
            work_[0] = offset;
            if (from == 0 && offset * towards >= 0) { // passed between two steps
                direction = towards;
                at = 0;
                return;
            }
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
