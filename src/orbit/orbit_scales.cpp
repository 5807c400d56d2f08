#include "orbit/orbit_scales.hpp"

#include "orbit/eigen_index.hpp"

#include <algorithm>
#include <cmath>

namespace graze {

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
        std::copy(chosen.begin(), chosen.end(), scales.data() + layout.start_of(k));
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
