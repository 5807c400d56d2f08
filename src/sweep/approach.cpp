#include "sweep/approach.hpp"

#include "flow/cyclic.hpp"

#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <complex>

namespace graze {

namespace {

constexpr double on_orbit = 1e-9;         ///< distance from an orbit at which a motion counts as on it
constexpr double most_nonlinear = 0.1;    ///< relative deviation of the motion from its linear part that is allowed
constexpr std::size_t fewest_periods = 4; ///< required for shrinking along a direction
constexpr std::size_t most_periods = 8;
constexpr std::size_t fewest_turning = 16; ///< required for shrinking in a plane
constexpr double half_as_fast = 0.5;
constexpr double neutral_distance = 1e-10; ///< distance of a multiplier from 1 that is significant

/// The last deviations from the orbit, in units of the scales of the states, newest first, one period apart.
class Deviations {
public:
    Deviations(const OrbitFinder& orbit, const ReturnWatcher& motion, std::span<const double> periods,
               std::span<const double> scale)
        : count_((motion.remembered() - 1) / orbit.period() + 1) {
        const auto size = static_cast<Eigen::Index>(scale.size());
        std::vector<double> difference(scale.size());
        vectors_ = Eigen::MatrixXd::Zero(size, static_cast<Eigen::Index>(count_));
        foreseen_ = Eigen::VectorXd::Zero(size);
        for (std::size_t k = 0; k < count_; ++k) {
            subtract_states(motion.recent(k * orbit.period()).state, orbit.point(), periods, difference);
            for (Eigen::Index i = 0; i < size; ++i)
                if (orbit.is_active(static_cast<std::size_t>(i)))
                    vectors_(i, static_cast<Eigen::Index>(k)) =
                        difference[static_cast<std::size_t>(i)] / scale[static_cast<std::size_t>(i)];
        }
        for (Eigen::Index i = 0; count_ > 1 && i < size; ++i)
            for (Eigen::Index j = 0; j < size; ++j)
                if (orbit.is_active(static_cast<std::size_t>(i)) && orbit.is_active(static_cast<std::size_t>(j)))
                    foreseen_[i] += orbit.jacobian()(i, j) * vectors_(j, 1) * scale[static_cast<std::size_t>(j)] /
                                    scale[static_cast<std::size_t>(i)];
    }

