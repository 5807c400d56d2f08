#include "graze/flow/tangent_steps.hpp"

#include "flow/couplings.hpp"
#include "flow/tangent_reach.hpp"
#include "graze/base/input_error.hpp"
#include "graze/base/require.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace graze {

std::size_t TangentSteps::together(std::size_t directions) {
    return static_cast<std::size_t>(tangent_kernels(directions, best_instruction_set()).width);
}

TangentSteps::TangentSteps(const System& system, double tolerance, std::size_t directions, double whole)
    : system_(system), states_(system.states()), directions_(directions), tolerance_(allowance * tolerance),
      whole_(whole), moving_(system.parameters(), 0), lanes_(system.model().modes.size()), state_(states_),
      couplings_(std::make_unique<ModeCouplings>(system)) {}

TangentSteps::~TangentSteps() = default;
TangentSteps::TangentSteps(TangentSteps&&) noexcept = default;
TangentSteps& TangentSteps::operator=(TangentSteps&&) noexcept = default;

void TangentSteps::set_parameters(std::span<const double> parameters, std::span<const double> seeds) {
    require_size(parameters.size(), system_.parameters(), "independent parameters");
    require_size(seeds.size(), parameters.size() * directions_, "directions of parameters");
    parameter_seeds_.assign(seeds.begin(), seeds.end());
    couplings_->set_parameters(parameters);
    std::vector<char> moving(parameters.size(), 0);
    groups_ = {LinearMode::by_states};
    for (std::size_t j = 0; j < parameters.size(); ++j) {
        const auto row = seeds.subspan(j * directions_, directions_);
        if (std::all_of(row.begin(), row.end(), [](double seed) { return seed == 0; }))
            continue;
        moving[j] = 1;
        groups_.push_back(LinearMode::by_parameter(j));
    }
    if (moving != moving_) {
        moving_ = std::move(moving);
        for (Lanes& lanes : lanes_)
            lanes = {};
    }
    jet_ = nullptr;
}

TangentSteps::Lanes& TangentSteps::lanes_of_mode() {
    Lanes& lanes = lanes_[mode_];
    if (!lanes.here) {
        const LinearMode& linear = system_.linear(mode_);
        for (auto* series : {&lanes.here, &lanes.there})
            *series = std::make_unique<TangentSeries>(linear.tape, linear.equations, *jet_, moving_, directions_);
        sums_.resize(states_ * lanes.here->width());
        slopes_.resize(sums_.size());
        floors_.resize(sums_.size());
        noise_.resize(sums_.size());
    }
    return lanes;
}

void TangentSteps::begin(Jet& jet, std::size_t mode, std::span<const double> state, std::span<const double> matrix) {
    require_index(mode, lanes_.size(), "mode");
    require_size(state.size(), states_, "states");
    require_size(matrix.size(), states_ * directions_, "derivatives");
    require_index(0, directions_, "direction");
    require_size(jet.deferred_count(), system_.linear(mode).tape.deferred.size(), "deferred expressions of a jet");
    jet_ = &jet;
    mode_ = mode;
    place_ = state;
    matrix_ = matrix;
    measured_ = nullptr;
    loaded_ = false;
    jet.compute_deferred(groups_);
}

/// Computes the series of the directions from `first` on.
void TangentSteps::load(std::size_t first) {
    TangentSeries& here = *lanes_of_mode().here;
    if (loaded_ && first_ == first)
        return;
    here.load(matrix_, parameter_seeds_, directions_, first, std::min(here.width(), directions_ - first));
    here.compute(*jet_);
    first_ = first;
    loaded_ = true;
}

/// Measures the couplings at the beginning of the step on demand.
const Couplings& TangentSteps::couplings_here() {
    if (measured_ == nullptr)
        measured_ = &couplings_->measured(mode_, place_);
    return *measured_;
}

/// Returns the sizes to which each component may be brought by the others from their present values.
std::span<const double> TangentSteps::floors(double length) {
    const Couplings& couplings = couplings_here();
    const TangentSeries& here = *lanes_[mode_].here;
    const std::size_t width = here.width();
    const double time = std::min(std::abs(length), couplings.response_time());
    const std::size_t terms = static_cast<std::size_t>(std::min(here.order(), 2));
    for (std::size_t i = 0; i < states_; ++i)
        for (std::size_t l = 0; l < width; ++l) {
            const double* c = here.state(i) + l;
            double size = 0;
            for (std::size_t k = terms + 1; k-- > 0;)
                size = size * time + std::abs(c[k * width]);
            floors_[i * width + l] = size;
        }
    couplings.spread(time, floors_, width);
    return floors_;
}

/// Returns the possible effect of round-off on a direction's rates. Each rate is a sum of terms as large as the
/// strongest coupling times the direction's largest component, in the units of the couplings; these terms may cancel.
std::span<const double> TangentSteps::noise() {
    constexpr double round_off = 100 * 0x1p-53; // of a sum of several terms, with a margin
    const Couplings& couplings = couplings_here();
    const TangentSeries& here = *lanes_[mode_].here;
    const double rate = couplings.response_time() > 0 ? round_off / couplings.response_time() : 0;
    const std::span<const double> units = couplings.units();
    const std::size_t width = here.width(), count = std::min(width, directions_ - first_);
    std::fill(noise_.begin(), noise_.end(), 0.0);
    for (std::size_t l = 0; l < count; ++l) {
        double largest = 0;
        for (std::size_t i = 0; i < states_; ++i)
            largest = std::max(largest, std::abs(here.state(i)[l]) / units[i]);
        for (std::size_t i = 0; i < states_; ++i)
            noise_[i * width + l] = rate * largest * units[i];
    }
    return noise_;
}

