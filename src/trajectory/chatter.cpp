// Accumulations of contacts (chatter): detection, time and state of the accumulation, and the sticking that follows.

#include "graze/trajectory/trajectory.hpp"

#include "base/special_numbers.hpp"
#include "trajectory/series.hpp"
#include "trajectory/tangents.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace graze {

namespace {

/// Consecutive contacts required before an accumulation is considered.
constexpr int fewest_contacts_of_chatter = 3;

} // namespace

void Trajectory::remember_contact(std::size_t event, double rate) {
    ContactHistory& history = histories_[event];
    ++contacts_;
    // A speed below round-off may even have the wrong sign.
    const bool slower = rate > history.rate || rate > 0;
    history.count = history.count > 0 && slower ? history.count + 1 : 1;
    history.interrupted = contacts_ != history.serial + 1;
    history.serial = contacts_;
    history.flight = time_ - history.time;
    history.time = time_;
    history.rate = rate > 0 && slower ? std::min(history.rate, 0.0) : rate;
    history.previous_speed = history.speed;
    history.speed = 0;
}

/// Contacts at one barrier that follow each other ever faster accumulate in finite time (Budd and Dux 1994). With speed
/// u and deceleration a after a contact, and speeds that fall by a factor r at each, the remaining time is 2u / (a (1 -
/// r)); if other events happen in between, it is estimated from the flight times. The accumulation is completed at once
/// when the remaining time is so short that everything else is constant to within tolerance.
bool Trajectory::complete_chatter(std::size_t w, double step) {
    ContactHistory& history = histories_[compiled_mode_->watched[w]];
    const auto c = event_series(w);
    const double speed = c[1], deceleration = -2 * c[2];
    history.speed = speed;
    if (history.count < fewest_contacts_of_chatter || !(deceleration > 0))
        return false;
    const double ratio = history.interrupted ? speed / history.previous_speed : speed / -history.rate;
    if (!(ratio < 1))
        return false;
    const double flight = history.interrupted ? ratio * history.flight : 2 * speed / deceleration;
    const double steady = flight / (1 - ratio);
    // To first order in the change of the deceleration: where it falls at the rate j, with q = j u / a^2, a flight
    // takes 2u/a (1 + 2q/3), returns with the speed u (1 - 2q/3) and leaves the deceleration a (1 - 2q).
    const double lengthening = -c[3] / c[2] * steady;
    const double remaining = history.interrupted ? steady : steady * (1 + lengthening);
    const double allowed = std::max(4 * epsilon, 0.01 * simulation_.options().tolerance);
    // Where other events come in between, the present deceleration may not be what brings the next contact: of two
    // balls that fall it is round-off.
    const double height = std::max(deceleration * remaining, history.interrupted ? speed : 0.0) * remaining;
    const double change = std::abs(lengthening);
    const double neglected =
        history.interrupted ? change : 4 * (change * change + std::abs(c[4] / c[2]) * steady * steady);
    // Lower flights would consist of the round-off of the states.
    const double low = std::max(allowed * series_size(c, step), 16 * roundoff * terms_[0]);
    if (height > low || !(change < 0.01) || !(neglected * steady <= allowed * step) ||
        remaining > (end_time_ - time_) - time_low_ || (!history.interrupted && another_event_within(w, remaining)))
        return false;
    // If each contact changes the mode, for example by making a frame slip that soon stops again, the accumulation is
    // that of the transition made at the contacts.
    stick(w, history.transition, remaining, (deceleration - 3 * c[3] * remaining) * remaining - speed);
    return true;
}

bool Trajectory::another_event_within(std::size_t w, double time) {
    for (std::size_t other = 0; other < compiled_mode_->watched.size(); ++other) {
        const auto c = event_series(other);
        if (other != w && c[0] > 0 && c[0] + time * c[1] < 0)
            return true;
    }
    return false;
}

