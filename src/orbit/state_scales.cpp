#include "orbit/state_scales.hpp"

#include "base/special_numbers.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace graze {

void StateScales::begin() {
    least_.assign(largest_.size(), infinity);
    greatest_.assign(largest_.size(), -infinity);
    sizes_.assign(largest_.size(), 0.0);
}

void StateScales::note(std::span<const double> state) {
    for (std::size_t i = 0; i < state.size(); ++i) {
        least_[i] = std::min(least_[i], state[i]);
        greatest_[i] = std::max(greatest_[i], state[i]);
        sizes_[i] = std::max(sizes_[i], std::abs(state[i]));
    }
}

bool StateScales::is_constant(std::size_t i) const {
    constexpr double at_rest = 1e-14;
    return !(greatest_[i] - least_[i] > at_rest * sizes_[i]);
}

/// Returns the scale of a state that is zero, such as a velocity at an equilibrium, from its effect on other states. At
/// a fold this is the only information, since displacements do not act on the velocity.
/// @return 0 for states that have a size of their own or act on states that vary
double StateScales::scale_by_effect(std::size_t i, std::span<const double> own, std::span<const double> periods,
                                    const Eigen::MatrixXd& arcs) const {
    constexpr double no_effect = 1e-10, share = 1e-3;
    double least = std::numeric_limits<double>::infinity();
    if (is_constant(i) && sizes_[i] > 0) // the state has a size of its own
        return 0;
    for (std::size_t j = 0; j < own.size(); ++j) {
        const double acts = arcs(static_cast<Eigen::Index>(j), static_cast<Eigen::Index>(i));
        if (j == i || periods[j] > 0 || !(acts > 0) || !(own[j] > 0))
            continue;
        if (!is_constant(j) || !(own[i] * acts < no_effect * own[j]))
            return 0;
        least = std::min(least, own[j] / acts);
    }
    return periods[i] == 0 && std::isfinite(least) ? share * least : 0;
}

std::vector<double> StateScales::choose(std::span<const double> periods, const Eigen::MatrixXd& coupling,
                                        const Eigen::MatrixXd& arcs) {
    constexpr double smallest_share = 1e-3; // of the magnitude, for states that hardly move
    constexpr double smallest_scale = 1e-2; // share of the largest scale so far
    // A state smaller than the others by this factor is zero by symmetry, up to a decaying transient.
    constexpr double negligible = 1e-25;
    constexpr double round_off_share = 1e-3;
    const std::size_t n = largest_.size();
    std::vector<double> own(n);
    double largest = 0, smallest = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < n; ++i) {
        double& scale = own[i];
        scale = periods[i] > 0 ? periods[i] : greatest_[i] - least_[i];
        // A constant state has no extent, as between the jumps of a map; it is scaled by its magnitude.
        if (periods[i] == 0 && is_constant(i))
            scale = sizes_[i];
        else if (!(scale > smallest_share * sizes_[i]))
            scale = smallest_share * sizes_[i];
        if (!std::isfinite(scale))
            scale = 1;
        largest = std::max(largest, scale);
    }
    for (std::size_t i = 0; i < n; ++i)
        if (own[i] > negligible * largest && periods[i] == 0)
            smallest = std::min(smallest, own[i]);
    std::vector<double> scales = own;
    for (std::size_t i = 0; i < n; ++i) {
        has_size_[i] = own[i] > negligible * largest;
        if (!has_size_[i])
            scales[i] = std::isfinite(smallest) ? smallest : 1;
        // The scale must exceed the round-off of the states that act on this one.
        for (std::size_t j = 0; j < n; ++j)
            scales[i] =
                std::max(scales[i], round_off_share *
                                        coupling(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j)) * own[j]);
        scales[i] = std::max(scales[i], scale_by_effect(i, own, periods, arcs));
        // A scale borrowed from another state is not remembered.
        largest_[i] = std::max(largest_[i], has_size_[i] ? scales[i] : own[i]);
        scales[i] = std::max(scales[i], smallest_scale * largest_[i]);
    }
    return scales;
}

} // namespace graze
