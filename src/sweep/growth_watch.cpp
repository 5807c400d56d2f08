#include "sweep/growth_watch.hpp"

#include <algorithm>
#include <cmath>

namespace graze {

namespace {

constexpr std::size_t parts = 3; ///< of the returns that are remembered, in each of which the motion is larger
constexpr std::size_t fewest_returns = 6;

} // namespace

void GrowthWatch::begin(std::span<const double> parameters, std::span<const double> periods) {
    workspace_ = field_->workspace(parameters);
    periods_.assign(periods.begin(), periods.end());
    mark_.clear();
}

void GrowthWatch::mark(const ReturnWatcher& motion) {
    mark_ = extents(motion.recent(0));
}

std::vector<double> GrowthWatch::extents(const Return& one) const {
    std::vector<double> result(one.state.size());
    for (std::size_t i = 0; i < result.size(); ++i)
        result[i] = one.greatest[i] - one.least[i];
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
    return motion.remembered() > 0 ? ratio(extents(motion.recent(0)), mark_) : 0;
}

bool GrowthWatch::goes_on(const ReturnWatcher& motion) {
    if (motion.remembered() <= fewest_returns)
        return false;
    // Where clocks are faster than what grows, single returns see a part of it only: they are taken together.
    const std::size_t together = (motion.remembered() - 1) / parts;
    std::vector<double> newer;
    for (std::size_t part = 0; part < parts; ++part) {
        std::vector<double> largest(periods_.size(), 0.0);
        for (std::size_t k = part * together; k < (part + 1) * together; ++k) {
            const std::vector<double> one = extents(motion.recent(k));
            for (std::size_t i = 0; i < one.size(); ++i)
                largest[i] = std::max(largest[i], one[i]);
            if (!motion.recent(k).contacts.empty())
                return false;
        }
        if (part > 0 && !(ratio(newer, largest) > 0))
            return false;
        newer = largest;
    }
    return goes_on(motion.recent(0).state, motion.recent(0).mode, extents(motion.recent(0)));
}

bool GrowthWatch::goes_on(std::span<const double> state, std::size_t mode, std::span<const double> extents) {
    return field_->is_affine_beyond(workspace_, mode, state, extents, periods_);
}

} // namespace graze