/// Begins the directions at the end of a step, at `state_`.
void TangentSteps::begin_end(Jet& next, double step) {
    next.begin(state_);
    next.begin_deferred(groups_);
    at_ = step;
}

/// Follows the loaded directions for a step or a part of it.
/// @return the length of the part; the result is in `sums_`, the state in `state_`
double TangentSteps::follow(Jet& next, double length) {
    Lanes& lanes = lanes_of_mode();
    std::span<const double> known;
    const TangentFloors least = [&] { return known.empty() ? known = floors(length) : known; };
    double reach = tangent_reach(*lanes.here, tolerance_, std::abs(length), least);
    if (reach >= whole_ * std::abs(length))
        reach = std::abs(length);
    const auto evaluate_at = [&](double step) {
        if (at_ != step) {
            jet_->evaluate_states({&step, 1}, state_);
            begin_end(next, step);
        }
        lanes.here->evaluate(step, sums_, slopes_);
        lanes.there->load(sums_, *lanes.here);
        lanes.there->begin(next);
    };
    const TangentEndpoints places{*lanes.here, *lanes.there, sums_,
                                  slopes_,     states_,      std::min(lanes.here->width(), directions_ - first_),
                                  evaluate_at};
    return follow_tangents(places, tolerance_, std::copysign(reach, length), least, [this] { return noise(); });
}

double TangentSteps::carry(Jet& next, double length, std::span<double> after, std::span<const double> end) {
    constexpr std::size_t most_rounds = 100;
    if (jet_ == nullptr)
        throw OrderError("derivatives are carried along a step that has begun");
    require_size(after.size(), states_ * directions_, "derivatives");
    at_ = std::numeric_limits<double>::quiet_NaN();
    if (!end.empty()) {
        require_size(end.size(), states_, "states");
        std::copy(end.begin(), end.end(), state_.begin());
        begin_end(next, length);
    }
    const std::size_t width = lanes_of_mode().here->width(), passes = (directions_ + width - 1) / width;
    // Where later directions shorten the step, the earlier ones are repeated for the shorter step.
    std::size_t agreeing = 0; // consecutive passes that reached the present length
    for (std::size_t pass = 0; agreeing < passes && pass < most_rounds * passes; ++pass) {
        const std::size_t first = pass % passes * width, count = std::min(width, directions_ - first);
        load(first);
        const double part = follow(next, length);
        if (std::isnan(part))
            return part;
        agreeing = part == length ? agreeing + 1 : 1;
        length = part;
        for (std::size_t i = 0; i < states_; ++i)
            std::copy_n(&sums_[i * width], count, &after[i * directions_ + first]);
    }
    return length;
}

void TangentSteps::cross(double length, std::span<double> after) {
    if (jet_ == nullptr)
        throw OrderError("derivatives are carried along a step that has begun");
    require_size(after.size(), states_ * directions_, "derivatives");
    const std::size_t width = lanes_of_mode().here->width();
    for (std::size_t first = 0; first < directions_; first += width) {
        load(first);
        lanes_of_mode().here->evaluate(length, sums_, slopes_);
        for (std::size_t i = 0; i < states_; ++i)
            std::copy_n(&sums_[i * width], std::min(width, directions_ - first), &after[i * directions_ + first]);
    }
    jet_->evaluate_states({&length, 1}, state_);
}

std::vector<std::uint32_t> TangentSteps::groups_with_events() const {
    std::vector<std::uint32_t> groups = groups_;
    groups.push_back(LinearMode::of_events);
    return groups;
}

void TangentSteps::event_at_end(Jet& next, std::span<const double> after, std::size_t watched,
                                std::span<double> row) const {
    require_size(row.size(), directions_, "derivatives of an event");
    next.begin_deferred(groups_with_events());
    std::fill(row.begin(), row.end(), 0.0);
    for (const TangentEntry& entry : system_.linear(mode_).events) {
        if (entry.row != watched || (entry.source >= states_ && moving_[entry.source - states_] == 0))
            continue;
        const double slope = *next.deferred(entry.deferred);
        const double* change = entry.source < states_ ? &after[entry.source * directions_]
                                                      : &parameter_seeds_[(entry.source - states_) * directions_];
        for (std::size_t d = 0; d < directions_; ++d)
            row[d] += slope * change[d];
    }
}

void TangentSteps::event_coefficient(std::size_t watched, std::size_t k, std::span<double> row) {
    require_size(row.size(), directions_, "derivatives of an event");
    jet_->compute_deferred(groups_with_events());
    std::fill(row.begin(), row.end(), 0.0);
    const LinearMode& linear = system_.linear(mode_);
    const std::size_t width = lanes_of_mode().here->width();
    for (std::size_t first = 0; first < directions_; first += width) {
        load(first);
        const TangentSeries& here = *lanes_[mode_].here;
        for (const TangentEntry& entry : linear.events) {
            const double* change = here.source(entry.source);
            if (entry.row != watched || change == nullptr)
                continue;
            const double* slope = jet_->deferred(entry.deferred);
            const std::size_t degree = linear.tape.deferred[entry.deferred].constant ? 0 : k;
            for (std::size_t j = 0; j <= degree; ++j)
                for (std::size_t l = 0; l < width && first + l < directions_; ++l)
                    row[first + l] += slope[j] * change[(k - j) * width + l];
        }
    }
}

} // namespace graze
