// Reports of steps to the observer.

#include "graze/trajectory/trajectory.hpp"

#include "trajectory/probe_tracker.hpp"
#include "trajectory/series.hpp"
#include "trajectory/tangents.hpp"

#include <cmath>
#include <limits>

namespace graze {

/// Reports all that happens within the step. Returns true when the observer stops the trajectory at a passage: the step
/// then ends there.
bool Trajectory::make_step(double& length) {
    ++steps_;
    // A step that does not change the time is no progress: contacts must not repeat endlessly within it.
    if (length > 4 * std::numeric_limits<double>::epsilon() * std::abs(time_))
        contacts_now_ = 0;
    const std::size_t watched = compiled_mode_->watched.size();
    Step step;
    step.start = time_;
    step.length = length;
    step.mode = mode_;
    step.order = order_;
    step.states = series_.first(states_);
    step.events = series_.subspan(states_, watched);
    step.observed = series_.subspan(states_ + watched, simulation_.system().observed());
    report_touches(length);
    bool stopped = false;
    if (!simulation_.probes().empty()) {
        for (const ProbeTracker::Found& found : probes_->search(step)) {
            if (stopped && found.at > length)
                break;
            report_passage(found.probe, found.at, found.direction, found.at_contact);
            if (observer_->stop() && !stopped) {
                stopped = true;
                length = found.at;
            }
        }
        if (stopped)
            probes_->cut(step, length);
        step.length = length;
    }
    observer_->step(step);
    if (simulation_.options().minima)
        report_minima(length);
    return stopped;
}

void Trajectory::report_passage(std::size_t index, double at, int direction, bool at_contact) {
    const Probe& probe = simulation_.probes()[index];
    for (std::size_t i = 0; i < states_; ++i)
        before_[i] = evaluate_state(i, at);
    reduce_cyclic_states(before_);
    if (probe.kind == Probe::Kind::phase &&
        periods_[probe.state] - before_[probe.state] < roundoff * periods_[probe.state])
        before_[probe.state] = 0;
    observer_->passage({index, time_ + (at + time_low_), direction, mode_, at_contact, before_});
}

void Trajectory::report_touches(double length) {
    const auto& mode = *compiled_mode_;
    for (const Touch& touch : touches_) {
        if (touch.root.at > length)
            continue;
        if (touch.grazing && tangents_)
            tangents_->invalidate();
        if (touch.grazing && observer_->follows_derivatives())
            observer_->grazing();
        if (simulation_.model().events[mode.watched[touch.watched]].kind == EventKind::section)
            continue;
        Contact contact;
        contact.kind = ContactKind::touch;
        contact.time = time_ + (touch.root.at + time_low_);
        contact.event = mode.watched[touch.watched];
        contact.transition = mode.transitions[touch.watched];
        contact.mode_before = contact.mode_after = mode_;
        contact.value = touch.root.value;
        for (std::size_t i = 0; i < states_; ++i)
            before_[i] = evaluate_state(i, touch.root.at);
        reduce_cyclic_states(before_);
        contact.before = contact.after = before_;
        observer_->contact(contact);
    }
    touches_.clear();
}

void Trajectory::report_minima(double length) {
    const auto& mode = *compiled_mode_;
    for (std::size_t w = 0; w < mode.watched.size(); ++w) {
        StepMinimum report;
        report.event = mode.watched[w];
        report.minimum = roots_.minimum(event_series(w), length);
        report.time = time_ + (report.minimum.at + time_low_);
        observer_->minimum(report);
    }
}

} // namespace graze
