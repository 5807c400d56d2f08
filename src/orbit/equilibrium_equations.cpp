#include "orbit/equilibrium_equations.hpp"

#include "base/concatenated.hpp"
#include "base/decompositions.hpp"
#include "graze/base/require.hpp"
#include "graze/symbolic/transform.hpp"
#include "model/unused_symbol.hpp"
#include "orbit/eigen_index.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <set>

namespace graze {

SparseDerivatives::SparseDerivatives(const SymbolIndex& inputs, std::span<const Expression> expressions,
                                     std::span<const Expression> symbols)
    : rows_(index(expressions.size())), columns_(index(symbols.size())) {
    std::vector<Expression> values;
    for (JacobianEntry& entry : sparse_jacobian(expressions, SymbolIndex(symbols))) {
        places_.push_back({index(entry.row), index(entry.column)});
        values.push_back(std::move(entry.value));
    }
    values_ = Function(inputs, values);
}

Eigen::MatrixXd SparseDerivatives::operator()(std::span<const double> inputs) const {
    const std::vector<double> values = values_(inputs);
    Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(rows_, columns_);
    for (std::size_t i = 0; i < places_.size(); ++i)
        matrix(places_[i].row, places_[i].column) = values[i];
    return matrix;
}

EquilibriumEquations::EquilibriumEquations(const System& system, std::size_t mode, std::vector<ParameterId> free)
    : system_(system), mode_(mode), free_(std::move(free)), model_(system.model()) {
    require_index(mode, model_.modes.size(), "mode");
    const std::vector<Expression> states = model_.state_symbols(), parameters = model_.parameter_symbols();
    rates_of_all_ = model_.expand(model_.modes[mode].rates);
    keep_to_surfaces();
    classify();
    std::vector<Expression> symbols = states;
    symbols.insert(symbols.end(), parameters.begin(), parameters.end());
    for (const std::size_t i : active_) {
        rates_.push_back(rates_of_all_[i]);
        variables_.push_back(states[i]);
        other_.push_back(unused_symbol(model_, "across_" + states[i].name()));
    }
    for (const ParameterId parameter : free_) {
        require_index(parameter.place(), parameters.size(), "independent parameter");
        variables_.push_back(parameters[parameter.place()]);
    }
    for (const Expression& variable : variables_)
        direction_.push_back(unused_symbol(model_, "along_" + variable.name()));
    symbols.insert(symbols.end(), direction_.begin(), direction_.end());
    symbols.insert(symbols.end(), other_.begin(), other_.end());
    symbols_ = SymbolIndex(symbols);
    values_ = Function(symbols_, rates_);
    std::vector<Expression> steady;
    for (const std::size_t i : steady_)
        steady.push_back(rates_of_all_[i]);
    steady_rates_ = Function(symbols_, steady);
    first_ = SparseDerivatives(symbols_, rates_, variables_);
    std::vector<Component> along;
    for (std::size_t k = 0; k < variables_.size(); ++k)
        along.emplace_back(variables_[k], direction_[k]);
    second_ = SparseDerivatives(symbols_, differentiate_along(rates_, along), variables_);
}

/// Adds to the rate of a state on which a surface h = 0 depends -c h/h_x, so that h' = -c h.
void EquilibriumEquations::keep_to_surfaces() {
    const std::vector<Expression> states = model_.state_symbols();
    const std::vector<SlidingSurface>& surfaces = model_.modes[mode_].slides_on;
    if (surfaces.empty())
        return;
    // A rate like those of the motion: its size does not matter for the result.
    const Function field = system_.function_of(graze::jacobian(rates_of_all_, states));
    const std::vector<double> values = field(concatenated(model_.initial_state(), model_.parameter_values()));
    double fastest = 0;
    if (const auto found =
            vector_of(values).allFinite()
                ? eigenvalues(Eigen::Map<const RowMajor>(values.data(), index(states.size()), index(states.size())))
                : std::nullopt)
        fastest = found->cwiseAbs().maxCoeff();
    std::set<std::size_t> used;
    for (const SlidingSurface& surface : surfaces) {
        const Expression h = model_.expand(model_.events[surface.surface].function);
        for (std::size_t i = 0; i < states.size(); ++i) {
            const Expression slope = differentiate(h, states[i]);
            if (slope.is_number(0) || model_.states[i].period || !used.insert(i).second)
                continue;
            const double rate = (fastest > 0 ? fastest : 1) * (1 + 0.37 * static_cast<double>(added_.size()));
            rates_of_all_[i] = rates_of_all_[i] - rate * h / slope;
            added_.push_back(-rate);
            break;
        }
    }
}

void EquilibriumEquations::classify() {
    const std::vector<Expression> states = model_.state_symbols();
    for (std::size_t i = 0; i < states.size(); ++i) {
        const Expression& rate = rates_of_all_[i];
        if (model_.states[i].drifting || rate.is_number(0))
            continue;
        const std::vector<Expression> in_rate = symbols_of(std::span(&rate, 1));
        const bool depends = std::ranges::any_of(
            in_rate, [&](const Expression& one) { return std::ranges::find(states, one) != states.end(); });
        (depends ? active_ : model_.states[i].period ? clocks_ : steady_).push_back(i);
    }
}

std::vector<double> EquilibriumEquations::inputs(std::span<const double> state,
                                                 std::span<const double> parameters) const {
    std::vector<double> all = concatenated(state, parameters);
    all.resize(symbols_.size(), 0.0);
    return all;
}

std::string EquilibriumEquations::why_none(std::span<const double> parameters) const {
    const std::vector<double> state(system_.states(), 0.0);
    const std::vector<double> moving = steady_rates_(inputs(state, parameters));
    for (std::size_t k = 0; k < steady_.size(); ++k)
        if (moving[k] != 0)
            return fmt::format("state '{}' moves steadily in mode '{}'", model_.states[steady_[k]].name,
                               model_.modes[mode_].name);
    return "";
}

Function EquilibriumEquations::rates_for_search() const {
    const std::vector<Expression> states = model_.state_symbols(), parameters = model_.parameter_symbols();
    const auto unknowns = std::span(variables_).first(active_.size());
    std::vector<Expression> inputs(unknowns.begin(), unknowns.end()), outputs = rates_;
    for (std::size_t i = 0; i < states.size(); ++i)
        if (std::ranges::find(active_, i) == active_.end())
            inputs.push_back(states[i]);
    inputs.insert(inputs.end(), parameters.begin(), parameters.end());
    const std::vector<Expression> derivatives = graze::jacobian(rates_, unknowns);
    outputs.insert(outputs.end(), derivatives.begin(), derivatives.end());
    return {inputs, outputs};
}

Eigen::VectorXd EquilibriumEquations::rates(std::span<const double> state, std::span<const double> parameters) const {
    return vector_of(values_(inputs(state, parameters)));
}

Eigen::VectorXd EquilibriumEquations::round_off(std::span<const double> state,
                                                std::span<const double> parameters) const {
    const std::vector<double> all = inputs(state, parameters), exact(all.size(), 0.0);
    std::vector<double> bounds(active_.size()), work(2 * values_.workspace());
    values_.error_bounds(all, exact, bounds, work);
    return vector_of(bounds);
}

Eigen::MatrixXd EquilibriumEquations::jacobian(std::span<const double> state,
                                               std::span<const double> parameters) const {
    return first_(inputs(state, parameters));
}

Eigen::MatrixXd EquilibriumEquations::second(std::span<const double> state, std::span<const double> parameters,
                                             const Eigen::VectorXd& direction) const {
    std::vector<double> all = inputs(state, parameters);
    std::ranges::copy(direction, all.begin() + static_cast<std::ptrdiff_t>(state.size() + parameters.size()));
    return second_(all);
}

EquilibriumThirdDerivatives::EquilibriumThirdDerivatives(const EquilibriumEquations& equations)
    : equations_(&equations) {
    const auto states = std::span(equations.variables_).first(equations.active_.size());
    std::vector<Component> along, across;
    for (std::size_t k = 0; k < states.size(); ++k) {
        along.emplace_back(states[k], equations.direction_[k]);
        across.emplace_back(states[k], equations.other_[k]);
    }
    derivatives_ = SparseDerivatives(equations.symbols_,
                                     differentiate_along(differentiate_along(equations.rates_, along), across), states);
}

Eigen::MatrixXd EquilibriumThirdDerivatives::operator()(std::span<const double> state,
                                                        std::span<const double> parameters, const Eigen::VectorXd& one,
                                                        const Eigen::VectorXd& other) const {
    std::vector<double> all = equations_->inputs(state, parameters);
    const auto place = all.begin() + static_cast<std::ptrdiff_t>(state.size() + parameters.size());
    std::ranges::copy(one, place);
    std::ranges::copy(other, place + static_cast<std::ptrdiff_t>(equations_->direction_.size()));
    return derivatives_(all);
}

} // namespace graze
