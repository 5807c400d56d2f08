#include "graze/flow/dormant_states.hpp"

#include "flow/couplings.hpp"
#include "graze/base/require.hpp"
#include "graze/flow/step_check.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace graze {

namespace {

/// Number of steps before the first test, and largest number between two tests: a test costs about as much as a step.
constexpr int first_interval = 16, longest_interval = 1024;
/// Factors by which floors must lengthen steps to be worth their cost, when they are first used and later.
constexpr double gain_to_begin = 1.5, gain_to_continue = 1.2;
/// The test assumes a step of at most this multiple of the last one.
constexpr double growth = 2;

} // namespace

DormantStates::DormantStates(const System& system) : system_(system) {}
DormantStates::~DormantStates() = default;
DormantStates::DormantStates(DormantStates&&) noexcept = default;
DormantStates& DormantStates::operator=(DormantStates&&) noexcept = default;

void DormantStates::set_parameters(std::span<const double> parameters) {
    require_size(parameters.size(), system_.parameters(), "independent parameters");
    parameters_.assign(parameters.begin(), parameters.end());
    if (couplings_)
        couplings_->set_parameters(parameters_);
    begin();
}

void DormantStates::begin() {
    dormant_ = false;
    until_test_ = interval_ = first_interval;
}

double DormantStates::step(const StepSize& step_size, std::size_t mode, std::span<const Series> series, double step,
                           double previous) {
    if (!dormant_ && --until_test_ > 0)
        return step;
    // Steps that become shorter are not limited by dormant states.
    if (!(previous > 0 && std::isfinite(step)) || (!dormant_ && step < previous)) {
        dormant_ = false;
        until_test_ = first_interval;
        return step;
    }
    const double longer = with_floors(step_size, mode, series, previous);
    const bool was_dormant = dormant_;
    dormant_ = std::isfinite(longer) && longer > (was_dormant ? gain_to_continue : gain_to_begin) * step;
    if (dormant_)
        return std::min(longer, growth * previous);
    interval_ = was_dormant ? first_interval : std::min(2 * interval_, longest_interval);
    until_test_ = interval_;
    return step;
}

/// Returns the step if states are measured by their size or by the effect of other states until its end; 0 if none is
/// dormant.
double DormantStates::with_floors(const StepSize& step_size, std::size_t mode, std::span<const Series> series,
                                  double previous) {
    const std::size_t states = system_.states();
    if (!couplings_) {
        couplings_ = std::make_unique<ModeCouplings>(system_);
        couplings_->set_parameters(parameters_);
    }
    if (!couplings_->of(mode).any_constant_drive())
        return 0; // no state can be dormant
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
        const bool raised = i < states && couplings.has_constant_drive(i) &&
                            (floors_[i] > sizes_[i] || sizes_[i] < StepCheck::smallest_size);
        floors_[i] = raised ? std::max(floors_[i], StepCheck::smallest_size) : 0;
        (raised ? raised_ : others_).push_back(series[i]);
        if (raised)
            raised_floors_.push_back(floors_[i]);
    }
    // The other states are measured by their own sizes.
    const double step = others_.empty() ? std::numeric_limits<double>::infinity() : step_size(others_, previous);
    return std::min(step, step_size.with_floors(raised_, previous, raised_floors_));
}

} // namespace graze
