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

/// Returns whether the rest of one contact would put a state beyond another barrier: contacts that take turns rest
/// together, and not yet.
/// @param inputs the state at the accumulation, and the parameters
bool leads_beyond(const System& system, std::size_t mode, std::size_t event, std::size_t jump,
                  std::vector<double> inputs, double tolerance, std::span<double> work) {
    const auto& watched = system.mode(mode).watched;
    std::vector<double> after(system.states()), values(watched.size());
    system.jump(jump).map.evaluate(inputs, after, work);
    std::copy(after.begin(), after.end(), inputs.begin());
    system.mode(mode).events.evaluate(inputs, values, work);
    for (std::size_t w = 0; w < watched.size(); ++w)
        if (watched[w] != event && system.model().events[watched[w]].kind == EventKind::barrier &&
            values[w] < -tolerance)
            return true;
    return false;
}

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
    if (simulation_.system().contacts_of(mode_))
        history.interrupted = false; // its own flight is known; for contacts that hit one another see joint_chatter.cpp
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
    const double allowed = share_of_last_flights(simulation_.options().tolerance);
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
    const Model& model = simulation_.model();
    if (const auto& rest = model.transitions[history.transition].chatter;
        rest && (history.interrupted || model.contacts.size() > 1)) {
        std::vector<double> there(inputs_);
        const double impulse = (deceleration - 3 * c[3] * remaining) * remaining - speed;
        for (std::size_t i = 0; i < states_; ++i)
            there[i] = state_[i] + remaining * series(i)[1] +
                       (periods_[i] > 0 ? 0 : impulse / (speed - history.rate) * (after_[i] - before_[i]));
        if (leads_beyond(simulation_.system(), mode_, compiled_mode_->watched[w], rest->jump, std::move(there),
                         16 * roundoff * terms_[0], work_))
            return false;
    }
    // If each contact changes the mode, for example by making a frame slip that soon stops again, the accumulation is
    // that of the transition made at the contacts.
    stick(w, history.transition, remaining, (deceleration - 3 * c[3] * remaining) * remaining - speed);
    return true;
}

/// Returns whether another event may happen during the last contacts at one. Impacts of one contact may move the gap of
/// another: it is then that of its flight, less a share of what the contact that bounces misses of a free flight.
bool Trajectory::another_event_within(std::size_t w, double time) {
    const System& system = simulation_.system();
    const System::ContactsOfMode* here = system.contacts_of(mode_);
    const System::CompiledContacts* contacts = here != nullptr ? &system.contacts(here->contacts) : nullptr;
    const auto place_of = [&](std::size_t watched) {
        return static_cast<std::size_t>(std::ranges::find(contacts->events, compiled_mode_->watched[watched]) -
                                        contacts->events.begin());
    };
    const std::size_t n = contacts != nullptr ? contacts->events.size() : 0, own_place = n > 0 ? place_of(w) : 0;
    if (own_place < n) {
        contact_values_.resize(contacts->values.outputs());
        std::copy(state_.begin(), state_.end(), inputs_.begin());
        contacts->values.evaluate(inputs_, contact_values_, work_);
    }
    const auto own = event_series(w);
    for (std::size_t other = 0; other < compiled_mode_->watched.size(); ++other) {
        const auto c = event_series(other);
        const std::size_t place = own_place < n ? place_of(other) : n;
        if (other == w)
            continue;
        if (place >= n) {
            if (falls_within(c, time))
                return true;
            continue;
        }
        const double* const response = &contact_values_[4 * n];
        const double share = response[place * n + own_place] / response[own_place * n + own_place];
        const double start = c[0] + std::min(0.0, share * own[1] * own[1] / (-4 * own[2])),
                     rate = c[1] - share * own[1], bend = c[2] - share * own[2];
        const double turn = bend > 0 && rate < 0 ? std::min(time, -rate / (2 * bend)) : time;
        if (!(std::min(start, start + turn * (rate + turn * bend)) > 0))
            return true;
    }
    return false;
}

/// Too many contacts at one time: if each was slower than the one before, an accumulation that the other rules did not
/// detect (such as that of a block rocking from edge to edge), otherwise an endless cycle of modes.
void Trajectory::judge_stand_still() {
    const ContactHistory history = histories_[start_event_];
    hand_over_contact();
    const bool together = simulation_.system().contacts_of(mode_) != nullptr;
    const int most = simulation_.options().contacts_at_once;
    if (!together && history.count >= most / 20 && contacts_nearby_ / 10 <= most) {
        contacts_now_ = 0;
        before_ = state_;
        if (tangents_)
            row_.assign(tangents_->directions(), 0.0);
        return come_to_rest(start_event_, history.transition, 0);
    }
    finish(Ending::no_progress, time_,
           fmt::format("{} events happened at once {}: {}", std::max(contacts_now_, contacts_nearby_), where(),
                       together ? "impacts in several contacts follow one another, and it cannot be decided whether "
                                  "they come to rest together; take a smaller restitution, or another law of impact"
                                : "look for modes that hand over to one another in a circle"));
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
    const bool alone = share > 0 && !histories_[event].interrupted;
    find_displacements(alone ? -(c[0] + remaining * (c[1] + remaining * c[2])) / last_impulse : 0);
    for (std::size_t i = 0; i < states_; ++i) {
        const double kick = share * (after_[i] - before_[i]);
        fields_[i] = series(i)[1];
        const double bend = alone ? remaining * series(i)[2] : 0;
        before_[i] = state_[i] + remaining * (fields_[i] + bend) + kick_[i] + (periods_[i] > 0 ? 0 : kick);
    }
    hold_surfaces(w, 0);
    add_time(remaining);
    come_to_rest(event, index, c[1]);
}

/// Sets `kick_` to what the remaining contacts displace: the states that contacts do not change themselves, but whose
/// rates they change. @param share of the change by the last contact, times the time for which it lasts
void Trajectory::find_displacements(double share) {
    kick_.assign(states_, 0.0);
    if (share == 0)
        return;
    std::vector<double> change(states_);
    values_.resize(std::max(values_.size(), states_));
    const auto rates = [&](const std::vector<double>& state) {
        std::copy(state.begin(), state.end(), inputs_.begin());
        compiled_mode_->rates.evaluate(inputs_, values_, work_);
    };
    rates(after_);
    std::copy_n(values_.begin(), states_, change.begin());
    rates(before_);
    for (std::size_t i = 0; i < states_; ++i)
        if (after_[i] == before_[i] && std::isfinite(change[i] - values_[i]))
            kick_[i] = share * (change[i] - values_[i]);
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
