// The start of an arc: on which side of each watched event's surface it begins, and events that happen at once.

#include "graze/trajectory/trajectory.hpp"

#include "trajectory/probe_tracker.hpp"
#include "trajectory/series.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace graze {

namespace {

/// A jump that keeps the motion on a surface leaves the event function at round-off, which the sizes of the terms of
/// the function and of the jump may amplify.
constexpr double jump_roundoff = 1e-10;

/// Relative uncertainty of a state after the few operations of a jump.
constexpr double state_roundoff = 16 * std::numeric_limits<double>::epsilon();
/// The same of an event's function after a flight, relative to its largest value.
constexpr double flight_roundoff = 4 * std::numeric_limits<double>::epsilon();
/// At most this share of the size of an event's function is attributed to errors.
constexpr double most_uncertain = 1e-3;

/// When a motion that rests on a surface is released because the contact force reaches zero, a residual force of
/// round-off size and of either sign remains, and perhaps a speed. They are ignored if they are outgrown within these
/// shares of a full step.
constexpr double instant_of_speed = 1e-13, instant_of_force = 1e-9;

} // namespace

void Trajectory::begin_arc(double step) {
    announce_contact();
    arc_start_ = false;
    branch_ahead_ = states_;
    probes_->begin_arc();
    std::copy(state_.begin(), state_.end(), inputs_.begin());
    const auto& mode = *compiled_mode_;
    const bool first = start_event_ == no_event && !stuck_ && contacts_ == 0 && steps_ == 0;
    if (first && begins_beside_surface())
        return;
    if (start_event_ != no_event &&
        (complete_joint_chatter(step, contacts_now_ > simulation_.options().contacts_at_once / 2) ||
         complete_spiral(step)))
        return;
    for (std::size_t w = 0; w < mode.watched.size(); ++w)
        if (!classify(w, step))
            return;
    for (Hold& hold : holds_)
        hold.carried = hold.on;
    for (const std::size_t event : mode.watched)
        holds_[event] = {};
    start_event_ = no_event;
    stuck_ = false;
    together_.clear();
}

/// Decides on which side of a watched event's surface the arc begins. Returns false when an event happens at
/// once: a contact, sticking, or the end of the trajectory.
bool Trajectory::classify(std::size_t w, double step) {
    const auto& mode = *compiled_mode_;
    const std::size_t event = mode.watched[w];
    const Event& definition = simulation_.model().events[event];
    const auto c = event_series(w);
    const double size = series_size(c, step);
    const bool began_here = event == start_event_;
    const bool due = is_due(event);
    Watch& watch = watches_[w];
    watch = {};
    sum_term_sizes(w);
    EventSize& sizes = event_sizes_[event];
    sizes.of_arc = sizes.rate = 0;
    sizes.terms = terms_[0];
    sizes.left_surface = false;
    double drifted = 0;
    const double at_surface = surface_at_start(w, size, drifted);
    if (std::abs(c[0]) > at_surface) {
        watch.side = c[0] > 0 ? 1 : -1;
        if (watch.side > 0 || definition.kind == EventKind::section)
            return true;
        if (stuck_) { // released at the moment of sticking
            make_contact(w, 0);
            return false;
        }
        finish_violated(w);
        return false;
    }
    sizes.left_surface = true;
    const std::size_t leading = leading_coefficient(w, step, drifted);
    if (leading == 0)
        return true; // moves along the surface: no contact is possible until it leaves
    watch.side = c[leading] > 0 ? 1 : -1;
    watch.strip = static_cast<int>(leading);
    if (watch.side > 0)
        return !(began_here && leading == 1) || !complete_chatter(w, step);
    if (definition.kind == EventKind::section && (began_here || (!due && (leading > 1 || fell_before(w, at_surface)))))
        return true;
    if (!began_here) {
        make_contact(w, 0);
        return false;
    }
    if (leading == 1) {
        finish(Ending::no_separation, time_,
               fmt::format("after its jump, barrier '{}' is still approached {}: give its transition a jump that "
                           "separates, or a next mode that does not watch it, or declare it a section",
                           definition.name, where()));
        return false;
    }
    const bool one_of_many = simulation_.system().transition(mode.transitions[w]).one_of_many;
    stick(w, one_of_many ? histories_[event].transition : mode.transitions[w], 0, 0);
    return false;
}

