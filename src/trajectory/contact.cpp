// Contacts: the transition made at an event, and the report to the observer.

#include "graze/trajectory/trajectory.hpp"

#include "flow/guard.hpp"
#include "trajectory/probe_tracker.hpp"
#include "trajectory/series.hpp"
#include "trajectory/tangents.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace graze {

void Trajectory::make_contact(std::size_t w, double s) {
    const auto& mode = *compiled_mode_;
    const std::size_t event = mode.watched[w];
    if (is_two_fold(event, s)) {
        for (std::size_t i = 0; i < states_; ++i)
            state_[i] = evaluate_state(i, s);
        add_time(s);
        return finish_at_two_fold(time_);
    }
    const double rate = evaluate_derivative(event_series(w), s);
    fields_.resize(2 * states_);
    for (std::size_t i = 0; i < states_; ++i) {
        before_[i] = evaluate_state(i, s);
        fields_[i] = evaluate_derivative(series(i), s);
    }
    if (tangents_) {
        row_.resize(tangents_->directions());
        tangents_->advance(mode_, state_, s, w, row_);
        if (is_grazing(w, s, rate))
            tangents_->invalidate();
        else
            for (double& shift : row_)
                shift /= -rate;
    }
    if (observer_->follows_derivatives() && is_grazing(w, s, rate))
        observer_->grazing();
    hold_surfaces(w, s);
    add_time(s);
    remember_contact(event, rate);
    std::copy(before_.begin(), before_.end(), inputs_.begin());
    if (s == 0 && simulation_.system().transition(mode.transitions[w]).following)
        add_simultaneous(w);
    const auto chosen =
        chosen_transition(simulation_.system(), mode.transitions[w], together_, inputs_, conditions_, work_);
    const std::size_t transition = chosen.value_or(mode.transitions[w]);
    histories_[event].transition = transition;
    values_.resize(mode.events.outputs());
    mode.events.evaluate(inputs_, values_, work_);
    // Simultaneous events were on their surfaces when found. Jumps made since may have moved the state away from them.
    const bool first_at_this_time = start_event_ == no_event && !stuck_;
    std::erase(together_, event);
    for (std::size_t other = 0; other < mode.watched.size(); ++other)
        if (first_at_this_time || other == w)
            surface_values_[mode.watched[other]] = values_[other];
    Contact contact;
    contact.kind = ContactKind::crossing;
    contact.event = event;
    contact.value = values_[w];
    contact.simultaneous = contacts_now_ > 0;
    contact.rate_before = rate;
    pending_ = contact;
    if (!chosen) {
        // A contact that does not approach closes without an impact.
        if (const auto rest = s == 0 && rate >= 0 ? transition_to_rest(event, {}) : std::nullopt) {
            pending_.reset();
            return come_to_rest(event, *rest, rate);
        }
        after_ = before_;
        pending_->transition = transition;
        pending_->time = time_;
        pending_->mode_before = pending_->mode_after = mode_;
        return finish_without_way(transition);
    }
    for (const std::size_t other : simulation_.system().transition(transition).also)
        std::erase(together_, other);
    apply_transition(transition, rate);
}

/// Adds the events that happen together with one at the start of an arc: on their surfaces, and falling.
void Trajectory::add_simultaneous(std::size_t first) {
    const auto& mode = *compiled_mode_;
    for (std::size_t w = 0; w < mode.watched.size(); ++w) {
        const auto c = event_series(w);
        const double near = 1e-12 * series_size(c, std::max(previous_step_, shortest_step()));
        const bool known = std::ranges::find(together_, mode.watched[w]) != together_.end();
        if (w != first && !known && std::abs(c[0]) <= near && c[1] < 0)
            together_.push_back(mode.watched[w]);
    }
}

/// Ends as a transition says for where none of its ways is possible.
void Trajectory::finish_otherwise(const Transition& transition, double time) {
    finish(transition.paradox ? Ending::painleve : Ending::no_transition, time,
           fmt::format("{}: {}", where(), transition.otherwise));
}

/// Ends at a transition none of whose conditions hold.
void Trajectory::finish_without_way(std::size_t transition) {
    const Model& model = simulation_.model();
    const Transition& definition = model.transitions[transition];
    hand_over_contact();
    state_ = after_;
    if (!definition.otherwise.empty())
        return finish_otherwise(definition, time_);
    finish(Ending::no_transition, time_,
           fmt::format("no condition of transition '{}' (mode '{}', event '{}') holds at time {:.15g}: add an "
                       "alternative without a condition, or one that covers this state",
                       definition.label, model.modes[definition.mode].name, model.events[definition.event].name,
                       time_));
}

