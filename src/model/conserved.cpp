#include "graze/model/conserved.hpp"

#include "base/concatenated.hpp"
#include "graze/symbolic/function.hpp"
#include "graze/symbolic/symbol_index.hpp"
#include "graze/symbolic/transform.hpp"
#include "model/model_expressions.hpp"
#include "model/moved_together.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <set>
#include <utility>

namespace graze {

namespace {

/// Changes below this share of the terms of which they are made are round-off.
constexpr double unchanged_share = 1e-9;

/// Returns a state around another one. @param turn goes on with each number, so that they do not repeat
std::vector<double> state_around(std::vector<double> state, double distance, double& turn) {
    for (double& value : state)
        value += distance * std::sin(turn += 2.4); // the golden angle
    return state;
}

/// Returns all that decides on motions, but jumps, in terms of states and parameters.
std::vector<Expression> deciding_expressions(Model& model) {
    std::vector<Expression> result;
    for (const Mode& mode : model.modes) {
        result.insert(result.end(), mode.rates.begin(), mode.rates.end());
        for (const ConservedQuantity& conserved : model.conserved)
            if (const Expression* own = conserved_in(conserved, mode.name))
                result.push_back(*own);
    }
    for (const Event& event : model.events)
        result.push_back(event.function);
    const auto add_all = [&](const std::vector<Condition>& when) {
        for (const Condition& condition : when)
            result.push_back(condition.function);
    };
    for (const Transition& transition : model.transitions) {
        add_all(transition.when);
        for (const Alternative& alternative : transition.next)
            add_all(alternative.when);
    }
    for (const Section& section : model.sections)
        if (!section.state)
            result.push_back(section.function);
    return model.expand(result);
}

/// Evaluates a conserved quantity at states around the initial one.
class ConservedCheck {
public:
    ConservedCheck(Model model, const ConservedQuantity& conserved)
        : model_(std::move(model)), name_(conserved.name), inputs_(model_.inputs()),
          parameters_(model_.parameter_values()), initial_(model_.initial_state()) {
        for (const Mode& mode : model_.modes) {
            const Expression* own = conserved_in(conserved, mode.name);
            values_.push_back(own ? model_.expand(model_.graph->adopt(*own)) : model_.number(0));
            compiled_.emplace_back(inputs_, std::span(&values_.back(), 1));
            rates_.push_back(model_.expand(mode.rates));
        }
    }

    /// Says that the expressions are the same at all states.
    std::string why_constant() const {
        for (const Expression& value : values_)
            for (const Expression& derivative : jacobian({&value, 1}, model_.state_symbols()))
                if (!derivative.is_number(0))
                    return "";
        return fmt::format("'{}' is no first integral: it has the same value at all states", name_);
    }
    /// Says why the expressions are no quantity that could be conserved. The initial state is one of its own mode only.
    std::string why_none() const {
        const std::size_t mode = model_.initial_mode;
        std::string place;
        const std::string some = first_of([&](const State& state) -> std::string {
            place = at(state);
            return std::isfinite(value(mode, state)) ? "a number" : "";
        });
        return some.empty() ? never_a_number(mode, place) : why_constant();
    }

    std::string why() {
        if (std::string why = why_none(); !why.empty())
            return why;
        for (std::size_t mode = 0; mode < model_.modes.size(); ++mode)
            if (std::string why = changed_in(mode); !why.empty())
                return why;
        for (std::size_t mode = 0; mode < model_.modes.size(); ++mode)
            if (std::string why = changed_by_period(mode); !why.empty())
                return why;
        for (const Transition& transition : model_.transitions)
            if (std::string why = changed_by(transition); !why.empty())
                return why;
        return "";
    }

