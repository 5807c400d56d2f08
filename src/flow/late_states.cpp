#include "graze/flow/late_states.hpp"

#include "flow/couplings.hpp"
#include "graze/base/require.hpp"
#include "graze/flow/step_check.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace graze {

namespace {

/// Steps before the first look, and most of them between two: a look costs about as much as a step.
constexpr int first_look = 16, longest_interval = 1024;
/// How much longer steps have to become for floors to be worth what they cost, and for how long. Longer steps raise
/// them.
constexpr double worth_beginning = 1.5, worth_going_on = 1.2;
/// How far a step is looked ahead, as a multiple of the last one.
constexpr double growth = 2;

} // namespace

LateStates::LateStates(const System& system) : system_(system) {}
LateStates::~LateStates() = default;
LateStates::LateStates(LateStates&&) noexcept = default;
LateStates& LateStates::operator=(LateStates&&) noexcept = default;

void LateStates::set_parameters(std::span<const double> parameters) {
    require_size(parameters.size(), system_.parameters(), "independent parameters");
    parameters_.assign(parameters.begin(), parameters.end());
    if (couplings_)
        couplings_->set_parameters(parameters_);
    begin();
}

void LateStates::begin() {
    late_ = false;
    until_look_ = interval_ = first_look;
}

double LateStates::step(const StepSize& step_size, std::size_t mode, std::span<const Series> series, double step,
                        double previous) {
    if (!late_ && --until_look_ > 0)
        return step;
    // Steps that shrink have other reasons.
    if (!(previous > 0 && std::isfinite(step)) || (!late_ && step < previous)) {
        late_ = false;
        until_look_ = first_look;
        return step;
    }
    const double longer = with_floors(step_size, mode, series, previous);
    const bool was_late = late_;
    late_ = std::isfinite(longer) && longer > (was_late ? worth_going_on : worth_beginning) * step;
    if (late_)
        return std::min(longer, growth * previous);
    interval_ = was_late ? first_look : std::min(2 * interval_, longest_interval);
    until_look_ = interval_;
    return step;
}

/// The step by what a state is now and by what comes to it from others until its end; 0 where no state can be late.
double LateStates::with_floors(const StepSize& step_size, std::size_t mode, std::span<const Series> series,
                               double previous) {
    const std::size_t states = system_.states();
    if (!couplings_) {
        couplings_ = std::make_unique<ModeCouplings>(system_);
        couplings_->set_parameters(parameters_);
    }
    if (!couplings_->of(mode).push_steadily())
        return 0; // no state can be late
    state_.resize(states);
    for (std::size_t i = 0; i < states; ++i)
        state_[i] = series[i][0];
    const Couplings& couplings = couplings_->measured(mode, state_);
    const double time = std::min(growth * previous, couplings.response_time());
    sizes_.resize(states);
    for (std::size_t i = 0; i < states; ++i)
        sizes_[i] = step_size.size_of(series[i], previous);
    floors_.assign(series.size(), 0.0);
    std::copy(sizes_.begin(), sizes_.end(), floors_.begin());
    couplings.spread(time, std::span(floors_).first(states), 1, Couplings::Through::constant);
    raised_.clear();
    others_.clear();
    raised_floors_.clear();
    for (std::size_t i = 0; i < series.size(); ++i) {
        const bool raised = i < states && couplings.is_pushed_steadily(i) &&
                            (floors_[i] > sizes_[i] || sizes_[i] < StepCheck::smallest_size);
        floors_[i] = raised ? std::max(floors_[i], StepCheck::smallest_size) : 0;
        (raised ? raised_ : others_).push_back(series[i]);
        if (raised)
            raised_floors_.push_back(floors_[i]);
    }
    // The others are measured as ever.
    const double step = others_.empty() ? std::numeric_limits<double>::infinity() : step_size(others_, previous);
    return std::min(step, step_size.with_floors(raised_, previous, raised_floors_));
}

} // namespace graze
