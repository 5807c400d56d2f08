// Contacts: how they are found, what may be found at the start of an arc, and how transitions are made.

#include "graze/trajectory/trajectory.hpp"

#include "trajectory/probe_tracker.hpp"
#include "trajectory/series.hpp"
#include "trajectory/tangents.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace graze {

namespace {

constexpr double epsilon = std::numeric_limits<double>::epsilon();
constexpr double infinity = std::numeric_limits<double>::infinity();

/// A jump that keeps the motion at the surface leaves the event function at round-off, which the sizes of the
/// terms of the function and of the jump may magnify.
constexpr double served_roundoff = 1e-10;

/// What rests on a surface and is released when the force that presses it there reaches zero has a force at round-off
/// left, of either sign, and perhaps a speed. They decide nothing if they are outgrown within these shares of a full
/// step.
constexpr double instant_of_speed = 1e-13, instant_of_force = 1e-9;

/// Contacts in a row before an accumulation is looked for.
constexpr int fewest_contacts_of_chatter = 3;

/// How far round-off may have moved a root at s. Only what lies as close is simultaneous, which near the end of an
/// accumulation is far less than the resolution of time.
double root_uncertainty(std::span<const double> c, double s, double step) {
    const double uncertain_value = 4 * epsilon * series_size(c, s), rate = std::abs(evaluate_derivative(c, s));
    const double most = 8 * epsilon * step;
    return uncertain_value < most * rate ? uncertain_value / rate : most;
}

} // namespace

std::size_t Trajectory::find_contact(double& step, const Outlook& outlook, std::size_t lane) {
    const auto& mode = simulation_->compiled().mode(mode_);
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
        if (looked_ahead && first == no_event && watch.side > 0 && watch.strip == 0 &&
            outlook.least(w, lane) > touch_distance(event, outlook.size(w, lane)))
            continue;
        auto c = event_series(w);
        Root root{};
        const RootStart start = watch.strip > 0 ? RootStart::deflate : RootStart::as_is;
        if (watch.strip > 0)
            c = c.subspan(static_cast<std::size_t>(watch.strip) - 1);
        const double length = std::min(whole, step + uncertain);
        bool found = false;
        if (start == RootStart::as_is && watch.side > 0 && c[0] <= 0) {
            // It fell through zero in the round-off between two steps, or has touched zero there and rises again.
            const double noise = roundoff * series_size(c, length);
            const std::size_t leading = -c[0] <= noise ? leading_index(c, length, noise) : 0;
            found = leading == 0 || c[leading] < 0;
            if (!found)
                found = roots_.first_falling(c.subspan(leading - 1), length, RootStart::deflate, root);
        } else {
            const RootFinder::Enclosure enclosure = RootFinder::enclosure(c, length, start);
            const double touch =
                touch_distance(event, whole < previous_step_ ? series_size(c, previous_step_) : enclosure.size);
            // The deflated polynomial is positive where the polynomial itself may be as small as a touch.
            if (watch.side > 0 && enclosure.least > (start == RootStart::as_is ? touch : infinity))
                continue;
            found_touches_.clear();
            found = roots_.first_falling(c, length, start, root, touch, &found_touches_);
            if (simulation_->model().events[event].kind == EventKind::barrier && watch.strip <= 1)
                for (const Root& found_touch : found_touches_)
                    touches_.push_back({w, found_touch});
        }
        if (!found)
            continue;
        const double uncertain_too = root_uncertainty(c, root.at, whole);
        if (first != no_event && root.at >= step - (uncertain + uncertain_too)) {
            together_.push_back(event); // the search ended just behind the first
            continue;
        }
        together_.clear();
        uncertain = uncertain_too;
        first = w;
        step = root.at;
    }
    if (first != no_event && step > 0)
        step = std::min(on_surface(first, step), whole);
    std::stable_sort(touches_.begin(), touches_.end(),
                     [](const Touch& a, const Touch& b) { return a.root.at < b.root.at; });
    return first;
}

