// Motion along surfaces in modes that slides and frictions have made: where it may begin, and two-folds.

#include "graze/trajectory/trajectory.hpp"

#include "trajectory/series.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace graze {

namespace {

/// A start this close to the surface is on it: relative to the terms of its function, and to its way in a unit of time.
constexpr double start_distance = 1e-6;

/// Both ends of sliding happen at once where the one that has not happened yet has come this close to zero, relative to
/// its largest value. A motion that runs into a two-fold cannot be resolved closer than about 1e-12.
constexpr double two_fold_at_event = 1e-9, near_end_of_series = 1e-6; // also for other ends at a zero

} // namespace

/// A mode that moves along a surface does not find out by itself whether it is there.
bool Trajectory::begins_beside_surface() {
    const Model& model = simulation_.model();
    std::copy(state_.begin(), state_.end(), inputs_.begin());
    for (const SlidingSurface& along : model.modes[mode_].slides_on) {
        const Function& function = simulation_.system().event(along.surface);
        values_.resize(std::max(values_.size(), function.outputs()));
        function.evaluate(inputs_, values_, work_);
        const double value = values_[0];
        double near = 0;
        for (std::size_t i = 0; i < states_; ++i)
            near += std::abs(values_[1 + i] * state_[i]);
        for (const std::size_t exit : along.exits) {
            const Function& push = simulation_.system().event(exit);
            values_.resize(std::max(values_.size(), push.outputs()));
            push.evaluate(inputs_, values_, work_);
            near += std::abs(values_[0]);
        }
        if (!(std::abs(value) > start_distance * near))
            continue;
        finish(
            Ending::inadmissible, time_,
            fmt::format("mode '{}' moves along the surface of the event '{}', whose function is {:.6g} and not 0 {}: "
                        "choose another initial mode, or a state on the surface",
                        model.modes[mode_].name, model.events[along.surface].name, value, where()));
        return true;
    }
    return false;
}

/// Returns whether an event that ends sliding happens where the other end of the same sliding motion happens too.
bool Trajectory::is_two_fold(std::size_t event, double s) {
    for (const SlidingSurface& along : simulation_.model().modes[mode_].slides_on)
        for (const std::size_t exit : along.exits)
            if (const bool happens = event == along.exits[0] || event == along.exits[1]; happens && exit != event)
                return is_near_zero(exit, s, two_fold_at_event);
    return false;
}

/// Returns whether the series end where sliding ends to both sides.
bool Trajectory::ends_at_two_fold() {
    return std::ranges::any_of(simulation_.model().modes[mode_].slides_on, [&](const SlidingSurface& along) {
        return along.exits[0] != along.exits[1] && is_near_zero(along.exits[0], 0, near_end_of_series) &&
               is_near_zero(along.exits[1], 0, near_end_of_series);
    });
}

bool Trajectory::is_near_zero(std::size_t event, double s, double share) {
    const auto& watched = compiled_mode_->watched;
    const auto place = std::ranges::find(watched, event);
    return place != watched.end() &&
           evaluate_polynomial(event_series(static_cast<std::size_t>(place - watched.begin())), s) <=
               share * event_sizes_[event].largest;
}

void Trajectory::finish_at_two_fold(double time) {
    const Mode& mode = simulation_.model().modes[mode_];
    const SlidingSurface& along = mode.slides_on.front();
    const std::vector<Event>& events = simulation_.model().events;
    finish(
        Ending::two_fold, time,
        fmt::format("the motion along the surface of '{}' reaches a two-fold {}: '{}' and '{}' happen at once, and the "
                    "motion beyond is not unique: end it before by an event, or change the parameters",
                    events[along.surface].name, where(), events[along.exits[0]].name, events[along.exits[1]].name));
}

/// Contact forces with friction grow without bound where the determinant of their equations falls to zero.
bool Trajectory::finish_at_paradox(double time) {
    for (std::size_t w = 0; w < compiled_mode_->watched.size(); ++w) {
        const Transition& only = simulation_.model().transitions[compiled_mode_->transitions[w]];
        if (only.paradox && only.next.front().when_text == "never" &&
            is_near_zero(compiled_mode_->watched[w], 0, near_end_of_series)) {
            finish_otherwise(only, time);
            return true;
        }
    }
    return false;
}

} // namespace graze
