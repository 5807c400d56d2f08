// Accumulations of impacts in several contacts that hit one another: a stack of bodies that comes to rest.

#include "graze/trajectory/trajectory.hpp"

#include "trajectory/joint_rest.hpp"
#include "trajectory/series.hpp"
#include "trajectory/tangents.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace graze {

namespace {

/// More impacts are not followed: some tenths of a second of computing time at the end, less where the motion can go
/// on.
constexpr std::size_t most_impacts = 3'000'000, most_on_the_way = 200'000;

/// Returns the part of the values of contacts that is about some of them.
NearbyContacts nearby(std::span<const double> values, std::size_t n, const std::vector<std::size_t>& members) {
    NearbyContacts result;
    for (const std::size_t i : members) {
        result.gap.push_back(values[i]);
        result.rate.push_back(values[n + i]);
        result.acceleration.push_back(values[2 * n + i]);
        result.restitution.push_back(values[3 * n + i]);
        for (const std::size_t j : members)
            result.response.push_back(values[4 * n + i * n + j]);
    }
    return result;
}

/// Returns whether another contact may close while some come to rest, whose impulses move its gap, too: on average by
/// their moments, and in between by no more than the heights of their flights.
bool comes_close(std::span<const double> values, std::size_t n, std::size_t contact,
                 const std::vector<std::size_t>& members, const JointRest& rest) {
    const double time = rest.duration, gap = values[contact];
    double end = gap + time * (values[n + contact] + values[2 * n + contact] * time / 2), strongest = 0, margin = 0;
    for (const std::size_t j : members)
        strongest = std::max(strongest, std::abs(values[2 * n + j]));
    for (std::size_t k = 0; k < members.size(); ++k) {
        const std::size_t j = members[k];
        const double response = values[4 * n + contact * n + j], speed = values[n + j];
        const double height = std::abs(values[j]) + (strongest > 0 ? speed * speed / (2 * strongest) : 0);
        end += response * rest.moments[k];
        margin += std::abs(response / values[4 * n + j * n + j]) * height;
    }
    return std::min(gap, end) <= margin;
}

} // namespace

/// Completes the impacts of contacts that hit one another until all rest, once their flights are so low that all else
/// is constant to within tolerance. Their order need not repeat: see `joint_rest`.
/// @param standing_still many impacts have been at one time: gaps are zero, whatever the speeds
bool Trajectory::complete_joint_chatter(double step, bool standing_still) {
    const System& system = simulation_.system();
    const System::ContactsOfMode* here = system.contacts_of(mode_);
    if (here == nullptr)
        return false;
    const System::CompiledContacts& contacts = system.contacts(here->contacts);
    const std::size_t n = contacts.events.size();
    std::copy(state_.begin(), state_.end(), inputs_.begin());
    std::vector<std::size_t> members, open;
    for (std::size_t i = 0; i < n; ++i) {
        const auto w = std::ranges::find(compiled_mode_->watched, contacts.events[i]) - compiled_mode_->watched.begin();
        const bool watched = w < std::ssize(compiled_mode_->watched);
        if (!here->closed[i] && watched && is_nearby(static_cast<std::size_t>(w), step, standing_still))
            open.push_back(i);
        if (here->closed[i] || (!open.empty() && open.back() == i))
            members.push_back(i);
    }
    if (open.empty() || members.size() < 2)
        return false;
    contact_values_.resize(contacts.values.outputs());
    contacts.values.evaluate(inputs_, contact_values_, work_);
    NearbyContacts together = nearby(contact_values_, n, members);
    for (std::size_t k = 0; k < members.size(); ++k) {
        if (here->closed[members[k]] || standing_still)
            together.gap[k] = 0;
        if (here->closed[members[k]])
            together.rate[k] = 0;
    }
    const JointRest rest = joint_rest(together, standing_still ? most_impacts : most_on_the_way, standing_still);
    if (standing_still && rest.fate == JointRest::Fate::undecided) {
        finish(Ending::no_progress, time_,
               fmt::format("impacts in several contacts follow one another ever faster {}, and after {} of them it is "
                           "not decided whether all come to rest: take a smaller restitution, or another law of impact",
                           where(), rest.impacts));
        return true;
    }
    if (rest.fate != JointRest::Fate::rest || rest.duration > (end_time_ - time_) - time_low_)
        return false;
    std::vector<std::size_t> events;
    for (std::size_t k = 0; k < members.size(); ++k)
        if (rest.rests[k] && !here->closed[members[k]])
            events.push_back(contacts.events[members[k]]);
    if (events.empty())
        return false;
    const std::span<const double> values = contact_values_;
    for (std::size_t i = 0; i < n; ++i)
        if (std::ranges::find(members, i) == members.end() && comes_close(values, n, i, members, rest))
            return false;
    for (std::size_t w = 0; w < compiled_mode_->watched.size(); ++w) {
        const auto c = event_series(w);
        if (std::ranges::find(contacts.events, compiled_mode_->watched[w]) == contacts.events.end() &&
            falls_within(c, rest.duration))
            return false;
    }
    if (!is_steady(rest.duration, share_of_last_flights(simulation_.options().tolerance) * step))
        return false;
    move_to_rest(members, rest);
    rest_together(events);
    return true;
}