/// How close to zero a minimum is a touch. The size of an event's function is the greatest that its series has had.
double Trajectory::touch_distance(std::size_t event, double size) {
    const SimulationOptions& options = simulation_->options();
    event_sizes_[event] = std::max(event_sizes_[event], size);
    return options.touch > 0 ? options.touch : 100 * options.tolerance * event_sizes_[event];
}

void Trajectory::update_sides(double length) {
    const auto& mode = simulation_->compiled().mode(mode_);
    for (std::size_t w = 0; w < mode.watched.size(); ++w) {
        Watch& watch = watches_[w];
        watch.strip = 0;
        if (watch.side > 0)
            continue; // had it fallen, it would have been found; within round-off of zero the next step decides
        const double value = evaluate_polynomial(event_series(w), length);
        const bool barrier = simulation_->model().events[mode.watched[w]].kind == EventKind::barrier;
        if (value > 0)
            watch.side = 1;
        else if (watch.side == 0 && std::abs(value) > roundoff * series_size(event_series(w), length))
            watch.side = barrier ? 1 : -1; // left the surface it moved along: for a barrier, a contact at once
    }
}

void Trajectory::begin_arc(double step) {
    announce_contact();
    arc_start_ = false;
    probes_->begin_arc();
    const auto& mode = simulation_->compiled().mode(mode_);
    for (std::size_t w = 0; w < mode.watched.size(); ++w)
        if (!classify(w, step))
            return;
    served_ = no_event;
    stuck_ = false;
    together_.clear();
}

