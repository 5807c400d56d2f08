// The start of an arc: on which side of each watched event's surface it begins, and what happens there at once.

#include "graze/trajectory/trajectory.hpp"

#include "trajectory/probe_tracker.hpp"
#include "trajectory/series.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace graze {

namespace {

/// A jump that keeps the motion at the surface leaves the event function at round-off, which the sizes of the
/// terms of the function and of the jump may magnify.
constexpr double served_roundoff = 1e-10;

/// What rests on a surface and is released when the force that presses it there reaches zero has a force at round-off
/// left, of either sign, and perhaps a speed. They decide nothing if they are outgrown within these shares of a full
/// step.
constexpr double instant_of_speed = 1e-13, instant_of_force = 1e-9;

} // namespace

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

} // namespace graze
