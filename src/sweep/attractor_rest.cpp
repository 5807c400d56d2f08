// Motions that are at rest, come to rest, or lie on an unstable orbit or equilibrium.

#include "sweep/attractor_search.hpp"

#include <algorithm>
#include <cmath>

namespace graze {

namespace {

constexpr std::size_t most_disturbances = 3;
constexpr double share_left = 0.1; ///< a motion within this share of the displacement has not been displaced yet
constexpr double neutral_multiplier = 1e-10; ///< distance of a multiplier from 1 that is significant
constexpr double at_rest = 1e-8;             ///< distance at which an orbit and an equilibrium count as the same

} // namespace

/// Determines from the field alone whether the motion is at rest or will come to rest.
/// @return what `proceed` returns, if it could be decided
std::optional<bool> AttractorSearch::consider_rest(std::span<const double> state, std::size_t mode) {
    const auto equilibrium = equilibria_.find(state, mode, watcher_.widest());
    if (!equilibrium)
        return std::nullopt;
    const double distance = equilibria_.distance(*equilibrium, state);
    if (equilibrium->is_stable()) {
        if (equilibria_.is_linear_within(*equilibrium, distance, true) ||
            (comes_closer(*equilibrium) && equilibria_.is_linear_within(*equilibrium, distance, false)))
            return finish_equilibrium(*equilibrium);
        return std::nullopt;
    }
    return equilibrium->is_unstable() ? leave_equilibrium(*equilibrium, distance) : std::nullopt;
}

/// Returns whether a motion about a stable equilibrium has come closer from return to return, at least half as fast as
/// the linear part predicts. (Weakly damped motions become linear to within the damping only at tiny amplitudes.)
bool AttractorSearch::comes_closer(const Equilibrium& equilibrium) {
    constexpr std::size_t fewest = 4;
    const std::size_t last = std::min<std::size_t>(watcher_.remembered(), 2 * fewest + 1);
    if (last <= fewest)
        return false;
    std::vector<double> distances;
    for (std::size_t k = 0; k < last; ++k) {
        const Return& one = watcher_.recent(k);
        if (one.mode != equilibrium.mode || !one.contacts.empty())
            return false;
        distances.push_back(equilibria_.distance(equilibrium, one.state));
        if (k > 0 && !(distances[k - 1] < distances[k]))
            return false;
    }
    const double time = watcher_.recent(0).time - watcher_.recent(last - 1).time;
    return std::log(distances.front() / distances.back()) <= 0.5 * equilibrium.growth() * time;
}

/// Displaces a motion that lies on an unstable equilibrium.
std::optional<bool> AttractorSearch::leave_equilibrium(const Equilibrium& equilibrium, double distance) {
    const double size = setting_->options.disturbance, usual = AttractorOptions{}.disturbance;
    const std::vector<double> state = equilibria_.displaced(equilibrium, size > 0 ? size : usual, main_->state());
    if (!(distance <= share_left * equilibria_.distance(equilibrium, state)))
        return std::nullopt;
    if (size == 0)
        return finish_undisturbed();
    if (disturbances_ >= most_disturbances)
        return std::nullopt;
    ++disturbances_;
    displace(state, equilibrium.mode, watcher_.returns() > 1 ? watcher_.recent(0).time - watcher_.recent(1).time : 0);
    return true;
}

void AttractorSearch::displace(std::span<const double> state, std::size_t mode, double duration) {
    std::ranges::fill(thresholds_, setting_->options.recurrence);
    watcher_.begin_anew();
    collapses_ = 0;
    landing_unseen_ = false;
    restart(state, mode, duration);
    if (exponent_.begun())
        start_exponent();
    if (confirming_)
        limit_ = std::max(limit_, watcher_.returns() + setting_->options.cycles);
    confirming_ = false;
}

/// The motion lies on an unstable orbit or equilibrium, and displacements are not allowed.
bool AttractorSearch::finish_undisturbed() {
    finish(Label::unsettled);
    result_.outcome.detail = "the motion sits on an unstable orbit or equilibrium; allow a disturbance to displace it";
    return false;
}

/// Returns the equilibrium that the orbit represents if nothing but clocks moves along it.
std::optional<Equilibrium> AttractorSearch::equilibrium_of_orbit() {
    auto equilibrium = equilibria_.find(finder_.point(), finder_.mode(), watcher_.widest());
    if (equilibrium && finder_.contacts().empty() && equilibria_.distance(*equilibrium, finder_.point()) < at_rest)
        return equilibrium;
    if (!finder_.contacts().empty() || moves_along_orbit())
        return std::nullopt;
    // Motions approach it more slowly than any linear one.
    equilibrium.emplace();
    equilibrium->state.assign(finder_.point().begin(), finder_.point().end());
    equilibrium->mode = finder_.mode();
    equilibrium->driven = true;
    const bool attracts = finder_.multipliers().empty() || std::abs(finder_.multipliers().front()) < 1;
    return attracts ? equilibrium : std::nullopt;
}

/// Returns whether anything except clocks moves along the orbit. A state that is moved by a clock counts, even without
/// a nonzero derivative.
bool AttractorSearch::moves_along_orbit() {
    constexpr double nothing = 1e-10; ///< relative to the states and the extent of the motion
    for (std::size_t i = 0; i < periods_.size(); ++i)
        if (setting_->map.takes_part(i) && !equilibria_.is_clock(i, finder_.point(), finder_.mode()) &&
            !(finder_.extents()[i] <= nothing * std::max(watcher_.range(i), std::abs(finder_.point()[i]))))
            return true;
    return false;
}

/// Returns whether this state of the orbit, along which there are no contacts, is beyond the surface of an event that
/// the motion has still ahead: then there will be a contact on the way.
bool AttractorSearch::is_behind_event(std::span<const double> state) {
    if (!finder_.contacts().empty())
        return false;
    FieldMap::Workspace workspace = setting_->field.workspace(parameters_);
    setting_->field.evaluate_events(workspace, finder_.mode(), watcher_.recent(0).state);
    const std::vector<double> here = workspace.events;
    setting_->field.evaluate_events(workspace, finder_.mode(), state);
    for (std::size_t w = 0; w < setting_->simulation.system().mode(finder_.mode()).watched.size(); ++w)
        if (here[w] > 0 && workspace.events[w] < 0)
            return true;
    return false;
}

/// Returns whether the orbit is a point: Newton's method has converged to a corner where modes meet and nothing moves
/// in any of them. Motions about such a corner look alike on all scales, so the return map has no derivative there.
bool AttractorSearch::has_no_size() {
    constexpr double nothing = 1e-10; ///< relative to the extent of the motion
    const std::vector<std::uint32_t>& contacts = finder_.contacts();
    const System& system = setting_->simulation.system();
    const auto jumps = [&](std::uint32_t code) { return system.transition(code / 2).jump != 0; };
    if (contacts.empty() || std::ranges::any_of(contacts, jumps))
        return false;
    const std::span<const double> all = equilibria_.rates(finder_.point(), finder_.mode());
    const std::vector<double> rates(all.begin(), all.end());
    bool any = false;
    for (std::size_t i = 0; i < periods_.size(); ++i) {
        if (!setting_->map.takes_part(i) || equilibria_.is_clock(i, finder_.point(), finder_.mode()))
            continue;
        any = true;
        const double least = nothing * watcher_.range(i);
        if (!(finder_.extents()[i] <= least && std::abs(rates[i]) * finder_.duration() <= least))
            return false;
    }
    return any;
}

/// Returns whether a motion about such a corner has come to rest: it has shrunk to almost nothing, from return to
/// return.
bool AttractorSearch::shrinks_to_a_corner() {
    constexpr double nothing = 1e-10;
    if (watcher_.remembered() < 3)
        return false;
    const MotionPart newest = watcher_.part(0), oldest = watcher_.part(watcher_.remembered() - 2);
    for (std::size_t i = 0; i < periods_.size(); ++i)
        if (setting_->map.takes_part(i) && !equilibria_.is_clock(i, finder_.point(), finder_.mode()) &&
            !(newest.extent(i) <= nothing * watcher_.range(i) && newest.extent(i) < oldest.extent(i)))
            return false;
    finish_limit("the motion shrinks towards a corner between modes, where there are no multipliers");
    return true;
}

/// The result of Newton's method is the place where the motion finally comes to rest, not an orbit.
void AttractorSearch::finish_limit(std::string_view detail) {
    Equilibrium limit;
    limit.state.assign(finder_.point().begin(), finder_.point().end());
    limit.mode = finder_.mode();
    limit.driven = true;
    finish_equilibrium(limit);
    result_.multipliers.clear();
    result_.lyapunov.reset();
    result_.outcome.detail = detail;
}

/// Returns whether the orbit's excursions into other modes, such as slips that a force barely causes, have shrunk to
/// nothing: Newton's method has followed them to their vanishing point. That point is a double root, so that each step
/// covers half of the distance until round-off closes the orbit.
bool AttractorSearch::vanishes_at_rest() {
    const std::vector<std::uint32_t>& contacts = finder_.contacts();
    const auto mode_before = [&](std::size_t k) {
        return setting_->simulation.model().transitions[contacts[k % contacts.size()] / 2].mode;
    };
    for (std::size_t k = 0; k < contacts.size(); ++k)
        if (mode_before(k) == mode_before(k + 1))
            return false;
    return !contacts.empty() && !moves_along_orbit() && is_neutral();
}

/// A motion that approaches such a place by less with every period does so forever.
bool AttractorSearch::approaches_rest_slowly() {
    if (!approaches_slowly(finder_, watcher_, periods_))
        return false;
    finish_limit(
        "the motion creeps to rest: all that happens to it becomes less from return to return, and more slowly "
        "than by any factor");
    return true;
}

/// Keeps states with constant sign away from zero, which no motion leaves, by a tiny value, since the next point of a
/// sweep starts from there. It is a share of the length over which the field is linear or, if that is unlimited, of the
/// extent of the motion; it does not decrease from point to point.
void AttractorSearch::keep_signs(std::vector<double>& state) {
    constexpr double next_to_nothing = 1e-20;
    for (std::size_t i = 0; i < state.size(); ++i)
        if (const double here = main_->state()[i]; setting_->field.keeps_sign(i) && state[i] == 0 && here != 0) {
            const double length = equilibria_.linear_length(state, main_->mode(), i, std::abs(here));
            const double least = std::min(std::abs(here), next_to_nothing * watcher_.range(i));
            state[i] = std::copysign(length > 0 ? next_to_nothing * length : least, here);
        }
}

/// A motion on an unstable orbit would stay there until round-off has grown: displaces it.
std::optional<bool> AttractorSearch::leave_unstable_orbit(const Equilibrium* equilibrium) {
    const double size = setting_->options.disturbance, usual = AttractorOptions{}.disturbance;
    if (finder_.multipliers().empty() || !(std::abs(finder_.multipliers().front()) > 1 + neutral_multiplier) ||
        disturbances_ >= most_disturbances ||
        watcher_.distance(watcher_.recent(0).state, finder_.point()) > (size > 0 ? size : usual))
        return std::nullopt;
    if (size == 0)
        return finish_undisturbed();
    ++disturbances_;
    const double duration = finder_.duration() / static_cast<double>(finder_.period());
    if (equilibrium) {
        displace(equilibria_.displaced(*equilibrium, size, main_->state()), finder_.mode(), duration);
        return true;
    }
    const std::span<const double> scale = watcher_.scale();
    std::vector<double> state(finder_.point().begin(), finder_.point().end()), deviation(state.size());
    subtract_states(watcher_.recent(0).state, state, periods_, deviation);
    const Eigen::VectorXd& direction = finder_.leading_direction();
    double length = 0, along = 0;
    for (std::size_t i = 0; i < state.size(); ++i) {
        const double component = direction[static_cast<Eigen::Index>(i)] / scale[i];
        length = std::max(length, std::abs(component));
        along += component * deviation[i] / scale[i];
    }
    if (!(length > 0))
        return std::nullopt;
    const auto along_direction = [&](std::size_t i) { return direction[static_cast<Eigen::Index>(i)] / length; };
    const auto is_on_edge = [&](std::size_t i) { return setting_->field.keeps_sign(i) && state[i] == 0; };
    double share = along < 0 ? -size : size, strongest = 0;
    for (std::size_t i = 0; i < state.size(); ++i)
        if (is_on_edge(i) && std::abs(along_direction(i)) / scale[i] > strongest) {
            strongest = std::abs(along_direction(i)) / scale[i];
            share = (main_->state()[i] < 0) == (along_direction(i) < 0) ? size : -size;
        }
    for (std::size_t i = 0; i < state.size(); ++i)
        if (const double change = share * along_direction(i); !is_on_edge(i) || (main_->state()[i] < 0) == (change < 0))
            state[i] += change;
    displace(state, finder_.mode(), duration);
    return true;
}

} // namespace graze