/// Decides on which side of a watched event's surface the arc begins. Returns false when something happens at
/// once: a contact, sticking, or the end of the trajectory.
bool Trajectory::classify(std::size_t w, double step) {
    const auto& mode = simulation_->compiled().mode(mode_);
    const std::size_t event = mode.watched[w];
    const Event& definition = simulation_->model().events[event];
    const auto c = event_series(w);
    const double size = series_size(c, step);
    const bool served = event == served_;
    const bool due = std::find(together_.begin(), together_.end(), event) != together_.end();
    Watch& watch = watches_[w];
    watch = {};
    weigh_terms(w);
    double at_surface = roundoff * std::max(size, terms_[0]);
    if (served || due)
        at_surface = std::max(at_surface, served_roundoff * size + 2 * std::abs(surface_values_[event]));
    else if (c[0] > 0) // no contact put it there: as far from the surface as its own terms can tell
        at_surface = roundoff * terms_[0];
    if (std::abs(c[0]) > at_surface) {
        watch.side = c[0] > 0 ? 1 : -1;
        if (watch.side > 0 || definition.kind == EventKind::section)
            return true;
        if (stuck_) { // released as soon as it sticks
            make_contact(w, 0);
            return false;
        }
        finish(
            Ending::inadmissible, time_,
            fmt::format("barrier '{}' is already violated ({:.6g} < 0) {}: choose an initial state on its admissible "
                        "side, or a jump that does not lead beyond it",
                        definition.name, c[0], where()));
        return false;
    }
    const std::size_t leading = leading_coefficient(w, step);
    if (leading == 0)
        return true; // moves along the surface: nothing to watch until it leaves
    watch.side = c[leading] > 0 ? 1 : -1;
    watch.strip = static_cast<int>(leading);
    if (watch.side > 0)
        return !(served && leading == 1) || !complete_chatter(w, step);
    if (definition.kind == EventKind::section && (served || !due))
        return true;
    if (!served) {
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
    stick(w, mode.transitions[w], 0, 0);
    return false;
}

/// Sums, for each coefficient of a watched event function, the sizes of what the states contribute to it. What cancels
/// there does not show in the coefficient but is what its round-off is measured by.
void Trajectory::weigh_terms(std::size_t w) {
    const Function& gradients = simulation_->compiled().mode(mode_).event_gradients;
    values_.resize(gradients.outputs());
    std::copy(state_.begin(), state_.end(), inputs_.begin());
    gradients.evaluate(inputs_, values_, work_);
    terms_.assign(static_cast<std::size_t>(order_) + 1, 0.0);
    for (std::size_t i = 0; i < states_; ++i)
        if (const double slope = std::abs(values_[w * states_ + i]); slope > 0 && std::isfinite(slope))
            for (std::size_t k = 0; k < terms_.size(); ++k)
                terms_[k] += slope * std::abs(series_[i][k]);
}

/// The first coefficient after the zeroth that round-off cannot explain, which decides the sign just after the start
/// of an arc; 0 if there is none. Call after weigh_terms.
std::size_t Trajectory::leading_coefficient(std::size_t w, double step) {
    const auto c = event_series(w);
    const double noise = roundoff * series_size(c, step);
    double power = 1;
    for (std::size_t k = 1; k < c.size(); ++k) {
        power *= step;
        if (std::abs(c[k]) * power <= noise || std::abs(c[k]) <= roundoff * terms_[k])
            continue;
        const double instant = k == 1 ? instant_of_speed : instant_of_force;
        const bool outgrown =
            k + 1 < c.size() && c[k] * c[k + 1] < 0 && std::abs(c[k]) < instant * largest_step_ * std::abs(c[k + 1]);
        if (!outgrown)
            return k;
    }
    return 0;
}

void Trajectory::announce_contact() {
    if (!pending_)
        return;
    const auto& mode = simulation_->compiled().mode(mode_);
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

/// Moves a root of the event polynomial onto the surface itself, from which the truncation of the polynomials of
/// event and states may keep it by something like the tolerance.
double Trajectory::on_surface(std::size_t w, double s) {
    const auto c = event_series(w);
    const auto& events = simulation_->compiled().mode(mode_).events;
    values_.resize(events.outputs());
    for (int sweep = 0; sweep < 2; ++sweep) {
        for (std::size_t i = 0; i < states_; ++i)
            inputs_[i] = evaluate_state(i, s);
        events.evaluate(inputs_, values_, work_);
        const double rate = evaluate_derivative(c, s);
        // Newton's method is safe only well away from the double root of a tangential contact.
        if (!(4 * std::abs(values_[w] * c[2]) < rate * rate))
            return s;
        s = std::max(0.0, s - values_[w] / rate);
    }
    return s;
}

void Trajectory::make_contact(std::size_t w, double s) {
    const auto& mode = simulation_->compiled().mode(mode_);
    const std::size_t event = mode.watched[w];
    const std::size_t transition = mode.transitions[w];
    const double rate = evaluate_derivative(event_series(w), s);
    fields_.resize(2 * states_);
    for (std::size_t i = 0; i < states_; ++i) {
        before_[i] = evaluate_state(i, s);
        fields_[i] = evaluate_derivative(series(i), s);
    }
    if (tangents_) {
        row_.resize(tangents_->directions());
        tangents_->evaluate(mode_, state_, s, {}, w, row_);
        tangents_->advance(mode_, state_, s);
        if (std::abs(rate) * previous_step_ <= roundoff * series_size(event_series(w), previous_step_))
            tangents_->invalidate();
        else
            for (double& shift : row_)
                shift /= -rate;
    }
    add_time(s);
    remember_contact(event, rate);
    histories_[event].transition = transition;
    std::copy(before_.begin(), before_.end(), inputs_.begin());
    values_.resize(mode.events.outputs());
    mode.events.evaluate(inputs_, values_, work_);
    for (std::size_t other = 0; other < mode.watched.size(); ++other)
        surface_values_[mode.watched[other]] = values_[other];
    Contact contact;
    contact.kind = ContactKind::crossing;
    contact.event = event;
    contact.value = values_[w];
    contact.simultaneous = contacts_now_ > 0;
    contact.rate_before = rate;
    pending_ = contact;
    apply_transition(transition, rate);
}

/// Makes the transition's jump from `before_` and finds the next mode.
void Trajectory::apply_transition(std::size_t transition, double rate) {
    const Model& model = simulation_->model();
    const auto& compiled = simulation_->compiled().transition(transition);
    pending_->transition = transition;
    pending_->time = time_;
    pending_->mode_before = pending_->mode_after = mode_;
    pending_->rate_before = rate;
    served_ = pending_->event;
    stuck_ = false;
    jump(compiled.jump);
    bool ends = false;
    const auto next = next_mode(transition, ends);
    if (!next) {
        const Transition& definition = model.transitions[transition];
        hand_over_contact();
        state_ = after_;
        if (ends)
            return finish(Ending::terminal, time_);
        return finish(
            Ending::no_transition, time_,
            fmt::format("no condition of transition '{}' (mode '{}', event '{}') holds at time {:.15g}: add an "
                        "alternative without a condition, or one that covers this state",
                        definition.label, model.modes[definition.mode].name, model.events[definition.event].name,
                        time_));
    }
    enter(compiled.jump, *next);
    if (!finished() && contacts_now_ > simulation_->options().contacts_at_once)
        judge_stand_still();
}

void Trajectory::jump(std::size_t jump) {
    std::copy(before_.begin(), before_.end(), inputs_.begin());
    simulation_->compiled().jump(jump).map.evaluate(inputs_, after_, work_);
}

std::optional<std::size_t> Trajectory::next_mode(std::size_t transition, bool& ends) {
    std::copy(after_.begin(), after_.end(), inputs_.begin());
    for (const auto& alternative : simulation_->compiled().transition(transition).next) {
        conditions_.resize(alternative.strict.size());
        alternative.conditions.evaluate(inputs_, conditions_, work_);
        bool holds = true;
        for (std::size_t i = 0; i < conditions_.size(); ++i)
            holds = holds && (alternative.strict[i] ? conditions_[i] > 0 : conditions_[i] >= 0);
        if (holds) {
            ends = !alternative.mode.has_value();
            return alternative.mode;
        }
    }
    return std::nullopt;
}

/// Goes on in a mode from `after_`, reached from `before_` by a jump whose time depends on the initial state as
/// `row_` says.
void Trajectory::enter(std::size_t jump, std::size_t mode) {
    const CompiledModel& compiled = simulation_->compiled();
    if (tangents_) {
        jacobian_.resize(states_ * (states_ + parameters_.size()));
        std::copy(before_.begin(), before_.end(), inputs_.begin());
        compiled.jump(jump).jacobian.evaluate(inputs_, jacobian_, work_);
        std::copy(after_.begin(), after_.end(), inputs_.begin());
        const auto field_after = std::span<double>(fields_).subspan(states_, states_);
        compiled.mode(mode).rates.evaluate(inputs_, field_after, work_);
        if (tangents_->valid())
            tangents_->pass_jump(row_, std::span<const double>(fields_).first(states_), jacobian_, field_after);
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
    mode_ = mode;
    wrap_cyclic_states(true);
    arc_start_ = true;
    ++contacts_now_;
}

/// Too many contacts at one time are the end of an accumulation that other rules did not see (as of a block that rocks
/// from one edge to the other) if each was slower than the one before, and otherwise modes that go round in a circle.
void Trajectory::judge_stand_still() {
    const ContactHistory history = histories_[served_];
    hand_over_contact();
    if (history.count >= simulation_->options().contacts_at_once / 20) {
        before_ = state_;
        if (tangents_)
            row_.assign(tangents_->directions(), 0.0);
        return come_to_rest(served_, history.transition, 0);
    }
    finish(Ending::no_progress, time_,
           fmt::format("{} events happened at once {}: look for modes that hand over to one another in a circle",
                       contacts_now_, where()));
}

void Trajectory::remember_contact(std::size_t event, double rate) {
    ContactHistory& history = histories_[event];
    ++contacts_;
    history.count = history.count > 0 && rate > history.rate ? history.count + 1 : 1;
    history.interrupted = contacts_ != history.serial + 1;
    history.serial = contacts_;
    history.flight = time_ - history.time;
    history.time = time_;
    history.rate = rate;
    history.previous_speed = history.speed;
    history.speed = 0;
}

/// Contacts at one barrier that follow each other ever faster come to an end in finite time (Budd and Dux 1994).
/// With speed u and deceleration a after a contact, and speeds that fall by a factor r each, what remains takes
/// 2u / (a (1 - r)); when other events come in between, the flights themselves tell it. It is taken at once when it
/// is so short that all else is constant to within tolerance.
bool Trajectory::complete_chatter(std::size_t w, double step) {
    ContactHistory& history = histories_[simulation_->compiled().mode(mode_).watched[w]];
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
    const double allowed = std::max(4 * epsilon, 0.01 * simulation_->options().tolerance);
    const double height = deceleration * remaining * remaining;
    const double change = std::abs(lengthening);
    const double neglected =
        history.interrupted ? change : 4 * (change * change + std::abs(c[4] / c[2]) * steady * steady);
    // Lower flights would be made of the round-off of the states.
    const double low = std::max(allowed * series_size(c, step), 16 * roundoff * terms_[0]);
    if (height > low || !(change < 0.01) || !(neglected * steady <= allowed * step) ||
        remaining > (end_time_ - time_) - time_low_ || (!history.interrupted && another_event_within(w, remaining)))
        return false;
    // Where each contact changes the mode, as when it makes a frame slip that soon stops again, the accumulation is
    // that of the transition by which the contacts are made.
    stick(w, history.transition, remaining, (deceleration - 3 * c[3] * remaining) * remaining - speed);
    return true;
}

bool Trajectory::another_event_within(std::size_t w, double time) {
    for (std::size_t other = 0; other < simulation_->compiled().mode(mode_).watched.size(); ++other) {
        const auto c = event_series(other);
        if (other != w && c[0] > 0 && c[0] + time * c[1] < 0)
            return true;
    }
    return false;
}

/// Ends an accumulation of contacts `remaining` after the present state: what the contacts still to come do to the
/// event function's rate, `impulse` in all, they do to the state in the proportions of the last one.
void Trajectory::stick(std::size_t w, std::size_t index, double remaining, double impulse) {
    const std::size_t event = simulation_->compiled().mode(mode_).watched[w];
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
    add_time(remaining);
    come_to_rest(event, index, c[1]);
}

/// Makes the sticking that a transition declares, from `before_`.
void Trajectory::come_to_rest(std::size_t event, std::size_t index, double rate) {
    const Transition& transition = simulation_->model().transitions[index];
    histories_[event] = {};
    if (!transition.chatter) {
        state_ = before_;
        return finish(
            Ending::chatter, time_,
            fmt::format("contacts at barrier '{}' accumulate in mode '{}' at time {:.15g}, and its transition "
                        "does not say what follows: give it `chatter = {{ jump = ..., mode = ... }}`",
                        simulation_->model().events[event].name, simulation_->model().modes[mode_].name, time_));
    }
    Contact contact;
    contact.kind = ContactKind::sticking;
    contact.time = time_;
    contact.event = event;
    contact.transition = index;
    contact.mode_before = mode_;
    contact.rate_before = rate;
    pending_ = contact;
    served_ = no_event;
    stuck_ = true;
    jump(transition.chatter->jump);
    enter(transition.chatter->jump, transition.chatter->mode);
}

/// Derivatives of the state and time of accumulation: its time changes with the speed after the last contact.
void Trajectory::carry_tangents_to_rest(std::size_t w, double remaining, double per_impulse) {
    const auto c = event_series(w);
    row_.assign(tangents_->directions(), 0.0);
    if (!(remaining > 0))
        return;
    // Derivatives are those at a fixed time, at which a neighbour is `lead` away from the surface that it left with a
    // speed that has changed by `row_` and by the deceleration since.
    std::vector<double> lead(row_.size()), curvature(row_.size());
    tangents_->coefficient(mode_, state_, w, 0, lead);
    tangents_->coefficient(mode_, state_, w, 2, curvature);
    tangents_->coefficient(mode_, state_, w, 1, row_);
    for (std::size_t d = 0; d < row_.size(); ++d) {
        lead[d] /= c[1];
        row_[d] -= 2 * c[2] * lead[d];
    }
    // d(remaining)/d(speed), and the impulse a (remaining) - u that goes with it
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