    /// The same along a motion. Its largest terms measure the rate everywhere, since all of them vanish where it rests.
    std::string why_along(std::span<const StateInMode> motion) const {
        std::vector<std::optional<Function>> rates(model_.modes.size());
        const StateInMode* worst = nullptr;
        double rate = 0, size = 0;
        std::vector<const StateInMode*> undefined(model_.modes.size());
        std::vector<bool> defined(model_.modes.size());
        for (const StateInMode& one : motion) {
            if (!rates[one.mode])
                rates[one.mode] = Function(inputs_, rate_terms(one.mode));
            const auto [sum, terms] = sums_of((*rates[one.mode])(concatenated(one.state, parameters_)));
            if (!std::isfinite(terms) || !std::isfinite(value(one.mode, one.state))) {
                undefined[one.mode] = &one;
                continue;
            }
            defined[one.mode] = true;
            size = std::max(size, terms);
            if (worst == nullptr || std::abs(sum) > std::abs(rate)) {
                worst = &one;
                rate = sum;
            }
        }
        for (std::size_t mode = 0; mode < undefined.size(); ++mode)
            if (undefined[mode] != nullptr && !defined[mode])
                return never_a_number(mode, at(undefined[mode]->state));
        return worst != nullptr && std::abs(rate) > unchanged_share * size ? changes_at(worst->mode, rate, worst->state)
                                                                           : "";
    }

private:
    using State = std::vector<double>;

    std::string never_a_number(std::size_t mode, const std::string& place) const {
        return fmt::format("'{}' is no first integral: in mode '{}' it is not a number (as at {})", name_,
                           model_.modes[mode].name, place);
    }
    std::string changes_at(std::size_t mode, double rate, const State& state) const {
        return fmt::format("'{}' is not conserved: in mode '{}' it changes at the rate {:.4g} (at {})", name_,
                           model_.modes[mode].name, rate, at(state));
    }

    /// Calls a function with states around the initial one until it returns a text.
    template <class Visit>
    std::string first_of(const Visit& visit) const {
        constexpr int states = 6;
        double turn = 0;
        for (const double distance : {0.01, 0.3, 1.0, 3.0})
            for (int k = 0; k < states; ++k) {
                if (std::string text = visit(state_around(initial_, distance, turn)); !text.empty())
                    return text;
            }
        return "";
    }
    std::string at(const State& state) const {
        std::string text;
        for (std::size_t i = 0; i < state.size(); ++i)
            text += fmt::format("{}{} = {:.4g}", i == 0 ? "" : ", ", model_.states[i].name, state[i]);
        return text;
    }
    double value(std::size_t mode, const State& state) const {
        return compiled_[mode](concatenated(state, parameters_))[0];
    }

    /// The rate is a sum over states of products of a derivative and a rate, whose terms measure it.
    std::vector<Expression> rate_terms(std::size_t mode) const {
        const std::vector<Expression> states = model_.state_symbols();
        std::vector<Expression> terms = jacobian({&values_[mode], 1}, states);
        for (std::size_t i = 0; i < states.size(); ++i)
            terms[i] = terms[i] * rates_[mode][i];
        return terms;
    }
    /// Returns the sum of terms, and that of their sizes.
    static std::pair<double, double> sums_of(const std::vector<double>& terms) {
        double sum = 0, size = 0;
        for (const double term : terms) {
            sum += term;
            size += std::abs(term);
        }
        return {sum, size};
    }
    std::string changed_in(std::size_t mode) const {
        const Function all(inputs_, rate_terms(mode));
        return first_of([&](const State& state) -> std::string {
            const auto [sum, size] = sums_of(all(concatenated(state, parameters_)));
            return std::isfinite(size) && std::abs(sum) > unchanged_share * size ? changes_at(mode, sum, state) : "";
        });
    }

    std::string changed_by_period(std::size_t mode) {
        const std::vector<double> periods = model_.periods();
        return first_of([&](State state) -> std::string {
            const double before = value(mode, state);
            for (std::size_t i = 0; i < periods.size(); ++i) {
                if (!(periods[i] > 0))
                    continue;
                const double start = state[i];
                state[i] += periods[i];
                const double after = value(mode, state);
                state[i] = start;
                if (changes(before, after))
                    return fmt::format("'{}' is not conserved: after a period of '{}' it is {:.6g} instead of {:.6g}",
                                       name_, model_.states[i].name, after, before);
            }
            return "";
        });
    }
    static bool changes(double before, double after) {
        constexpr double tolerance = 1e-8;
        return std::isfinite(before) && std::isfinite(after) &&
               std::abs(after - before) > tolerance * (std::abs(before) + std::abs(after));
    }