    std::size_t count() const { return count_; }
    auto operator[](std::size_t k) const { return vectors_.col(static_cast<Eigen::Index>(k)); }
    double size(std::size_t k) const { return (*this)[k].cwiseAbs().maxCoeff(); }
    /// Returns the difference between the newest deviation and the linear image of the one before.
    double difference() const { return ((*this)[0] - foreseen_).cwiseAbs().maxCoeff(); }

private:
    std::size_t count_;
    Eigen::MatrixXd vectors_;
    Eigen::VectorXd foreseen_;
};

/// Returns whether the returns of an orbit of several returns are so far apart that it is not one of fewer returns:
/// near such an orbit, motions within the error of the computation may look like orbits of the longer period.
bool is_resolved(const OrbitFinder& orbit, std::span<const double> periods, double tolerance) {
    if (orbit.period() == 1)
        return true;
    // The possible displacement of the orbit along its slowest direction by errors of the integration.
    const double shift = 2 * tolerance / (1 - std::abs(orbit.multipliers().front()));
    const std::vector<double>& first = orbit.returns().front();
    std::vector<double> difference(first.size());
    const auto differs = [&](std::size_t shorter) {
        subtract_states(orbit.returns()[shorter], first, periods, difference);
        for (std::size_t i = 0; i < first.size(); ++i)
            if (orbit.is_active(i) && std::abs(difference[i]) > shift * std::abs(first[i]))
                return true;
        return false;
    };
    for (std::size_t shorter = 1; shorter < orbit.period(); ++shorter)
        if (orbit.period() % shorter == 0 && !differs(shorter))
            return false;
    return true;
}

/// Returns the sizes of the deviations along the slowest direction or in its plane, newest first.
std::vector<double> slow_parts(const OrbitFinder& orbit, const Deviations& deviations) {
    const Eigen::VectorXcd& functional = orbit.leading_functional();
    std::vector<double> parts;
    for (std::size_t k = 0; k < deviations.count(); ++k)
        parts.push_back(std::abs(functional.cwiseProduct(deviations[k].cast<std::complex<double>>()).sum()));
    return parts;
}

/// Tests shrinking along a direction, separately on each side: near a flip the sides alternate and may differ.
bool shrinks_along(const std::vector<double>& parts, double radius) {
    const std::size_t last = std::min(most_periods, (parts.size() - 1) / 2 * 2);
    if (last < fewest_periods)
        return false;
    for (std::size_t k = 0; k + 2 <= last; ++k)
        if (!(parts[k] < parts[k + 2]))
            return false;
    const double shrunk = std::pow(parts[0] / parts[last], 1.0 / static_cast<double>(last));
    return 1 - shrunk >= half_as_fast * (1 - radius);
}

/// Tests shrinking in a plane, where higher-order terms modulate the size within a turn.
/// @param bent relative size of the higher-order terms
bool shrinks_turning(const std::vector<double>& parts, double radius, double bent) {
    const std::size_t half = parts.size() / 2;
    if (parts.size() < fewest_turning)
        return false;
    double newer = 0, older = 0;
    for (std::size_t k = 0; k < half; ++k) {
        newer += parts[k] * parts[k];
        older += parts[half + k] * parts[half + k];
    }
    const double shrunk = 1 - std::sqrt(newer / older), periods = static_cast<double>(half);
    return shrunk >= half_as_fast * (1 - std::pow(radius, periods)) && shrunk >= 2 * bent / periods;
}

/// Close to a bifurcation the distance first shrinks by higher-order terms, long before the linear part dominates. In
/// the slow direction (or plane) the rate of shrinking changes from the observed one to that of the multiplier without
/// vanishing in between, so there is no other invariant set between motion and orbit.
bool shrinks_slowly(const OrbitFinder& orbit, const ReturnWatcher& motion, const Deviations& deviations,
                    double radius) {
    if (orbit.multipliers().empty() || deviations.count() <= fewest_periods)
        return false;
    const double bent = deviations.difference() / deviations.size(1);
    if (!(bent <= most_nonlinear) || !(deviations.size(0) < deviations.size(deviations.count() - 1)))
        return false;
    const bool turning = orbit.multipliers().front().imag() != 0;
    const std::size_t periods = turning ? deviations.count() - 1 : std::min(most_periods, deviations.count() - 1);
    if (!same_contacts(orbit, motion, periods))
        return false;
    const std::vector<double> parts = slow_parts(orbit, deviations);
    return turning ? shrinks_turning(parts, radius, bent) : shrinks_along(parts, radius);
}

/// Returns whether the distances from one period to the next decrease throughout.
bool slows_down(ReturnWatcher& motion, std::size_t period) {
    const std::size_t count = std::min(most_periods, (motion.remembered() - 1) / period);
    double before = 0;
    for (std::size_t k = 0; k < count; ++k) {
        const Return &one = motion.recent(k * period), &other = motion.recent((k + 1) * period);
        const double distance = motion.distance(one.state, other.state);
        if (one.mode != other.mode || !(distance > before))
            return false;
        before = distance;
    }
    return count >= fewest_periods;
}

/// Returns whether the motion is closer to this state in the newer half of its returns than in the older half.
bool closes_in(ReturnWatcher& motion, const Guess& middle) {
    constexpr std::size_t fewest = 8;
    constexpr double shrinking = 0.98;
    const std::size_t half = (motion.remembered() - 1) / middle.period / 2;
    double newer = 0, older = 0;
    for (std::size_t k = 0; k < 2 * half; ++k) {
        if (motion.recent(k * middle.period).mode != motion.recent(0).mode)
            return false;
        (k < half ? newer : older) +=
            std::pow(motion.distance(motion.recent(k * middle.period).state, middle.state), 2);
    }
    return half >= fewest / 2 && newer < shrinking * shrinking * older;
}

constexpr double shrunk = 0.1;             ///< factor to which rotating deviations must shrink
constexpr double settled_deviation = 1e-7; ///< deviation from which a motion is not expected to leave any more
constexpr std::size_t as_long = 2;         ///< factor of the longest time before an unexpected contact

/// Returns the largest modulus of the multipliers except a real leading one: along its direction the motion approaches
/// monotonically and meets nothing new. 0 if there is no other.
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

std::size_t returns_to_shrink(const OrbitFinder& orbit) {
    const double radius = turning_radius(orbit);
    if (!(radius > 0))
        return 0;
    const double periods = std::ceil(std::log(shrunk) / std::log(radius));
    constexpr double most = 1e9;
    return orbit.period() * static_cast<std::size_t>(std::clamp(periods, 0.0, most));
}

/// Factor of the distance at which a motion recurs: within this distance of an unstable orbit, the recurrence is
/// explained by it. Another, stable orbit is farther away once the motion is close enough to it.
constexpr double near_orbit = 3;

} // namespace

double distance_from(const OrbitFinder& orbit, const ReturnWatcher& motion, std::span<const double> periods,
                     std::span<const double> scale) {
    return Deviations(orbit, motion, periods, scale).size(0);
}

bool same_contacts(const OrbitFinder& orbit, const ReturnWatcher& motion, std::size_t periods) {
    const std::vector<std::uint32_t> all = motion.contacts(periods * orbit.period());
    const std::vector<std::uint32_t>& one = orbit.contacts();
    if (all.size() != periods * one.size())
        return false;
    for (std::size_t k = 0; k < all.size(); ++k)
        if (all[k] != one[k % one.size()])
            return false;
    return true;
}

bool approaches(const OrbitFinder& orbit, const ReturnWatcher& motion, std::span<const double> periods,
                double tolerance) {
    double radius = 0;
    for (const auto& multiplier : orbit.multipliers())
        radius = std::max(radius, std::abs(multiplier));
    if (!(radius < 1 - neutral_distance) || motion.remembered() <= orbit.period())
        return false;
    const Deviations deviations(orbit, motion, periods, motion.scale());
    if (!is_resolved(orbit, periods, tolerance))
        return false;
    if (deviations.size(0) < on_orbit)
        return true;
    if (deviations.difference() <= most_nonlinear * (1 - radius) * deviations.size(1) &&
        same_contacts(orbit, motion, 1))
        return true;
    return shrinks_slowly(orbit, motion, deviations, radius);
}

bool is_near(const OrbitFinder& orbit, const ReturnWatcher& motion, std::span<const double> periods) {
    if (orbit.multipliers().empty() || !(std::abs(orbit.multipliers().front()) < 1 - neutral_distance) ||
        motion.remembered() <= orbit.period())
        return false;
    const Deviations deviations(orbit, motion, periods, motion.scale());
    return deviations.difference() <= most_nonlinear * deviations.size(1) && same_contacts(orbit, motion, 1);
}

Guess middle_of(const ReturnWatcher& motion, const SectionMap& map, std::size_t period,
                std::span<const double> periods) {
    const std::size_t states = map.states(), count = (motion.remembered() - 1) / period;
    const std::vector<double>& newest = motion.recent(0).state;
    Guess guess{period, newest};
    double weights = 0;
    std::vector<double> sum(states, 0.0), difference(states);
    for (std::size_t k = 0; k < count; ++k) {
        const double t = (static_cast<double>(k) + 0.5) / static_cast<double>(count);
        const double weight = std::exp(-1 / (t * (1 - t))); // zero weight at the ends
        subtract_states(motion.recent(k * period).state, newest, periods, difference);
        weights += weight;
        for (std::size_t i = 0; i < states; ++i)
            sum[i] += weight * difference[i];
    }
    for (std::size_t i = 0; i < states; ++i)
        if (map.takes_part(i) && weights > 0)
            guess.state[i] = within_period(guess.state[i] + sum[i] / weights, periods[i]);
    return guess;
}

bool approaches_slowly(const OrbitFinder& orbit, ReturnWatcher& motion, std::span<const double> periods) {
    if (motion.remembered() <= orbit.period() || !slows_down(motion, orbit.period()))
        return false;
    const Deviations deviations(orbit, motion, periods, motion.scale());
    for (std::size_t k = 0; k < std::min(most_periods, deviations.count() - 1); ++k)
        if (!(deviations.size(k) < deviations.size(k + 1)))
            return false;
    return true;
}

std::vector<Guess> slow_limits(ReturnWatcher& motion, const SectionMap& map, std::size_t largest,
                               std::span<const double> periods) {
    std::vector<Guess> guesses;
    for (std::size_t n = 1; n <= largest && guesses.empty(); ++n)
        if (slows_down(motion, n))
            guesses.push_back({n, motion.recent(0).state});
    for (std::size_t n = 1; n <= largest; ++n) {
        Guess middle = middle_of(motion, map, n, periods);
        if (!closes_in(motion, middle))
            continue;
        guesses.push_back(std::move(middle));
        break;
    }
    return guesses;
}

void OrbitStay::begin(const OrbitFinder& orbit, const ReturnWatcher& motion, std::span<const double> periods,
                      bool events) {
    first_ = motion.returns();
    scale_.assign(motion.scale().begin(), motion.scale().end());
    size_ = distance_from(orbit, motion, periods, scale_);
    needed_ = 0;
    if (!events || size_ < settled_deviation)
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
    if (size < settled_deviation)
        return Verdict::stayed;
    if (gone < needed_)
        return Verdict::staying;
    // Half of the shrinking of the slowest direction is required.
    const double radius = orbit.multipliers().empty() ? 0 : std::abs(orbit.multipliers().front());
    const std::size_t turns = gone / orbit.period();
    const double foreseen = std::pow(radius, static_cast<double>(turns));
    return size < 0.5 * (1 + foreseen) * size_ ? Verdict::stayed : Verdict::left;
}

void UnstableOrbits::add(const OrbitFinder& orbit, const ReturnWatcher& motion) {
    const bool unstable = !orbit.multipliers().empty() && std::abs(orbit.multipliers().front()) > 1;
    if (orbit.found() && unstable) {
        states_.insert(states_.end(), orbit.returns().begin(), orbit.returns().end());
    } else if (orbit.clearly_unstable()) {
        states_.emplace_back(orbit.point().begin(), orbit.point().end());
        // The motion was about as close to the orbit at its other returns.
        for (std::size_t k = 1; k < std::min(orbit.period(), motion.remembered()); ++k)
            states_.push_back(motion.recent(k).state);
    }
}

bool UnstableOrbits::explain(ReturnWatcher& motion, std::size_t period, double least) const {
    const std::vector<double>& here = motion.recent(0).state;
    const double most = near_orbit * motion.distance(here, motion.recent(period).state);
    return std::ranges::any_of(states_, [&](const std::vector<double>& state) {
        const double distance = motion.distance(here, state);
        return distance > least && distance <= most;
    });
}

} // namespace graze
