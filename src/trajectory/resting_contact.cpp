// Where accumulating impacts with friction lead: whether the contact that comes to rest sticks or slips is told by its
// tangential velocity, not by the last impacts, whose impulses are of the size of round-off.

#include "graze/trajectory/trajectory.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace graze {

/// Returns how much the rest of a transition would change the velocities of `before_`, or how far the direction of a
/// slip is from that of the mode of rest.
double Trajectory::change_by_rest(const Transition& transition) {
    const Model& model = simulation_.model();
    const System& system = simulation_.system();
    const System::CompiledMode& mode = system.mode(transition.chatter->mode);
    std::vector<double> inputs(inputs_), after(states_), values(mode.events.outputs());
    std::copy(before_.begin(), before_.end(), inputs.begin());
    system.jump(transition.chatter->jump).map.evaluate(inputs, after, work_);
    double change = 0;
    for (const std::size_t velocity : model.contact_settings.velocities)
        change = std::max(change, std::abs(after[velocity] - before_[velocity]));
    std::copy(before_.begin(), before_.end(), inputs.begin());
    mode.events.evaluate(inputs, values, work_);
    for (const UnilateralContact& contact : model.contacts)
        for (const char* direction : {"-stops-forward", "-stops-backward"})
            if (const auto event = model.find_event(contact.name + direction))
                if (const auto found = std::ranges::find(mode.watched, *event); found != mode.watched.end())
                    change = std::max(change, -values[static_cast<std::size_t>(found - mode.watched.begin())]);
    return std::isfinite(change) ? change : std::numeric_limits<double>::infinity();
}

/// Returns the transition by which contacts at `before_` come to rest: of the cases of one impact that whose rest
/// changes velocities least, if that is far less than by the rest of the case that the last impact was.
/// @param known the case of the last impact; none if the contact closes without an impact
std::optional<std::size_t> Trajectory::transition_to_rest(std::size_t event, std::optional<std::size_t> known) {
    const Model& model = simulation_.model();
    const auto watched = std::ranges::find(compiled_mode_->watched, event);
    const auto is_of_contact = [&](const UnilateralContact& one) {
        return one.friction && one.name == model.events[event].name;
    };
    if (watched == compiled_mode_->watched.end() || std::ranges::none_of(model.contacts, is_of_contact))
        return known;
    constexpr double far_less = 1e-3;
    std::optional<std::size_t> best;
    double least = 0;
    if (known && model.transitions[*known].chatter && model.transitions[*known].derived) {
        best = known;
        least = far_less * change_by_rest(model.transitions[*known]);
    } else if (known && !model.transitions[*known].derived) {
        return known;
    }
    const std::vector<std::size_t> also = known ? model.transitions[*known].also : std::vector<std::size_t>{};
    for (std::optional<std::size_t> next =
             compiled_mode_->transitions[static_cast<std::size_t>(watched - compiled_mode_->watched.begin())];
         next; next = simulation_.system().transition(*next).following) {
        const Transition& one = model.transitions[*next];
        if (!one.chatter || !one.derived || one.also != also)
            continue;
        const double change = change_by_rest(one);
        if (!best || change < least) {
            best = next;
            least = change;
        }
    }
    return best ? best : known;
}

} // namespace graze