    /// Compares the values on both sides of a transition, at states on the surface of its event that fall through it.
    std::string changed_by(const Transition& transition) {
        const std::vector<Expression> states = model_.state_symbols();
        const Expression surface = model_.expand(model_.events[transition.event].function);
        std::vector<Expression> with_gradient = jacobian({&surface, 1}, states);
        with_gradient.insert(with_gradient.begin(), surface);
        std::vector<Expression> images = states, when;
        for (const StateMap::Change& change : changes_of(model_.jumps[transition.jump].map, states, identity_))
            images[change.state] = model_.expand(change.image);
        for (const Alternative& alternative : transition.next)
            for (const Condition& condition : alternative.when)
                when.push_back(model_.expand(condition.function));
        const Function function(inputs_, with_gradient), rates(inputs_, rates_[transition.mode]), jump(inputs_, images),
            conditions(inputs_, when);
        return first_of([&](State state) -> std::string {
            if (!put_on(function, state) || !(rate_on(function, rates, state) < 0))
                return "";
            const State after = jump(concatenated(state, parameters_));
            const auto next = mode_after(transition, conditions(concatenated(after, parameters_)));
            if (!next || !changes(value(transition.mode, state), value(*next, after)))
                return "";
            return fmt::format("'{}' is not conserved: the transition '{}' changes it from {:.6g} to {:.6g} (at {})",
                               name_, transition.label, value(transition.mode, state), value(*next, after), at(state));
        });
    }
    /// Moves a state onto a surface by Newton's method.
    bool put_on(const Function& with_gradient, State& state) const {
        constexpr int iterations = 40;
        constexpr double on_surface = 1e-13;
        for (int i = 0; i < iterations; ++i) {
            const std::vector<double> all = with_gradient(concatenated(state, parameters_));
            double square = 0, size = 0;
            for (std::size_t k = 0; k < state.size(); ++k) {
                square += all[1 + k] * all[1 + k];
                size += std::abs(all[1 + k] * state[k]);
            }
            if (!std::isfinite(all[0]) || !std::isfinite(square) || square == 0)
                return false;
            if (std::abs(all[0]) <= on_surface * size)
                return true;
            for (std::size_t k = 0; k < state.size(); ++k)
                state[k] -= all[0] * all[1 + k] / square;
        }
        return false;
    }
    double rate_on(const Function& with_gradient, const Function& rates, const State& state) const {
        const std::vector<double> inputs = concatenated(state, parameters_), all = with_gradient(inputs),
                                  field = rates(inputs);
        double rate = 0;
        for (std::size_t k = 0; k < state.size(); ++k)
            rate += all[1 + k] * field[k];
        return rate;
    }
    /// Returns the mode that follows a transition; empty at its end, or where no condition holds.
    /// @param values of the conditions of all alternatives
    static std::optional<std::size_t> mode_after(const Transition& transition, const std::vector<double>& values) {
        auto value = values.begin();
        for (const Alternative& alternative : transition.next) {
            const auto first = value;
            value += static_cast<std::ptrdiff_t>(alternative.when.size());
            if (std::all_of(first, value, [](double one) { return one >= 0; }))
                return alternative.mode;
        }
        return std::nullopt;
    }