void Trajectory::finish_violated(std::size_t w) {
    const Event& event = simulation_.model().events[compiled_mode_->watched[w]];
    if (const Transition& only = simulation_.model().transitions[compiled_mode_->transitions[w]];
        !only.otherwise.empty() && only.next.front().when_text == "never")
        return finish_otherwise(only, time_);
    finish(Ending::inadmissible, time_,
           fmt::format("barrier '{}' is already violated ({:.6g} < 0) {}: choose an initial state on its admissible "
                       "side, or a jump that does not lead beyond it",
                       event.name, event_series(w)[0], where()));
}

bool Trajectory::is_due(std::size_t event) const {
    return std::find(together_.begin(), together_.end(), event) != together_.end();
}

/// Returns how close to zero a watched event's function is on its surface at the start of an arc. Requires
/// sum_term_sizes.
/// @param size of its series; @param drifted receives the part that is attributed to a drift along the surface, or 0
double Trajectory::surface_at_start(std::size_t w, double size, double& drifted) {
    const std::size_t event = compiled_mode_->watched[w];
    const double value = event_series(w)[0];
    double at_surface = roundoff * std::max(size, terms_[0]);
    if (event == start_event_ || is_due(event))
        at_surface = std::max(at_surface, jump_roundoff * size + 2 * std::abs(surface_values_[event]));
    else if (value > 0) // not put there by a contact: only round-off of its own terms
        at_surface = roundoff * terms_[0];
    if (value < -at_surface) { // beyond the surface, or within the uncertainty
        // The flight before the first of several contacts at this time ended with the round-off of its whole way; gaps
        // of bodies that touch one another are differences of larger numbers.
        const bool among_many = contacts_now_ > 0 && simulation_.model().contacts.size() > 1;
        const double share = among_many ? roundoff : contacts_now_ > 0 ? flight_roundoff : 0;
        double of_flight = share * event_sizes_[event].largest;
        if (simulation_.system().contacts_of(mode_))
            for (const std::size_t other : compiled_mode_->watched)
                of_flight = std::max(of_flight, share * event_sizes_[other].largest);
        at_surface = std::max({at_surface, uncertainty_at_start(w, size), of_flight});
        if (value < -at_surface)
            at_surface = drifted = drift(event, std::max(size, terms_[0]));
    }
    return at_surface;
}

/// Returns how far from zero a watched event's function may be at the start of an arc whose state is meant to be on its
/// surface: round-off of its evaluation, and the uncertainty of the state from the jump that made it.
double Trajectory::uncertainty_at_start(std::size_t w, double size) {
    const System& compiled = simulation_.system();
    std::fill(uncertain_.begin(), uncertain_.end(), 0.0);
    const bool jumped = start_event_ != no_event || stuck_;
    for (std::size_t j = states_; j < inputs_.size(); ++j)
        uncertain_[j] = state_roundoff * std::abs(inputs_[j]);
    values_.resize(std::max(states_, compiled.mode(mode_).events.outputs()));
    if (jumped) {
        for (std::size_t i = 0; i < states_; ++i)
            uncertain_[i] = state_roundoff * std::abs(before_[i]);
        std::copy(before_.begin(), before_.end(), inputs_.begin());
        compiled.jump(last_jump_).map.error_bounds(inputs_, uncertain_, values_, work_);
    }
    for (std::size_t i = 0; i < states_; ++i)
        uncertain_[i] = std::max(state_roundoff * std::abs(state_[i]), jumped ? values_[i] : 0);
    std::copy(state_.begin(), state_.end(), inputs_.begin());
    compiled.mode(mode_).events.error_bounds(inputs_, uncertain_, values_, work_);
    // An uncertainty as large as the function itself would hide any violation.
    return std::isfinite(values_[w]) ? std::min(values_[w], most_uncertain * size) : 0;
}

/// Returns the distance by which a motion may have drifted from a surface while a mode that does not watch it moved it
/// along, such as a body at rest on a table: the error of the steps made since.
double Trajectory::drift(std::size_t event, double size) const {
    const Hold& hold = holds_[event];
    if (!hold.carried)
        return 0;
    const double steps = static_cast<double>(steps_ - hold.since + 1);
    return std::min(steps * simulation_.options().tolerance, most_uncertain) * std::max(size, hold.size);
}

/// Records the surfaces on which the state lies at s: that of the contact, and those that coincide with it.
void Trajectory::hold_surfaces(std::size_t watched, double s) {
    const auto& mode = *compiled_mode_;
    for (std::size_t w = 0; w < mode.watched.size(); ++w) {
        const auto c = event_series(w);
        const double size = series_size(c, std::max(s, previous_step_));
        if (w == watched || std::abs(evaluate_polynomial(c, s)) <= jump_roundoff * size)
            holds_[mode.watched[w]] = {true, false, steps_, size};
    }
}

