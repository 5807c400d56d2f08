#include "orbit/orbit_scales.hpp"

#include "base/special_numbers.hpp"

#include <algorithm>
#include <cmath>

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
    double least = infinity;
    if (is_constant(i) && sizes_[i] > 0) // the state has a size of its own
        return 0;
    for (std::size_t j = 0; j < own.size(); ++j) {
        const double acts = arcs(index(j), index(i));
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
    double largest = 0, smallest = infinity;
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
            scales[i] = std::max(scales[i], round_off_share * coupling(index(i), index(j)) * own[j]);
        scales[i] = std::max(scales[i], scale_by_effect(i, own, periods, arcs));
        // A scale borrowed from another state is not remembered.
        largest_[i] = std::max(largest_[i], has_size_[i] ? scales[i] : own[i]);
        scales[i] = std::max(scales[i], smallest_scale * largest_[i]);
    }
    return scales;
}

OrbitScales::OrbitScales(std::size_t states, std::vector<double> nominal, std::vector<double> ranges)
    : states_(states), nominal_(std::move(nominal)), ranges_(std::move(ranges)), largest_(nominal_.size(), 0.0),
      coupling_(Eigen::MatrixXd::Zero(index(states), index(states))), arcs_(coupling_),
      effects_(Eigen::VectorXd::Zero(index(nominal_.size()))) {
    ranges_.resize(nominal_.size(), 0.0);
}

Eigen::VectorXd OrbitScales::choose(const OrbitLayout& layout, const Eigen::VectorXd& unknowns,
                                    std::span<const std::size_t> modes, ModeFlow& flow,
                                    std::span<const double> periods) {
    states_.begin();
    double time = 0;
    for (std::size_t k = 0; k < layout.pieces(); ++k) {
        const double* start = unknowns.data() + layout.start_of(k);
        const double duration = unknowns[index(layout.duration_of(k))];
        std::vector<double> state(start, start + layout.states());
        time += std::abs(duration);
        states_.note(state);
        // Samples along the motion: the start alone does not show the extent of an orbit with a single piece.
        constexpr int parts = 8;
        for (int part = 0; part < parts; ++part) {
            if (flow.run(modes[layout.segment_of(k)], state, duration / parts) != ModeFlow::Ending::done)
                break;
            states_.note(state);
        }
    }
    Eigen::VectorXd scales = Eigen::VectorXd::Ones(index(layout.unknowns()));
    const std::vector<double> chosen = states_.choose(periods, coupling_, arcs_);
    for (std::size_t k = 0; k < layout.pieces(); ++k) {
        std::ranges::copy(chosen, scales.data() + layout.start_of(k));
        scales[index(layout.duration_of(k))] = time > 0 ? time : 1;
        for (std::size_t j = 0; j < layout.inner(); ++j)
            scales[index(layout.inner_of(k) + j)] = chosen[j % layout.states()];
    }
    for (std::size_t f = 0; f < layout.free(); ++f)
        scales[index(layout.parameter(f))] = parameter_scale(f, unknowns[index(layout.parameter(f))]);
    return scales;
}

/// Returns the scale of a free parameter: its largest or nominal magnitude, or near zero the smaller of its range and
/// of the change that affects the orbit by its size. Both are consulted since a range may be arbitrary and an effect
/// may vanish.
double OrbitScales::parameter_scale(std::size_t f, double value) {
    constexpr double smallest = 1e-2, nothing = 1e-12;
    const double nominal = std::abs(nominal_[f]), effect = effects_[index(f)];
    double& largest = largest_[f];
    largest = std::max({largest, std::abs(value), smallest * nominal});
    double scale = largest;
    if (effect > nothing && ranges_[f] == 0 && nominal == 0)
        scale = std::max(scale, smallest / effect);
    if (effect > 0 && ranges_[f] > 0)
        scale = std::max(scale, smallest * std::min(ranges_[f], 1 / effect));
    return scale > 0 && std::isfinite(scale) ? scale : 1;
}

} // namespace graze