/// Returns whether the gap of an open contact is so small, and stays so small, that the contact may come to rest with
/// others: see `complete_chatter`.
bool Trajectory::is_nearby(std::size_t w, double step, bool standing_still) {
    const auto c = event_series(w);
    sum_term_sizes(w);
    const double allowed = share_of_last_flights(simulation_.options().tolerance);
    const double size = std::min(series_size(c, step), event_sizes_[compiled_mode_->watched[w]].largest);
    const double low = std::max(allowed * size, 16 * roundoff * terms_[0]);
    const double deceleration = -2 * c[2];
    const double height = deceleration > 0 && !standing_still ? c[1] * c[1] / (2 * deceleration) : 0;
    return c[0] + height <= low;
}

/// Returns whether the accelerations of contacts are constant for a time, but for changes that displace its end by no
/// more than an error. Requires the values of contacts.
bool Trajectory::is_steady(double time, double longest_error) {
    if (time == 0)
        return true;
    const System& system = simulation_.system();
    const System::CompiledContacts& contacts = system.contacts(system.contacts_of(mode_)->contacts);
    const std::size_t n = contacts.events.size();
    fields_.resize(2 * states_);
    system.mode(contacts.base).rates.evaluate(inputs_, std::span(fields_).first(states_), work_);
    std::vector<double> later(contact_values_.size());
    for (std::size_t i = 0; i < states_; ++i)
        inputs_[i] = state_[i] + time * fields_[i];
    contacts.values.evaluate(inputs_, later, work_);
    std::copy(state_.begin(), state_.end(), inputs_.begin());
    double change = 0, speed = 0;
    for (std::size_t i = 0; i < n; ++i) {
        change = std::max(change, std::abs(later[2 * n + i] - contact_values_[2 * n + i]) * time);
        speed = std::max({speed, std::abs(contact_values_[n + i]), std::abs(contact_values_[2 * n + i]) * time});
    }
    return change <= 0.01 * speed && change * time <= longest_error * speed;
}

/// Sets `before_` to the state after the remaining impacts: velocities as changed by accelerations and all impulses,
/// and all else moved on with their mean.
void Trajectory::move_to_rest(const std::vector<std::size_t>& members, const JointRest& rest) {
    const System& system = simulation_.system();
    const System::CompiledContacts& contacts = system.contacts(system.contacts_of(mode_)->contacts);
    const std::size_t n = contacts.events.size(), velocities = contacts.velocities.size();
    const auto rates = [&] {
        system.mode(contacts.base).rates.evaluate(inputs_, std::span(fields_).first(states_), work_);
    };
    fields_.resize(2 * states_);
    rates();
    before_ = state_;
    for (std::size_t k = 0; k < velocities; ++k) {
        const std::size_t state = contacts.velocities[k];
        double impulse = 0, moment = 0;
        for (std::size_t i = 0; i < members.size(); ++i) {
            const double response = contact_values_[n * (n + 4) + members[i] * velocities + k];
            impulse += response * rest.impulses[i];
            moment += response * rest.moments[i];
        }
        before_[state] += rest.duration * fields_[state] + impulse;
        if (rest.duration > 0)
            inputs_[state] += rest.duration * fields_[state] / 2 + moment / rest.duration;
    }
    rates();
    for (std::size_t i = 0; i < states_; ++i)
        if (std::ranges::find(contacts.velocities, i) == contacts.velocities.end())
            before_[i] += rest.duration * fields_[i];
    std::copy(state_.begin(), state_.end(), inputs_.begin());
    add_time(rest.duration);
}

/// Closes the contacts of these events one after another, from `before_`, where all gaps and their rates are zero.
void Trajectory::rest_together(const std::vector<std::size_t>& events) {
    if (tangents_) {
        row_.assign(tangents_->directions(), 0.0);
        tangents_->invalidate();
    }
    for (std::size_t w = 0; w < compiled_mode_->watched.size(); ++w)
        if (std::ranges::find(events, compiled_mode_->watched[w]) != events.end())
            hold_surfaces(w, 0);
    bool first = true;
    for (const std::size_t event : events) {
        const auto transition = transition_to_rest(event);
        if (!transition)
            continue;
        if (!first) {
            hand_over_contact();
            before_ = state_;
        }
        first = false;
        come_to_rest(event, *transition, 0);
        if (finished())
            return;
    }
}

/// Returns the transition of an event in the present mode whose contacts, as they accumulate, close this one only.
std::optional<std::size_t> Trajectory::transition_to_rest(std::size_t event) const {
    const Model& model = simulation_.model();
    for (std::size_t t = 0; t < model.transitions.size(); ++t) {
        const Transition& one = model.transitions[t];
        if (one.mode == mode_ && one.event == event && one.also.empty() && one.chatter)
            return t;
    }
    return std::nullopt;
}

} // namespace graze