    Model model_;
    std::string name_;
    SymbolIndex inputs_;
    std::vector<double> parameters_;
    State initial_;
    std::vector<Expression> values_; ///< in each mode
    std::vector<std::vector<Expression>> rates_;
    std::vector<Function> compiled_;
    std::shared_ptr<const std::vector<Expression>> identity_; ///< images of jumps that change nothing
};

/// The gradients of everything on which a motion depends, at a number of states: all rows, one after another. A
/// translation of states along which all of them vanish does not change the motion.
std::vector<double> deciding_gradients(Model model) {
    const std::vector<Expression> states = model.state_symbols();
    std::vector<Expression> all = deciding_expressions(model);
    std::shared_ptr<const std::vector<Expression>> identity;
    for (const Jump& jump : model.jumps)
        for (const StateMap::Change& change : changes_of(jump.map, states, identity))
            all.push_back(model.expand(change.image - states[change.state]));
    const Function gradients = model.function_of(jacobian(all, states));
    const std::vector<double> initial = model.initial_state(), parameters = model.parameter_values();
    std::vector<double> result;
    double turn = 0;
    for (const double distance : {0.1, 0.3, 1.0, 0.2, 0.7, 2.0}) {
        const std::vector<double> here = gradients(concatenated(state_around(initial, distance, turn), parameters));
        result.insert(result.end(), here.begin(), here.end());
    }
    return result;
}

/// Collects the names on which a model's motion depends.
class Dependencies {
public:
    explicit Dependencies(const Model& model) : model_(model) {
        for (const Expression& symbol : symbols_of(deciding_expressions(model_)))
            names_.insert(symbol.name());
        const std::vector<Expression> states = model_.state_symbols();
        std::shared_ptr<const std::vector<Expression>> identity;
        for (const Jump& jump : model_.jumps)
            for (const StateMap::Change& change : changes_of(jump.map, states, identity))
                add_jump(change);
    }
    bool contain(const std::string& name) const { return names_.count(name) > 0; }

private:
    /// A jump may shift a state: x + c, where c does not contain x.
    void add_jump(const StateMap::Change& change) {
        const Expression image = model_.expand(change.image), own = model_.state_symbols()[change.state];
        const bool shifts = differentiate(image, own).is_number(1);
        for (const Expression& symbol : symbols_of({&image, 1}))
            if (!(shifts && symbol == own))
                names_.insert(symbol.name());
        if (!shifts) // the state is set, or scaled: shifted motions are not the same
            names_.insert(own.name());
    }

    Model model_;
    std::set<std::string> names_;
};

} // namespace

const Expression* conserved_in(const ConservedQuantity& conserved, std::string_view mode) {
    const auto own = std::ranges::find(conserved.modes, mode, &ConservedQuantity::InMode::mode);
    if (own != conserved.modes.end())
        return &own->value;
    return conserved.value.empty() ? nullptr : &conserved.value;
}

std::string why_not_conserved(const Model& model, std::size_t conserved) {
    return ConservedCheck(model, model.conserved.at(conserved)).why();
}

std::string why_no_first_integral(const Model& model, std::size_t conserved) {
    return ConservedCheck(model, model.conserved.at(conserved)).why_none();
}

std::string why_not_conserved_along(const Model& model, std::size_t conserved, std::span<const StateInMode> motion) {
    const ConservedCheck check(model, model.conserved.at(conserved));
    std::string why = check.why_along(motion);
    return why.empty() ? check.why_constant() : why;
}

Model with_parameters(Model model, std::span<const double> parameters) {
    const std::vector<std::string> names = model.independent_parameters();
    for (std::size_t i = 0; i < std::min(names.size(), parameters.size()); ++i)
        model.set_parameter(names[i], parameters[i]);
    return model;
}

bool conserves_something(const Model& model, std::span<const double> parameters) {
    if (model.conserved.empty())
        return false;
    const Model there = with_parameters(model, parameters);
    for (std::size_t i = 0; i < there.conserved.size(); ++i)
        if (why_not_conserved(there, i).empty())
            return true;
    return false;
}

std::vector<std::size_t> ignorable_states(const Model& model) {
    const Dependencies dependencies(model);
    std::vector<std::size_t> result;
    for (std::size_t i = 0; i < model.states.size(); ++i)
        if (!dependencies.contain(model.states[i].name))
            result.push_back(i);
    return result;
}

void let_ignorable_states_drift(Model& model) {
    if (model.conserved.empty())
        return;
    for (const std::size_t i : ignorable_states(model))
        if (!model.states[i].period)
            model.states[i].drifting = true;
    constexpr std::size_t most_states = 60; // beyond, sets of states are not looked for
    if (model.states.size() > most_states)
        return;
    for (const std::vector<std::size_t>& set : sets_moved_together(deciding_gradients(model), model.states.size())) {
        if (std::ranges::any_of(set, [&](std::size_t i) { return model.states[i].period.has_value(); }))
            continue;
        model.states[set.front()].drifting = true;
        for (std::size_t k = 1; k < set.size(); ++k) {
            model.states[set[k]].drifting = false;
            model.states[set[k]].drifts_with = set.front();
        }
    }
}

} // namespace graze
