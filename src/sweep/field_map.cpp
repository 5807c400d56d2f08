#include "sweep/field_map.hpp"

#include "graze/symbolic/transform.hpp"

#include <algorithm>
#include <cmath>

namespace graze {

bool changes_nothing(const Transition& transition) {
    return transition.jump == 0 && std::ranges::all_of(transition.next, [&](const Alternative& next) {
               return next.mode && *next.mode == transition.mode;
           });
}

namespace {

/// Returns whether a state stays zero in all modes and jumps, as far as simplification shows.
bool vanishes_with(Model& model, std::size_t state, const Expression& symbol) {
    if (model.states[state].period || model.states[state].drifting)
        return false;
    const std::vector<Replacement> nought{{symbol, model.number(0)}};
    const auto vanishes = [&](const Expression& expression) {
        return substitute(model.expand(expression), nought).is_number(0);
    };
    const std::vector<Jump>& jumps = model.jumps;
    return std::ranges::all_of(model.modes, [&](const Mode& mode) { return vanishes(mode.rates[state]); }) &&
           std::ranges::all_of(jumps, [&](const Jump& jump) { return vanishes(jump.map[state]); });
}

/// Returns whether a state is constant in all modes and jumps.
bool never_changes(Model& model, std::size_t state, const Expression& symbol) {
    const std::vector<Jump>& jumps = model.jumps;
    return std::ranges::all_of(model.modes,
                               [&](const Mode& mode) { return model.expand(mode.rates[state]).is_number(0); }) &&
           std::ranges::all_of(jumps, [&](const Jump& jump) { return jump.map[state] == symbol; });
}

/// Returns whether each state is a clock: no state acts on its rate. @param jacobian of the rates, row by row
std::vector<bool> clocks_among(const std::vector<Expression>& jacobian, std::size_t states) {
    std::vector<bool> clocks;
    for (std::size_t i = 0; i < states; ++i)
        clocks.push_back(std::all_of(jacobian.begin() + static_cast<std::ptrdiff_t>(i * states),
                                     jacobian.begin() + static_cast<std::ptrdiff_t>((i + 1) * states),
                                     [](const Expression& entry) { return entry.is_number(0); }));
    return clocks;
}

/// Returns whether rates are affine in all states except clocks and drifting states; they must not depend on angles,
/// since the field would not be linear over several turns.
bool is_affine(const Model& model, const std::vector<Expression>& jacobian, const std::vector<Expression>& states,
               const std::vector<bool>& clocks) {
    std::vector<Expression> entries, others;
    for (std::size_t i = 0; i < states.size(); ++i) {
        if (!clocks[i])
            others.push_back(states[i]);
        for (std::size_t j = 0; j < states.size(); ++j) {
            const Expression& entry = jacobian[i * states.size() + j];
            if (model.states[i].drifting || clocks[j])
                continue;
            if (model.states[j].period && !entry.is_number(0))
                return false;
            entries.push_back(entry);
        }
    }
    const std::vector<Expression> symbols = symbols_of(entries);
    return std::ranges::none_of(others, [&](const Expression& state) {
        return std::find(symbols.begin(), symbols.end(), state) != symbols.end();
    });
}

} // namespace

double even_place(std::size_t k) {
    constexpr double golden = 0.6180339887498949; // golden ratio: its multiples fill the unit interval evenly
    const double x = golden * static_cast<double>(k + 1);
    return x - std::floor(x);
}

FieldMap::FieldMap(const System& system) : system_(system) {
    Model model = system.model();
    const std::vector<Expression> states = model.state_symbols(), inputs = model.inputs();
    for (const Mode& mode : model.modes) {
        std::vector<Expression> outputs;
        for (const Expression& rate : model.expand(mode.rates))
            for (const Expression& state : states)
                outputs.push_back(differentiate(rate, state));
        jacobians_.emplace_back(inputs, outputs);
        clocks_.push_back(clocks_among(outputs, states.size()));
        linear_.push_back(is_affine(model, outputs, states, clocks_.back()));
    }
    for (std::size_t i = 0; i < states.size(); ++i) {
        keeps_sign_.push_back(vanishes_with(model, i, states[i]));
        conserved_.push_back(never_changes(model, i, states[i]));
    }
    for (std::size_t m = 0; m < jacobians_.size(); ++m) {
        std::vector<bool>& changes = changes_.emplace_back();
        for (const std::size_t transition : system.mode(m).transitions)
            changes.push_back(!changes_nothing(system.model().transitions[transition]));
    }
}

FieldMap::Workspace FieldMap::workspace(std::span<const double> parameters) const {
    Workspace workspace;
    const std::size_t count = states();
    workspace.inputs.resize(count + parameters.size());
    std::ranges::copy(parameters, workspace.inputs.begin() + static_cast<std::ptrdiff_t>(count));
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
    std::ranges::copy(state, workspace.inputs.begin());
    system_.mode(mode).rates.evaluate(workspace.inputs, workspace.rates, workspace.work);
}

void FieldMap::evaluate(Workspace& workspace, std::size_t mode, std::span<const double> state) const {
    evaluate_rates(workspace, mode, state);
    jacobians_[mode].evaluate(workspace.inputs, workspace.jacobian, workspace.work);
}

void FieldMap::evaluate_events(Workspace& workspace, std::size_t mode, std::span<const double> state) const {
    std::ranges::copy(state, workspace.inputs.begin());
    system_.mode(mode).events.evaluate(workspace.inputs, workspace.events, workspace.work);
    system_.mode(mode).event_gradients.evaluate(workspace.inputs, workspace.event_gradients, workspace.work);
}

bool FieldMap::is_affine_beyond(Workspace& workspace, std::size_t mode, std::span<const double> state,
                                std::span<const double> extents, std::span<const double> periods) const {
    // Second differences must vanish, except for round-off of values up to a million times larger than the first.
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
        double size = 0;
        for (const double one : step)
            size = std::max(size, std::abs(one));
        for (double reach = 1; reach * size < end_of_growth && size > 0; reach *= 10) {
            for (std::size_t k = 0; k < 3; ++k) {
                for (std::size_t i = 0; i < count; ++i)
                    at[i] = state[i] + static_cast<double>(k) * reach * step[i];
                evaluate_rates(workspace, mode, at);
                rates[k] = workspace.rates;
            }
            for (std::size_t i = 0; i < count; ++i) {
                const double all = std::abs(rates[0][i]) + std::abs(rates[1][i]) + std::abs(rates[2][i]);
                if (!(std::abs(rates[2][i] - 2 * rates[1][i] + rates[0][i]) <= vanishing * all))
                    return false;
            }
        }
    }
    return any;
}