/// Too many contacts at one time: if each was slower than the one before, an accumulation that the other rules did not
/// detect (such as that of a block rocking from edge to edge), otherwise an endless cycle of modes.
void Trajectory::judge_stand_still() {
    const ContactHistory history = histories_[start_event_];
    hand_over_contact();
    if (history.count >= simulation_.options().contacts_at_once / 20) {
        before_ = state_;
        if (tangents_)
            row_.assign(tangents_->directions(), 0.0);
        return come_to_rest(start_event_, history.transition, 0);
    }
    finish(Ending::no_progress, time_,
           fmt::format("{} events happened at once {}: look for modes that hand over to one another in a circle",
                       contacts_now_, where()));
}

/// Completes an accumulation of contacts that ends `remaining` after the present state. The remaining contacts change
/// the event function's rate by `impulse` in all; they change the state in the proportions of the last contact.
void Trajectory::stick(std::size_t w, std::size_t index, double remaining, double impulse) {
    const std::size_t event = compiled_mode_->watched[w];
    const auto c = event_series(w);
    const double last_impulse = c[1] - histories_[event].rate;
    const double share = remaining > 0 && last_impulse > 0 ? impulse / last_impulse : 0;
    fields_.resize(2 * states_);
    if (tangents_)
        carry_tangents_to_rest(w, remaining, share > 0 ? 1 / last_impulse : 0);
    for (std::size_t i = 0; i < states_; ++i) {
        const double kick = share * (after_[i] - before_[i]);
        fields_[i] = series(i)[1];
        before_[i] = state_[i] + remaining * fields_[i] + (periods_[i] > 0 ? 0 : kick);
    }
    hold_surfaces(w, 0);
    add_time(remaining);
    come_to_rest(event, index, c[1]);
}

/// Makes the declared sticking transition, from `before_`.
void Trajectory::come_to_rest(std::size_t event, std::size_t index, double rate) {
    index = *transition_to_rest(event, index);
    const Transition& transition = simulation_.model().transitions[index];
    histories_[event] = {};
    if (!transition.chatter) {
        state_ = before_;
        return finish(
            Ending::chatter, time_,
            fmt::format("contacts at barrier '{}' accumulate in mode '{}' at time {:.15g}, and its transition "
                        "does not say what follows: give it `chatter = {{ jump = ..., mode = ... }}`",
                        simulation_.model().events[event].name, simulation_.model().modes[mode_].name, time_));
    }
    Contact contact;
    contact.kind = ContactKind::sticking;
    contact.time = time_;
    contact.event = event;
    contact.transition = index;
    contact.mode_before = mode_;
    contact.rate_before = rate;
    pending_ = contact;
    start_event_ = no_event;
    stuck_ = true;
    jump(transition.chatter->jump);
    enter(transition.chatter->jump, transition.chatter->mode);
}

/// Derivatives of the state and time of accumulation, which depend on the speed after the last contact.
void Trajectory::carry_tangents_to_rest(std::size_t w, double remaining, double per_impulse) {
    const auto c = event_series(w);
    row_.assign(tangents_->directions(), 0.0);
    if (!(remaining > 0))
        return;
    // Derivatives are at a fixed time, at which a neighbouring trajectory is `lead` away from the surface, with a speed
    // that differs by `row_` and by the deceleration since.
    std::vector<double> lead(row_.size()), curvature(row_.size());
    tangents_->coefficient(mode_, state_, w, 0, lead);
    tangents_->coefficient(mode_, state_, w, 2, curvature);
    tangents_->coefficient(mode_, state_, w, 1, row_);
    for (std::size_t d = 0; d < row_.size(); ++d) {
        lead[d] /= c[1];
        row_[d] -= 2 * c[2] * lead[d];
    }
    // d(remaining)/d(speed), and the corresponding impulse a (remaining) - u
    const double per_speed = remaining / c[1];
    const double kicks = per_impulse * (-2 * c[2] * per_speed - 1);
    kick_.resize(states_);
    for (std::size_t i = 0; i < states_; ++i)
        kick_[i] = periods_[i] > 0 ? 0 : kicks * (after_[i] - before_[i]);
    tangents_->add_product(kick_, row_);
    for (std::size_t d = 0; d < row_.size(); ++d)
        row_[d] = row_[d] * per_speed - lead[d] - remaining * curvature[d] / c[2];
}

} // namespace graze
