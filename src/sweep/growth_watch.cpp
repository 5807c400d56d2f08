#include "sweep/growth_watch.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace graze {

namespace {

constexpr std::size_t growing_parts = 3; ///< number of parts of the stored returns; the motion must be larger in each
constexpr std::size_t fewest_returns = 6;

} // namespace

void GrowthWatch::begin(std::span<const double> parameters, std::span<const double> periods) {
    workspace_ = field_->workspace(parameters);
    periods_.assign(periods.begin(), periods.end());
    mark_.clear();
}

void GrowthWatch::mark(const ReturnWatcher& motion) {
    mark_ = extents(motion.part(0));
}

std::vector<double> GrowthWatch::extents(const MotionPart& one) const {
    std::vector<double> result(periods_.size());
    for (std::size_t i = 0; i < result.size(); ++i)
        result[i] = one.extent(i);
    return result;
}

double GrowthWatch::ratio(std::span<const double> now, std::span<const double> before) const {
    double largest = 0;
    for (std::size_t i = 0; i < std::min(now.size(), before.size()); ++i)
        if (!(periods_[i] > 0) && map_->takes_part(i) && before[i] > 0)
            largest = std::max(largest, now[i] / before[i]);
    return largest > 0 ? std::log(largest) : 0;
}

double GrowthWatch::outward(const ReturnWatcher& motion) const {
    return motion.remembered() > 0 ? ratio(extents(motion.part(0)), mark_) : 0;
}

bool GrowthWatch::outgrows_everything(const ReturnWatcher& motion) const {
    constexpr double decades = 60;
    const double size = motion.widest().empty() ? 0 : *std::ranges::max_element(motion.widest());
    return since_start(motion) > decades * std::log(10.0) && size > std::pow(10.0, decades);
}

bool GrowthWatch::goes_on(const ReturnWatcher& motion) {
    if (motion.remembered() <= fewest_returns)
        return false;
    // If clocks are faster than the growth, single returns show only a part of the motion: several are combined.
    const std::size_t together = (motion.remembered() - 1) / growing_parts;
    std::vector<double> newer;
    MotionPart newest, oldest;
    for (std::size_t part = 0; part < growing_parts; ++part) {
        std::vector<double> largest(periods_.size(), 0.0);
        oldest = motion.part(part * together);
        for (std::size_t k = part * together; k < (part + 1) * together; ++k) {
            const MotionPart one = motion.part(k);
            for (std::size_t i = 0; i < largest.size(); ++i)
                largest[i] = std::max(largest[i], one.extent(i));
            oldest.include(one);
        }
        if (part == 0)
            newest = oldest;
        if (oldest.contacts || (part > 0 && !(ratio(newer, largest) > 0)))
            return false;
        newer = largest;
    }
    return leads_outward(motion, newest, oldest);
}

bool GrowthWatch::goes_on_slowly(const ReturnWatcher& motion) {
    const MotionParts& all = motion.parts();
    if (all.count() < growing_parts)
        return false;
    for (std::size_t part = 0; part < growing_parts; ++part)
        if (all.recent(part).contacts ||
            (part > 0 && !(ratio(extents(all.recent(part - 1)), extents(all.recent(part))) > 0)))
            return false;
    return leads_outward(motion, all.recent(0), all.recent(growing_parts - 1));
}

bool GrowthWatch::is_linear(const ReturnWatcher& motion, std::size_t returns) const {
    return field_->is_linear(motion.recent(0).mode) && motion.parts().quiet() >= returns;
}

/// Returns whether the field is affine beyond and no event is ahead of a motion that grew from one part to another.
bool GrowthWatch::leads_outward(const ReturnWatcher& motion, const MotionPart& newest, const MotionPart& oldest) {
    const Return& last = motion.recent(0);
    // If the motion grows about a state, extrapolate the growth on either side.
    std::vector<double> down(periods_.size()), up(periods_.size());
    for (std::size_t i = 0; i < up.size(); ++i) {
        down[i] = std::max(0.0, oldest.least[i] - newest.least[i]);
        up[i] = std::max(0.0, newest.greatest[i] - oldest.greatest[i]);
    }
    return field_->is_affine_beyond(workspace_, last.mode, last.state, extents(newest), periods_) &&
           meets_no_event(last.mode, newest, down, up);
}

bool GrowthWatch::goes_on(const ReturnWatcher& motion, std::span<const double> state, std::size_t mode) {
    if (!field_->is_affine_beyond(workspace_, mode, state, motion.widest(), periods_))
        return false;
    field_->evaluate_rates(workspace_, mode, state);
    // In a growing direction all states move away from their earlier values at the same relative rate; others may
    // rotate.
    constexpr double alike = 3, end = 0.1;
    double slowest = std::numeric_limits<double>::infinity(), fastest = 0;
    MotionPart box{{state.begin(), state.end()}, {state.begin(), state.end()}};
    std::vector<double> down(state.size(), 0.0), up(state.size(), 0.0);
    bool straight = true;
    for (std::size_t i = 0; i < state.size(); ++i) {
        const double range = motion.range(i);
        if (periods_[i] > 0 || !(range > 0) || !map_->takes_part(i))
            continue;
        box.least[i] = std::min(state[i], motion.lowest(i));
        box.greatest[i] = std::max(state[i], motion.lowest(i) + range);
        const bool high = box.greatest[i] - state[i] <= end * range, low = state[i] - box.least[i] <= end * range;
        down[i] = high ? 0 : range;
        up[i] = low ? 0 : range;
        const double rate = workspace_.rates[i] / (high ? range : -range);
        straight = straight && high != low && rate > 0;
        slowest = std::min(slowest, rate);
        fastest = std::max(fastest, rate);
    }
    if (!straight || !(fastest <= alike * slowest))
        for (std::size_t i = 0; i < state.size(); ++i)
            down[i] = up[i] = std::max(down[i], up[i]);
    return meets_no_event(mode, box, down, up);
}

/// Returns whether no event is met in the direction of growth, up to the largest numbers.
/// @param down, up growth of the motion on either side
bool GrowthWatch::meets_no_event(std::size_t mode, const MotionPart& now, std::span<const double> down,
                                 std::span<const double> up) {
    double size = 0;
    for (std::size_t i = 0; i < up.size(); ++i)
        size = std::max({size, down[i], up[i]});
    for (double reach = 1; reach * size < end_of_growth && size > 0; reach *= 10) {
        MotionPart ahead = now;
        for (std::size_t i = 0; i < up.size(); ++i) {
            ahead.least[i] -= reach * down[i];
            ahead.greatest[i] += reach * up[i];
        }
        if (!field_->keeps_sides(workspace_, mode, ahead.least, ahead.greatest, periods_))
            return false;
    }
    return true;
}

} // namespace graze
