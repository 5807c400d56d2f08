#include "orbit/orbit_scales.hpp"

#include "orbit/eigen_index.hpp"

#include <algorithm>
#include <cmath>

namespace graze {

OrbitScales::OrbitScales(std::size_t states, std::vector<double> usual, std::vector<double> ranges)
    : states_(states), usual_(std::move(usual)), ranges_(std::move(ranges)), largest_(usual_.size(), 0.0),
      coupling_(Eigen::MatrixXd::Zero(index(states), index(states))), arcs_(coupling_),
      effects_(Eigen::VectorXd::Zero(index(usual_.size()))) {
    ranges_.resize(usual_.size(), 0.0);
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
        // Extents along the motion: those of an orbit with a single piece are not seen from its start.
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

/// Near zero a parameter says nothing of its own size. What is said instead by the range in which it is looked at must
/// agree with what it does to the orbit: the one may be given without thought, the other may be nothing.
double OrbitScales::parameter_scale(std::size_t f, double value) {
    constexpr double smallest = 1e-2, nothing = 1e-12;
    const double usual = std::abs(usual_[f]), effect = effects_[index(f)];
    double& largest = largest_[f];
    largest = std::max({largest, std::abs(value), smallest * usual});
    double scale = largest;
    if (effect > nothing && ranges_[f] == 0 && usual == 0)
        scale = std::max(scale, smallest / effect);
    if (effect > 0 && ranges_[f] > 0)
        scale = std::max(scale, smallest * std::min(ranges_[f], 1 / effect));
    return scale > 0 && std::isfinite(scale) ? scale : 1;
}

} // namespace graze
