#include "branch/simpler_end.hpp"

#include "branch/point_rules.hpp"

#include <algorithm>
#include <cmath>

namespace graze {

namespace {

constexpr std::size_t most_places = 16;

/// The orbit whose halves are the mean of the halves of a doubled one.
Orbit mean_of_halves(const Model& model, Orbit orbit) {
    const std::size_t half = orbit.segments() / 2;
    for (std::size_t k = 0; k < half; ++k) {
        for (std::size_t i = 0; i < orbit.starts[k].size(); ++i)
            if (!model.states[i].period)
                orbit.starts[k][i] = orbit.starts[k + half][i] = 0.5 * (orbit.starts[k][i] + orbit.starts[k + half][i]);
        orbit.durations[k] = orbit.durations[k + half] = 0.5 * (orbit.durations[k] + orbit.durations[k + half]);
    }
    return orbit;
}

void extrapolate(std::vector<double>& near, const std::vector<double>& far, double share) {
    for (std::size_t i = 0; i < near.size(); ++i)
        near[i] += share * (near[i] - far[i]);
}

} // namespace

void SimplerEnd::note(BranchState& state) {
    const Orbit orbit = state.orbit();
    const auto all = differences_of_halves(state, orbit, false);
    if (all.empty() || (!places_.empty() && places_.back().mean.signature != orbit.signature)) {
        places_.clear();
        widest_.clear();
        here_.reset();
        return;
    }
    const std::vector<double>& differences = all.front();
    widest_.resize(differences.size(), 0);
    double square = 0;
    for (std::size_t i = 0; i < differences.size(); ++i) {
        widest_[i] = std::max(widest_[i], std::abs(differences[i]));
        if (widest_[i] > 0)
            square += std::pow(differences[i] / widest_[i], 2);
    }
    here_ = {mean_of_halves(state.model(), orbit), square};
    // Steps become short towards the end: those before it are needed.
    if (!places_.empty() && square > 0.5 * places_.back().square)
        return;
    if (places_.size() == most_places)
        places_.erase(places_.begin());
    places_.push_back(*here_);
}

bool SimplerEnd::is_beside() const {
    constexpr double beside = 1e-2;
    return here_ && places_.size() > 1 && here_->square < beside * beside;
}

Orbit SimplerEnd::estimate(const Orbit& orbit) const {
    if (!here_)
        return orbit;
    Orbit result = here_->mean;
    const double near = here_->square;
    const auto other =
        std::find_if(places_.rbegin(), places_.rend(), [&](const Place& one) { return one.square > 4 * near; });
    if (other == places_.rend())
        return result;
    const double share = near / (other->square - near);
    extrapolate(result.parameters, other->mean.parameters, share);
    extrapolate(result.durations, other->mean.durations, share);
    for (std::size_t k = 0; k < result.starts.size(); ++k)
        extrapolate(result.starts[k], other->mean.starts[k], share);
    return result;
}

} // namespace graze
