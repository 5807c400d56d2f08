// Surfaces that are crossed in turn, ever faster: a spiral of infinitely many turns in a finite time, into the place
// where two surfaces of slides meet.

#include "graze/trajectory/trajectory.hpp"

#include "trajectory/series.hpp"
#include "trajectory/tangents.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <span>

namespace graze {

namespace {

/// A turn has at most this many crossings; this many turns, and the crossing before, tell whether they become shorter.
constexpr std::size_t longest_turn = 8, turns_told = 3;

/// Returns whether a passage crosses the surface of a slide from one side to the other.
template <class Crossing>
bool crosses(const Crossing& one, const Slide& slide) {
    return (one.mode_before == slide.left && one.mode_after == slide.right) ||
           (one.mode_before == slide.right && one.mode_after == slide.left);
}

/// Returns whether passages cross the surfaces of slides, at least two of them.
template <class Crossing>
bool crosses_slides(const Model& model, std::span<const Crossing> turn) {
    std::set<std::size_t> surfaces;
    for (const Crossing& one : turn) {
        const auto crossed =
            std::ranges::find_if(model.slides, [&](const Slide& slide) { return crosses(one, slide); });
        if (crossed == model.slides.end())
            return false;
        surfaces.insert(crossed->surface);
    }
    return surfaces.size() > 1;
}

} // namespace

void Trajectory::remember_crossing(std::size_t event, std::size_t mode_before) {
    if (simulation_.model().slides.empty())
        return;
    if (mode_ == mode_before)
        return crossings_.clear();
    if (crossings_.size() > turns_told * longest_turn)
        crossings_.erase(crossings_.begin());
    crossings_.push_back({event, mode_before, mode_, time_, time_low_, state_});
}

/// Returns the number of crossings after which they repeat; 0 if they do not.
std::size_t Trajectory::length_of_turn() const {
    const std::size_t n = crossings_.size();
    for (std::size_t turn = 2; turn <= longest_turn && turns_told * turn < n; ++turn) {
        bool repeats = true;
        for (std::size_t k = n - turns_told * turn; k < n && repeats; ++k)
            repeats = crossings_[k].mode_before == crossings_[k - 1].mode_after &&
                      (k + turn >= n || (crossings_[k].event == crossings_[k + turn].event &&
                                         crossings_[k].mode_before == crossings_[k + turn].mode_before));
        if (repeats)
            return turn;
    }
    return 0;
}

/// Returns whether an event's function is as small as the flights below which `complete_chatter` completes.
bool Trajectory::is_at_surface(std::size_t event, double step) {
    const Function& function = simulation_.system().event(event);
    values_.resize(std::max(values_.size(), function.outputs()));
    function.evaluate(inputs_, values_, work_);
    double terms = 0, way = 0;
    for (std::size_t i = 0; i < states_; ++i) {
        terms += std::abs(values_[1 + i] * state_[i]);
        way += std::abs(values_[1 + i] * series_[i][1]) * step;
    }
    const double allowed = share_of_last_flights(simulation_.options().tolerance);
    return std::abs(values_[0]) <= std::max(allowed * way, 16 * roundoff * terms);
}

/// Completes a spiral: turns that become shorter by a constant factor end in finite time, where the surfaces meet. The
/// motion goes on as one that comes there along one of them.
bool Trajectory::complete_spiral(double step) {
    const std::size_t turn = length_of_turn();
    if (turn == 0 || !crosses_slides(simulation_.model(), std::span<const Crossing>(crossings_).last(turn)))
        return false;
    const std::size_t n = crossings_.size();
    const auto duration = [&](std::size_t back) { // of a turn, the last one first
        const Crossing &end = crossings_[n - 1 - back * turn], &start = crossings_[n - 1 - (back + 1) * turn];
        return (end.time - start.time) + (end.time_low - start.time_low);
    };
    constexpr double same = 0.1;
    const double factor = duration(0) / duration(1), before = duration(1) / duration(2);
    if (!(factor > 0 && factor < 1 && before < 1 && std::abs(factor - before) <= same))
        return false;
    const double remaining = duration(0) * factor / (1 - factor);
    // Short as the time that is left may be, most of it may be many turns.
    constexpr double hardly_any = 1e-12;
    std::copy(state_.begin(), state_.end(), inputs_.begin());
    const auto is_near = [&](const Crossing& one) { return is_at_surface(one.event, step); };
    if (remaining > hardly_any * std::max(std::abs(time_ - start_time_), largest_step_) &&
        contacts_now_ <= static_cast<int>(turns_told * turn) &&
        !std::all_of(crossings_.end() - static_cast<std::ptrdiff_t>(turn), crossings_.end(), is_near))
        return false;
    const auto in_turn = [&](std::size_t event) {
        return std::any_of(crossings_.end() - static_cast<std::ptrdiff_t>(turn), crossings_.end(),
                           [&](const Crossing& one) { return one.event == event; });
    };
    if (remaining > (end_time_ - time_) - time_low_)
        return false;
    for (std::size_t w = 0; w < compiled_mode_->watched.size(); ++w)
        if (const auto c = event_series(w); !in_turn(compiled_mode_->watched[w]) && falls_within(c, remaining))
            return false;
    const auto transition = transition_at_corner(turn);
    fields_.resize(2 * states_);
    for (std::size_t i = 0; i < states_; ++i) {
        fields_[i] = series_[i][1];
        // All changes fall like the durations.
        const double change = state_[i] - crossings_[n - 1 - turn].state[i];
        before_[i] = state_[i] + (periods_[i] > 0 ? remaining * fields_[i] : change * factor / (1 - factor));
    }
    if (tangents_) {
        row_.assign(tangents_->directions(), 0.0);
        tangents_->invalidate();
    }
    add_time(remaining);
    crossings_.clear();
    if (!transition) {
        state_ = before_;
        finish(Ending::chatter, time_,
               fmt::format("crossings of the surface of '{}' and others accumulate {}, and no mode slides along all of "
                           "them: give each pair of modes beside them a slide, or end the motion before by an event",
                           simulation_.model().events[start_event_].name, where()));
        return true;
    }
    Contact contact;
    contact.kind = ContactKind::sticking;
    contact.event = simulation_.model().transitions[*transition].event;
    pending_ = contact;
    apply_transition(*transition, 0);
    if (finished())
        return true;
    pending_->kind = ContactKind::sticking;
    start_event_ = no_event;
    stuck_ = true;
    return true;
}

/// Returns the transition of a motion along one of the surfaces that meets the other.
std::optional<std::size_t> Trajectory::transition_at_corner(std::size_t turn) const {
    const Model& model = simulation_.model();
    const auto first = crossings_.end() - static_cast<std::ptrdiff_t>(turn);
    const auto is_crossed = [&](const Slide& slide) {
        return std::any_of(first, crossings_.end(), [&](const Crossing& one) { return crosses(one, slide); });
    };
    for (const Slide& slide : model.slides) {
        const auto along = model.find_mode(slide.name);
        if (!along || !is_crossed(slide))
            continue;
        for (std::size_t t = 0; t < model.transitions.size(); ++t) {
            const Transition& one = model.transitions[t];
            const auto leads_to_corner = [&](const Alternative& way) {
                return way.mode && model.modes[*way.mode].slides_on.size() == 2;
            };
            if (one.mode == *along && std::ranges::any_of(one.next, leads_to_corner) &&
                std::any_of(first, crossings_.end(), [&](const Crossing& each) { return each.event == one.event; }))
                return t;
        }
    }
    return std::nullopt;
}

} // namespace graze
