#include "trajectory/tangents.hpp"

#include "trajectory/saltation.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace graze {

namespace {

/// The steps of the motion are unchanged. After a part of a step the motion's series must be computed again, so that
/// derivatives are propagated to the end if this share is reached; the check at the end shows whether they are
/// accurate.
constexpr double whole_step = 0.9;

} // namespace

Tangents::Tangents(const Simulation& simulation, std::span<const double> parameters, std::span<const double> seeds,
                   std::size_t directions)
    : simulation_(simulation), parameters_(parameters.begin(), parameters.end()), states_(simulation.system().states()),
      directions_(directions), steps_(simulation.system(), simulation.options().tolerance, directions, whole_step),
      parameter_seeds_(parameters_.size() * directions), matrix_(states_ * directions), next_(states_ * directions) {
    for (std::size_t d = 0; d < directions; ++d) {
        const auto seed = seeds.subspan(d * (states_ + parameters_.size()), states_ + parameters_.size());
        for (std::size_t i = 0; i < states_; ++i)
            matrix_[i * directions + d] = seed[i];
        for (std::size_t j = 0; j < parameters_.size(); ++j)
            parameter_seeds_[j * directions + d] = seed[states_ + j];
    }
    steps_.set_parameters(parameters, parameter_seeds_);
    find_period_rates(simulation.system(), parameters);
}

void Tangents::find_period_rates(const System& system, std::span<const double> parameters) {
    const Function& gradients = system.period_gradients();
    const bool cyclic = std::any_of(system.model().states.begin(), system.model().states.end(),
                                    [](const State& state) { return state.period.has_value(); });
    if (!cyclic)
        return;
    const std::vector<double> rates = gradients(parameters);
    if (std::all_of(rates.begin(), rates.end(), [](double rate) { return rate == 0; }))
        return;
    period_rates_.assign(states_ * directions_, 0.0);
    for (std::size_t i = 0; i < states_; ++i)
        for (std::size_t j = 0; j < parameters_.size(); ++j)
            for (std::size_t d = 0; d < directions_; ++d)
                period_rates_[i * directions_ + d] +=
                    rates[i * parameters_.size() + j] * parameter_seeds_[j * directions_ + d];
}

void Tangents::set_back(std::size_t state, double periods) {
    if (period_rates_.empty())
        return;
    for (std::size_t d = 0; d < directions_; ++d)
        matrix_[state * directions_ + d] -= periods * period_rates_[state * directions_ + d];
}

/// Begins a step at a state. @return the jet to be begun at its end
Jet& Tangents::begin(std::size_t mode, std::span<const double> state) {
    Jet *const given = std::exchange(jet_, nullptr), *const next = std::exchange(next_jet_, nullptr);
    if (given != nullptr) {
        steps_.begin(*given, mode, state, matrix_);
        return *next;
    }
    if (!jets_) {
        jets_ = std::make_unique<ModeJets>(simulation_.system(), simulation_.order(), LaneKind::single);
        jets_->add_tangents();
        jets_->set_parameters(parameters_);
    }
    steps_.begin(jets_->computed(mode, state), mode, state, matrix_);
    return jets_->next(mode);
}

void Tangents::coefficient(std::size_t mode, std::span<const double> state, std::size_t watched, std::size_t k,
                           std::span<double> row) {
    begin(mode, state);
    steps_.event_coefficient(watched, k, row);
}

void Tangents::advance(std::size_t mode, std::span<const double> state, double s, std::size_t watched,
                       std::span<double> row) {
    if (std::exchange(crosses_knot_, false)) {
        Jet& next = begin(mode, state);
        steps_.cross(s, next_);
        matrix_.swap(next_);
        if (!row.empty()) {
            next.begin(steps_.state());
            steps_.event_at_end(next, matrix_, watched, row);
        }
        return;
    }
    // In parts, if derivatives are faster than the states.
    for (int part = 0; part < TangentSteps::most_parts; ++part) {
        Jet& next = begin(mode, state);
        const double length = steps_.carry(next, s, next_);
        if (std::isnan(length))
            return invalidate();
        matrix_.swap(next_);
        if (!(length < s)) {
            if (!row.empty())
                steps_.event_at_end(next, matrix_, watched, row);
            return;
        }
        s -= length;
        here_.assign(steps_.state().begin(), steps_.state().end());
        state = here_;
    }
    invalidate();
}

void Tangents::leave_root(std::size_t mode, std::span<const double> state, double duration) {
    const System& system = simulation_.system();
    if (!system.mode(mode).ends_at_root)
        return;
    const std::size_t columns = states_ + parameters_.size();
    if (!flow_) {
        std::vector<ParameterId> all;
        for (std::size_t j = 0; j < parameters_.size(); ++j)
            all.emplace_back(j);
        flow_ = std::make_unique<ModeFlow>(system, simulation_.options().tolerance, simulation_.order(), all);
        flow_->set_parameters(parameters_);
    }
    here_.assign(state.begin(), state.end());
    std::vector<double> by_start(states_ * columns);
    if (flow_->run(mode, here_, duration, by_start) != ModeFlow::Ending::done)
        return;
    for (std::size_t i = 0; i < states_; ++i)
        for (std::size_t d = 0; d < directions_; ++d) {
            double sum = 0;
            for (std::size_t j = 0; j < columns; ++j)
                sum += by_start[i * columns + j] *
                       (j < states_ ? matrix_[j * directions_ + d] : parameter_seeds_[(j - states_) * directions_ + d]);
            next_[i * directions_ + d] = sum;
        }
    matrix_.swap(next_);
}

void Tangents::pass_jump(std::span<const double> shift, std::span<const double> field_before,
                         const System::CompiledJump& jump, std::span<const double> jacobian,
                         std::span<const double> field_after) {
    graze::pass_jump({shift, field_before, field_after, jump, jacobian, parameter_seeds_}, matrix_, next_);
}

void Tangents::add_product(std::span<const double> column, std::span<const double> row) {
    graze::add_product(matrix_, column, row);
}

} // namespace graze
