#include "graze/base/time_left.hpp"

#include <algorithm>

namespace graze {

namespace {

constexpr std::size_t few_points = 10;  ///< too few for an estimate
constexpr double of_late = 1.0 / 3;     ///< "recent" is this fraction of the elapsed time
constexpr double between_moments = 0.2; ///< seconds between stored moments
constexpr double more = 1.2;            ///< an estimate that has grown by this factor has not done so by chance

} // namespace

void TimeLeft::note(std::size_t computed, double seconds) {
    now_ = {computed, seconds};
    if (moments_.empty() || seconds - moments_.back().seconds >= between_moments)
        moments_.push_back(now_);
    while (moments_.size() > 2 && moments_[1].seconds < (1 - of_late) * seconds)
        moments_.pop_front();
}

std::optional<double> TimeLeft::seconds_of_a_point() const {
    if (now_.computed < few_points)
        return std::nullopt;
    const double mean = now_.seconds / static_cast<double>(now_.computed);
    const Moment& then = moments_.front();
    if (now_.computed - then.computed < few_points)
        return mean;
    return std::max(mean, (now_.seconds - then.seconds) / static_cast<double>(now_.computed - then.computed));
}

std::optional<TimeLeft::Estimate> TimeLeft::of(std::size_t points_left) {
    const auto point = seconds_of_a_point();
    if (!point)
        return std::nullopt;
    const double estimate = *point * static_cast<double>(points_left);
    const bool climbs = shown_ && estimate > more * *shown_;
    shown_ = std::min(estimate, shown_.value_or(estimate));
    return Estimate{*shown_, climbs};
}

} // namespace graze