bool FieldMap::keeps_sides(Workspace& workspace, std::size_t mode, std::span<const double> least,
                           std::span<const double> greatest, std::span<const double> periods) const {
    constexpr std::size_t places = 32;
    const std::size_t count = states(), watched = changes_[mode].size();
    std::vector<double> middle(count), half(count), at(count);
    for (std::size_t i = 0; i < count; ++i) {
        middle[i] = periods[i] > 0 ? 0.5 * periods[i] : 0.5 * least[i] + 0.5 * greatest[i];
        half[i] = periods[i] > 0 ? 0.5 * periods[i] : 0.5 * greatest[i] - 0.5 * least[i];
    }
    evaluate_events(workspace, mode, middle);
    const std::vector<double> values = workspace.events, slopes = workspace.event_gradients;
    const auto same_side = [&](std::size_t w) { return workspace.events[w] * (values[w] > 0 ? 1 : -1) > 0; };
    for (std::size_t w = 0; w < watched; ++w) {
        if (!changes_[mode][w])
            continue;
        if (!same_side(w))
            return false;
        // Test the corner towards which the function falls, then the opposite one.
        for (const double sign : {-1.0, 1.0}) {
            for (std::size_t i = 0; i < count; ++i)
                at[i] = middle[i] + (slopes[w * count + i] > 0 ? sign : -sign) * half[i];
            evaluate_events(workspace, mode, at);
            if (!same_side(w))
                return false;
        }
    }
    for (std::size_t k = 0; k < places; ++k) {
        for (std::size_t i = 0; i < count; ++i)
            at[i] = middle[i] + (2 * even_place(k * (2 * i + 1) + 7 * i) - 1) * half[i];
        evaluate_events(workspace, mode, at);
        for (std::size_t w = 0; w < watched; ++w)
            if (changes_[mode][w] && !same_side(w))
                return false;
    }
    return true;
}

} // namespace graze