/// Returns whether a section's function, zero at the start of an arc, was already falling through zero before the
/// contact with which the arc begins: this fall has been handled with the contact. At the start of a trajectory a
/// section that falls counts as passed, too.
bool Trajectory::fell_before(std::size_t w, double at_surface) {
    if (start_event_ == no_event && !stuck_)
        return true;
    const auto& mode = *compiled_mode_;
    std::copy(before_.begin(), before_.end(), inputs_.begin());
    const System::CompiledGradient& gradient = mode.gradients[w];
    values_.resize(std::max(mode.events.outputs(), gradient.states.size()));
    mode.events.evaluate(inputs_, values_, work_);
    const bool was_on_surface = std::abs(values_[w]) <= 2 * at_surface;
    gradient.values.evaluate(inputs_, values_, work_);
    std::copy(state_.begin(), state_.end(), inputs_.begin());
    double rate = 0;
    for (std::size_t i = 0; i < gradient.states.size(); ++i)
        if (const double slope = values_[i]; slope != 0)
            rate += slope * fields_[gradient.states[i]];
    return was_on_surface && rate < 0; // otherwise the jump has put it there
}

/// Sums, for each coefficient of a watched event function, the absolute contributions of the states: the scale of its
/// round-off, which cancellation hides in the coefficient itself. Requires the inputs of the state.
void Trajectory::sum_term_sizes(std::size_t w) {
    const System::CompiledGradient& gradient = compiled_mode_->gradients[w];
    values_.resize(gradient.states.size());
    gradient.values.evaluate(inputs_, values_, work_);
    terms_.assign(static_cast<std::size_t>(order_) + 1, 0.0);
    for (std::size_t i = 0; i < gradient.states.size(); ++i)
        if (const double slope = std::abs(values_[i]); slope > 0 && std::isfinite(slope))
            for (std::size_t k = 0; k < terms_.size(); ++k)
                terms_[k] += slope * std::abs(series_[gradient.states[i]][k]);
}

/// Returns whether a function that is zero at the start of an arc seems to fall, but rises as soon as round-off of the
/// vector field is outgrown: a motion that leaves a slide leaves the surface with no speed, and where the push of the
/// side that it enters falls slowly through zero, terms of the field cancel to a remainder of either sign.
/// Requires the inputs of the state.
bool Trajectory::is_cancelled_fall(std::size_t w, double step) {
    const std::size_t event = compiled_mode_->watched[w];
    const auto c = event_series(w);
    if (event == start_event_ || is_due(event) || c.size() < 3 || !(c[1] < 0 && -c[1] < most_uncertain * c[2] * step))
        return false; // a contact of the event itself gives a speed that is known
    for (std::size_t i = 0; i < inputs_.size(); ++i)
        uncertain_[i] = state_roundoff * std::abs(inputs_[i]);
    values_.resize(std::max(values_.size(), states_));
    compiled_mode_->rates.error_bounds(inputs_, uncertain_, values_, work_);
    std::copy_n(values_.begin(), states_, uncertain_.begin());
    const System::CompiledGradient& gradient = compiled_mode_->gradients[w];
    values_.resize(std::max(values_.size(), gradient.states.size()));
    gradient.values.evaluate(inputs_, values_, work_);
    double uncertainty = 0;
    for (std::size_t i = 0; i < gradient.states.size(); ++i)
        if (const double slope = std::abs(values_[i]); slope > 0)
            uncertainty += slope * uncertain_[gradient.states[i]];
    return -c[1] <= uncertainty;
}

/// Returns the first coefficient after the zeroth that exceeds round-off, which decides the sign just after the start
/// of an arc; 0 if there is none. Requires sum_term_sizes.
/// @param drift possible distance from a surface along which the motion was moved
std::size_t Trajectory::leading_coefficient(std::size_t w, double step, double drift) {
    const auto c = event_series(w);
    const double noise = std::max(roundoff * series_size(c, step), drift);
    double power = 1;
    for (std::size_t k = 1; k < c.size(); ++k) {
        power *= step;
        if (std::abs(c[k]) * power <= noise || std::abs(c[k]) <= roundoff * terms_[k])
            continue;
        if (k == 1 && is_cancelled_fall(w, step))
            continue;
        const double instant = k == 1 ? instant_of_speed : instant_of_force;
        const bool outgrown =
            k + 1 < c.size() && c[k] * c[k + 1] < 0 && std::abs(c[k]) < instant * largest_step_ * std::abs(c[k + 1]);
        if (!outgrown)
            return k;
    }
    return 0;
}

} // namespace graze
