#include "graze/flow/tangent_steps.hpp"

#include "graze/flow/tangent_reach.hpp"
#include "graze/symbolic/require.hpp"

#include <algorithm>
#include <cmath>

namespace graze {

TangentSteps::TangentSteps(const System& system, int order, double tolerance, std::size_t directions)
    : system_(system), states_(system.states()), directions_(directions), tolerance_(allowance * tolerance),
      jets_(system, order, LaneKind::tangent), lanes_(static_cast<std::size_t>(jets_.width()) - 1), couplings_(system) {
    const std::size_t width = lanes_ + 1;
    parameter_lanes_.resize(system.parameters() * width);
    seeds_.resize(states_ * width);
    sums_.resize(std::max<std::size_t>(states_, 1) * width);
    slopes_.resize(sums_.size());
    times_.resize(width);
    disagreement_.resize(width);
    state_.resize(states_);
    floors_.resize(states_ * width);
    noise_.resize(floors_.size());
}

void TangentSteps::set_parameters(std::span<const double> parameters, std::span<const double> seeds) {
    require_size(parameters.size(), system_.parameters(), "independent parameters");
    require_size(seeds.size(), parameters.size() * directions_, "directions of parameters");
    parameters_.assign(parameters.begin(), parameters.end());
    parameter_seeds_.assign(seeds.begin(), seeds.end());
    parameters_move_ = std::any_of(seeds.begin(), seeds.end(), [](double seed) { return seed != 0; });
    const std::size_t width = lanes_ + 1;
    std::fill(parameter_lanes_.begin(), parameter_lanes_.end(), 0.0);
    for (std::size_t j = 0; j < parameters.size(); ++j) {
        parameter_lanes_[j * width] = parameters[j];
        if (directions_ <= lanes_)
            std::copy_n(seeds.begin() + static_cast<std::ptrdiff_t>(j * directions_), directions_,
                        parameter_lanes_.begin() + static_cast<std::ptrdiff_t>(j * width + 1));
    }
    jets_.set_parameters(parameter_lanes_);
    couplings_.set_parameters(parameters_);
}

/// Where all directions fit into a jet, and where none changes a parameter, jets have them already.
void TangentSteps::load_parameters(std::size_t mode, std::size_t first) {
    if (directions_ <= lanes_ || !parameters_move_)
        return;
    const std::size_t width = lanes_ + 1, count = count_from(first);
    for (std::size_t j = 0; j < parameters_.size(); ++j)
        for (std::size_t l = 0; l < lanes_; ++l)
            parameter_lanes_[j * width + 1 + l] = l < count ? parameter_seeds_[j * directions_ + first + l] : 0.0;
    jets_.set_parameters(mode, parameter_lanes_);
}

const Jet& TangentSteps::begin(std::size_t mode, std::span<const double> state, std::span<const double> matrix,
                               std::size_t first) {
    require_size(state.size(), states_, "states");
    require_size(matrix.size(), states_ * directions_, "derivatives");
    require_index(first, directions_, "direction");
    load_parameters(mode, first);
    seen_ = 0;
    const std::size_t width = lanes_ + 1, count = count_from(first);
    for (std::size_t i = 0; i < states_; ++i) {
        seeds_[i * width] = state[i];
        for (std::size_t l = 0; l < lanes_; ++l)
            seeds_[i * width + 1 + l] = l < count ? matrix[i * directions_ + first + l] : 0.0;
    }
    return jets_.computed(mode, seeds_);
}

bool TangentSteps::agrees(std::size_t mode, double length, const EndAllowance& allowed) {
    if (!(length > 0))
        return false;
    const Jet& jet = jets_(mode);
    Jet& next = jets_.next(mode);
    std::fill(times_.begin(), times_.end(), length);
    jet.evaluate_states(times_, sums_, slopes_);
    next.begin(std::span<const double>(sums_).first(states_ * (lanes_ + 1)));
    jet.find_disagreement(next, allowed, times_, sums_, slopes_, disagreement_);
    seen_ = length;
    return disagreement_[0] <= 0;
}

/// Measured where the step begins, once it is asked for.
const Couplings& TangentSteps::couplings_here(std::size_t mode) {
    if (measured_ == nullptr)
        measured_ = &couplings_.measured(mode, place_);
    return *measured_;
}

/// To what each component may be brought by the others, from where all are now.
std::span<const double> TangentSteps::floors_of(const Jet& jet, std::size_t mode, std::size_t count, double length) {
    const Couplings& couplings = couplings_here(mode);
    const std::size_t width = lanes_ + 1;
    const double time = std::min(std::abs(length), couplings.response_time());
    const std::span<const Series> series = jet.series();
    for (std::size_t i = 0; i < states_; ++i) {
        const double* c = series[i].first;
        for (std::size_t l = 0; l < width; ++l)
            floors_[i * width + l] =
                std::abs(c[l]) + time * (std::abs(c[width + l]) + time * std::abs(c[2 * width + l]));
    }
    // The first lane is that of the value.
    couplings.spread(time, floors_, width, count + 1);
    return floors_;
}

/// What round-off may make of a direction's rates: the terms of which each is the sum are as large as the strongest
/// coupling makes them of the direction's largest component, in the units of the couplings, but may cancel.
std::span<const double> TangentSteps::noise_of(const Jet& jet, std::size_t mode, std::size_t count) {
    constexpr double round_off = 100 * 0x1p-53; // of a sum of some terms, and now and then more
    const Couplings& couplings = couplings_here(mode);
    const double rate = couplings.response_time() > 0 ? round_off / couplings.response_time() : 0;
    const std::span<const double> units = couplings.units();
    const std::span<const Series> series = jet.series();
    const std::size_t width = lanes_ + 1;
    std::fill(noise_.begin(), noise_.end(), 0.0);
    for (std::size_t l = 1; l <= count; ++l) {
        double largest = 0;
        for (std::size_t i = 0; i < states_; ++i)
            largest = std::max(largest, std::abs(series[i].first[l]) / units[i]);
        for (std::size_t i = 0; i < states_; ++i)
            noise_[i * width + l] = rate * largest * units[i];
    }
    return noise_;
}

/// Follows a jet's series for a step or a part of it. @param seen whether what is at its end has been evaluated
/// @return how far; what is there is in `sums_`
double TangentSteps::follow(const Jet& jet, std::size_t mode, std::size_t first, double length, bool seen) {
    const std::size_t count = count_from(first);
    std::span<const double> known;
    const TangentFloors floors = [&] { return known.empty() ? known = floors_of(jet, mode, count, length) : known; };
    const double reach = tangent_reach(jet, states_, count, tolerance_, std::abs(length), floors);
    const TangentFloors noise = [&] { return noise_of(jet, mode, count); };
    return follow_tangents(jet, jets_.next(mode), states_, count, tolerance_, std::copysign(reach, length), times_,
                           sums_, slopes_, floors, noise, seen && reach == length);
}

void TangentSteps::finish(const Jet& jet, std::size_t first, std::span<double> after, std::size_t output,
                          std::span<double> row) {
    const std::size_t width = lanes_ + 1, count = count_from(first);
    for (std::size_t i = 0; i < states_; ++i)
        std::copy_n(&sums_[i * width + 1], count, &after[i * directions_ + first]);
    if (row.empty())
        return;
    jet.evaluate_output(output, times_, slopes_);
    std::copy_n(&slopes_[1], count, &row[first]);
}

double TangentSteps::carry(std::size_t mode, std::span<const double> state, std::span<const double> matrix,
                           double length, std::span<double> after, std::size_t output, std::span<double> row) {
    require_size(after.size(), states_ * directions_, "derivatives");
    if (!row.empty())
        require_size(row.size(), directions_, "derivatives of an output");
    const std::size_t width = lanes_ + 1;
    place_ = state;
    measured_ = nullptr;
    for (std::size_t first = 0; first < directions_; first += lanes_) {
        const Jet* jet = first == 0 ? &jets_(mode) : &begin(mode, state, matrix, first);
        double part = follow(*jet, mode, first, length, first == 0 && seen_ == length);
        if (first == 0) {
            length = part;
            for (std::size_t i = 0; i < states_; ++i)
                state_[i] = sums_[i * width];
        }
        double remaining = part == length ? 0 : length - part;
        for (int parts = 1; remaining != 0 && parts < most_parts; ++parts) {
            seeds_ = sums_;
            jet = &jets_.computed(mode, std::span<const double>(seeds_).first(states_ * width));
            part = follow(*jet, mode, first, remaining);
            remaining = part == remaining ? 0 : remaining - part;
        }
        if (remaining != 0)
            return 0;
        finish(*jet, first, after, output, row);
    }
    return length;
}

} // namespace graze