/// Makes the transition's jump from `before_` and chooses the next mode.
void Trajectory::apply_transition(std::size_t transition, double rate) {
    const auto& compiled = simulation_.system().transition(transition);
    pending_->transition = transition;
    pending_->time = time_;
    pending_->mode_before = pending_->mode_after = mode_;
    pending_->rate_before = rate;
    start_event_ = pending_->event;
    stuck_ = false;
    const std::size_t mode_before = mode_;
    jump(compiled.jump);
    bool ends = false;
    const auto next = next_mode(transition, ends);
    if (!next) {
        if (!ends)
            return finish_without_way(transition);
        hand_over_contact();
        state_ = after_;
        return finish(Ending::terminal, time_);
    }
    enter(compiled.jump, *next);
    remember_crossing(start_event_, mode_before);
    constexpr double hardly_any = 1e-13;
    if (std::abs(time_ - nearby_since_) > hardly_any * std::max(std::abs(time_ - start_time_), largest_step_)) {
        nearby_since_ = time_;
        contacts_nearby_ = 0;
    }
    ++contacts_nearby_;
    const int most = simulation_.options().contacts_at_once;
    if (!finished() && (contacts_now_ > most || contacts_nearby_ / 10 > most))
        judge_stand_still();
}

void Trajectory::jump(std::size_t jump) {
    std::copy(before_.begin(), before_.end(), inputs_.begin());
    simulation_.system().jump(jump).map.evaluate(inputs_, after_, work_);
}

std::optional<std::size_t> Trajectory::next_mode(std::size_t transition, bool& ends) {
    std::copy(after_.begin(), after_.end(), inputs_.begin());
    const auto* chosen = chosen_alternative(simulation_.system(), transition, inputs_, conditions_, work_);
    if (!chosen)
        return std::nullopt;
    ends = !chosen->mode.has_value();
    return chosen->mode;
}

/// Continues in a mode from `after_`, reached from `before_` by a jump whose time depends on the initial state with the
/// derivatives `row_`.
void Trajectory::enter(std::size_t jump, std::size_t mode) {
    const System& compiled = simulation_.system();
    last_jump_ = jump;
    if (tangents_) {
        jacobian_.resize(compiled.jacobian_entries());
        std::copy(before_.begin(), before_.end(), inputs_.begin());
        compiled.jump(jump).jacobian.evaluate(inputs_, jacobian_, work_);
        std::copy(after_.begin(), after_.end(), inputs_.begin());
        const auto field_after = std::span<double>(fields_).subspan(states_, states_);
        compiled.mode(mode).rates.evaluate(inputs_, field_after, work_);
        if (tangents_->valid())
            tangents_->pass_jump(row_, std::span<const double>(fields_).first(states_), compiled.jump(jump), jacobian_,
                                 field_after);
    }
    pending_->mode_after = mode;
    for (std::size_t i = 0; i < states_; ++i)
        if (!std::isfinite(after_[i])) {
            pending_.reset();
            state_ = before_;
            return finish(
                Ending::undefined, time_,
                fmt::format("jump '{}' gives state '{}' no finite value {}: look for a division by zero, or a "
                            "root or logarithm of a number that is not positive",
                            compiled.model().jumps[jump].name, compiled.model().states[i].name, where()));
        }
    for (std::size_t i = 0; i < states_; ++i)
        if (periods_[i] > 0 && after_[i] != before_[i])
            probes_->relocate(i, before_[i], after_[i]);
    state_ = after_;
    set_mode(mode);
    wrap_cyclic_states(true);
    arc_start_ = true;
    ++contacts_now_;
}

void Trajectory::announce_contact() {
    if (!pending_)
        return;
    const auto& mode = *compiled_mode_;
    for (std::size_t w = 0; w < mode.watched.size(); ++w)
        if (mode.watched[w] == pending_->event)
            pending_->rate_after = std::isfinite(event_series(w)[1]) ? event_series(w)[1] : 0;
    hand_over_contact();
}

void Trajectory::hand_over_contact() {
    reduce_cyclic_states(before_);
    reduce_cyclic_states(after_);
    pending_->before = before_;
    pending_->after = after_;
    observer_->contact(*pending_);
    pending_.reset();
}

} // namespace graze
