#include "sweep/field_map.hpp"

#include "graze/symbolic/transform.hpp"

#include <algorithm>
#include <cmath>

namespace graze {

FieldMap::FieldMap(const System& system) : system_(system) {
    Model model = system.model();
    const std::vector<Expression> states = model.state_symbols(), inputs = model.inputs();
    for (const Mode& mode : model.modes) {
        std::vector<Expression> outputs;
        for (const Expression& rate : model.expand(mode.rates))
            for (const Expression& state : states)
                outputs.push_back(differentiate(rate, state));
        jacobians_.emplace_back(inputs, outputs);
    }
}

FieldMap::Workspace FieldMap::workspace(std::span<const double> parameters) const {
    Workspace workspace;
    const std::size_t count = states();
    workspace.inputs.resize(count + parameters.size());
    std::copy(parameters.begin(), parameters.end(), workspace.inputs.begin() + static_cast<std::ptrdiff_t>(count));
    std::size_t work = system_.workspace(), watched = 0;
    for (const Function& function : jacobians_)
        work = std::max(work, function.workspace());
    for (std::size_t m = 0; m < jacobians_.size(); ++m)
        watched = std::max(watched, system_.mode(m).watched.size());
    workspace.work.resize(work);
    workspace.rates.resize(count);
    workspace.jacobian.resize(count * count);
    workspace.events.resize(watched);
    workspace.event_gradients.resize(watched * count);
    return workspace;
}

void FieldMap::evaluate_rates(Workspace& workspace, std::size_t mode, std::span<const double> state) const {
    std::copy(state.begin(), state.end(), workspace.inputs.begin());
    system_.mode(mode).rates.evaluate(workspace.inputs, workspace.rates, workspace.work);
}

void FieldMap::evaluate(Workspace& workspace, std::size_t mode, std::span<const double> state) const {
    evaluate_rates(workspace, mode, state);
    jacobians_[mode].evaluate(workspace.inputs, workspace.jacobian, workspace.work);
}

void FieldMap::evaluate_events(Workspace& workspace, std::size_t mode, std::span<const double> state) const {
    std::copy(state.begin(), state.end(), workspace.inputs.begin());
    system_.mode(mode).events.evaluate(workspace.inputs, workspace.events, workspace.work);
    system_.mode(mode).event_gradients.evaluate(workspace.inputs, workspace.event_gradients, workspace.work);
}

bool FieldMap::is_affine_beyond(Workspace& workspace, std::size_t mode, std::span<const double> state,
                                std::span<const double> extents, std::span<const double> periods) const {
    // Second differences vanish, but for round-off of values that are up to a million times as large as the first.
    constexpr double vanishing = 1e-8;
    const std::size_t count = states();
    std::vector<double> step(count), at(count);
    std::vector<std::vector<double>> rates(3, std::vector<double>(count));
    const Model& model = system_.model();
    bool any = false;
    for (std::size_t pattern = 0; pattern < 2 * count + 2; ++pattern) {
        for (std::size_t i = 0; i < count; ++i) {
            const bool moves = !(periods[i] > 0) && !model.states[i].drifting && extents[i] > 0;
            // One state at a time, then all together in two ways.
            const bool chosen = pattern < 2 * count ? pattern / 2 == i : true;
            const bool backwards = pattern < 2 * count ? pattern % 2 == 1 : pattern % 2 == 1 && i % 2 == 1;
            step[i] = moves && chosen ? (backwards ? -1 : 1) * std::max(extents[i], std::abs(state[i])) : 0;
            any = any || step[i] != 0;
        }
        for (double reach = 1; reach < 2e6; reach *= 10) {
            for (std::size_t k = 0; k < 3; ++k) {
                for (std::size_t i = 0; i < count; ++i)
                    at[i] = state[i] + static_cast<double>(k) * reach * step[i];
                evaluate_rates(workspace, mode, at);
                rates[k] = workspace.rates;
            }
            for (std::size_t i = 0; i < count; ++i) {
                const double size = std::abs(rates[0][i]) + std::abs(rates[1][i]) + std::abs(rates[2][i]);
                if (!(std::abs(rates[2][i] - 2 * rates[1][i] + rates[0][i]) <= vanishing * size))
                    return false;
            }
        }
    }
    return any;
}

} // namespace graze
