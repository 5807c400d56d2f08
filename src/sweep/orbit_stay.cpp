#include "sweep/orbit_stay.hpp"

#include "sweep/approach.hpp"

#include <algorithm>
#include <cmath>
#include <complex>

namespace graze {

namespace {

constexpr double shrunk = 0.1;     ///< factor to which rotating deviations must shrink
constexpr double settled = 1e-7;   ///< deviation from which a motion is not expected to leave any more
constexpr std::size_t as_long = 2; ///< factor of the longest time before an unexpected contact

std::size_t returns_to_shrink(const OrbitFinder& orbit) {
    const double radius = turning_radius(orbit);
    if (!(radius > 0))
        return 0;
    const double periods = std::ceil(std::log(shrunk) / std::log(radius));
    constexpr double most = 1e9;
    return orbit.period() * static_cast<std::size_t>(std::clamp(periods, 0.0, most));
}

} // namespace

double turning_radius(const OrbitFinder& orbit) {
    const auto& multipliers = orbit.multipliers();
    if (multipliers.empty())
        return 0;
    const std::size_t first = multipliers.front().imag() == 0 ? 1 : 0;
    double radius = 0;
    for (std::size_t m = first; m < multipliers.size(); ++m)
        radius = std::max(radius, std::abs(multipliers[m]));
    return radius;
}

void OrbitStay::begin(const OrbitFinder& orbit, const ReturnWatcher& motion, std::span<const double> periods,
                      bool events) {
    first_ = motion.returns();
    scale_.assign(motion.scale().begin(), motion.scale().end());
    size_ = distance_from(orbit, motion, periods, scale_);
    needed_ = 0;
    if (!events || size_ < settled)
        return;
    needed_ = returns_to_shrink(orbit);
    const std::size_t now = motion.alike(orbit.period()), before = motion.longest_alike(orbit.period());
    if (now < as_long * before)
        needed_ = std::max(needed_, as_long * before - now);
}

OrbitStay::Verdict OrbitStay::judge(const OrbitFinder& orbit, const ReturnWatcher& motion,
                                    std::span<const double> periods) const {
    const std::size_t gone = this->gone(motion);
    if (needed_ == 0)
        return Verdict::stayed;
    if (gone % orbit.period() != 0)
        return Verdict::staying;
    if (gone > 0 && !same_contacts(orbit, motion, 1))
        return Verdict::left;
    const double size = distance_from(orbit, motion, periods, scale_);
    if (size < settled)
        return Verdict::stayed;
    if (gone < needed_)
        return Verdict::staying;
    // Half of the shrinking of the slowest direction is required.
    const double radius = orbit.multipliers().empty() ? 0 : std::abs(orbit.multipliers().front());
    const std::size_t turns = gone / orbit.period();
    const double foreseen = std::pow(radius, static_cast<double>(turns));
    return size < 0.5 * (1 + foreseen) * size_ ? Verdict::stayed : Verdict::left;
}

} // namespace graze
