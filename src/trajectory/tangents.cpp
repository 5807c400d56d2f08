#include "trajectory/tangents.hpp"

#include "trajectory/saltation.hpp"

#include <algorithm>

namespace graze {

Tangents::Tangents(const Simulation& simulation, std::span<const double> parameters, std::span<const double> seeds,
                   std::size_t directions)
    : states_(simulation.system().states()), parameter_count_(parameters.size()), directions_(directions),
      steps_(simulation.system(), simulation.order(), simulation.options().tolerance, directions),
      parameter_seeds_(parameter_count_ * directions), matrix_(states_ * directions), next_(states_ * directions) {
    for (std::size_t d = 0; d < directions; ++d) {
        const auto seed = seeds.subspan(d * (states_ + parameter_count_), states_ + parameter_count_);
        for (std::size_t i = 0; i < states_; ++i)
            matrix_[i * directions + d] = seed[i];
        for (std::size_t j = 0; j < parameter_count_; ++j)
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
        for (std::size_t j = 0; j < parameter_count_; ++j)
            for (std::size_t d = 0; d < directions_; ++d)
                period_rates_[i * directions_ + d] +=
                    rates[i * parameter_count_ + j] * parameter_seeds_[j * directions_ + d];
}

void Tangents::set_back(std::size_t state, double periods) {
    if (period_rates_.empty())
        return;
    for (std::size_t d = 0; d < directions_; ++d)
        matrix_[state * directions_ + d] -= periods * period_rates_[state * directions_ + d];
}

void Tangents::coefficient(std::size_t mode, std::span<const double> state, std::size_t series, int k,
                           std::span<double> row) {
    for (std::size_t first = 0; first < directions_;) {
        const Jet& jet = steps_.begin(mode, state, matrix_, first);
        const auto width = static_cast<std::size_t>(jet.width());
        const std::size_t count = steps_.count_from(first);
        std::copy_n(&jet.output(series)[static_cast<std::size_t>(k) * width + 1], count, &row[first]);
        first += count;
    }
}

void Tangents::advance(std::size_t mode, std::span<const double> state, double s, std::size_t series,
                       std::span<double> row) {
    // In parts, where derivatives are faster than the states.
    for (int part = 0; part < TangentSteps::most_parts; ++part) {
        steps_.begin(mode, state, matrix_);
        const double length = steps_.carry(mode, state, matrix_, s, next_, series, row);
        if (length == 0 && s != 0)
            break;
        matrix_.swap(next_);
        if (!(length < s))
            return;
        s -= length;
        here_.assign(steps_.state().begin(), steps_.state().end());
        state = here_;
    }
    invalidate();
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
