#include "flow/uniformised_system.hpp"

#include "graze/symbolic/transform.hpp"
#include "model/unused_symbol.hpp"
#include "symbolic/subgraph.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>

namespace graze {

namespace {

/// Roots of a higher degree would need long series, and are not uniformised.
constexpr int highest_degree_of_root = 12;

/// The exponents with which one radicand occurs.
struct Powers {
    Expression radicand{};
    std::vector<Expression> exponents;
};

/// The parts of expressions, with the exponents of those that are roots, or powers that may be fractional.
class PowerParts {
public:
    PowerParts(std::span<const Expression> expressions, const SymbolIndex& states)
        : part_(subgraph_of(expressions)), exponents_(part_.items.size()) {
        std::vector<bool> moves(part_.items.size()); // depends on states
        for (std::size_t i = 0; i < moves.size(); ++i) {
            const Subgraph::Item& item = part_.items[i];
            const Operation operation = part_.node(item).operation;
            const int operands = arity(operation);
            moves[i] = operands == 0 ? states.find(item.index).has_value()
                                     : moves[item.left] || (operands == 2 && moves[item.right]);
            if (operands == 0 || !moves[item.left])
                continue;
            if (operation == Operation::sqrt) {
                exponents_[i] = part_.graph->number(0.5);
            } else if (operation == Operation::power && !moves[item.right]) {
                const Expression exponent = part_.expression(part_.items[item.right]);
                const Node& node = exponent.node();
                if (node.operation != Operation::number || node.value != std::trunc(node.value))
                    exponents_[i] = exponent;
            }
        }
    }

    std::vector<Powers> powers() const {
        std::vector<Powers> found;
        for (std::size_t i = 0; i < exponents_.size(); ++i) {
            if (exponents_[i].empty())
                continue;
            const Expression radicand = part_.expression(part_.items[part_.items[i].left]);
            const auto known = std::ranges::find(found, radicand, &Powers::radicand);
            (known == found.end() ? found.emplace_back(Powers{radicand, {}}) : *known)
                .exponents.push_back(exponents_[i]);
        }
        return found;
    }
    /// Returns the expressions with other roots and powers of a radicand. @param replace makes one from its exponent
    std::vector<Expression> replaced(const Expression& radicand,
                                     const std::function<Expression(const Expression&)>& replace) const {
        std::vector<Expression> results(part_.items.size());
        for (std::size_t i = 0; i < results.size(); ++i) {
            const Subgraph::Item& item = part_.items[i];
            const Operation operation = part_.node(item).operation;
            const int operands = arity(operation);
            if (operands == 0)
                results[i] = part_.expression(item);
            else if (!exponents_[i].empty() && part_.items[item.left].index == radicand.index())
                results[i] = replace(exponents_[i]);
            else if (operands == 1)
                results[i] = part_.graph->apply_as(*part_.graph, part_.node(item), results[item.left]);
            else
                results[i] = part_.graph->apply(operation, results[item.left], results[item.right]);
        }
        std::vector<Expression> replaced;
        for (const std::uint32_t root : part_.roots)
            replaced.push_back(results[root]);
        return replaced;
    }

private:
    Subgraph part_;
    std::vector<Expression> exponents_; ///< of each part; empty: none
};

bool is_negative(const Expression& exponent) {
    return exponent.node().operation == Operation::number && exponent.node().value < 0;
}

/// Returns the least q of which all exponents are multiples of 1/q; 0 if there is none.
int degree_of(const Powers& powers) {
    const auto is_multiple = [](const Expression& exponent, int q) {
        const double multiple = exponent.node().value * q;
        return exponent.node().operation == Operation::number &&
               std::abs(multiple - std::round(multiple)) <= 1e-12 * multiple;
    };
    for (int q = 2; q <= highest_degree_of_root; ++q)
        if (std::ranges::all_of(powers.exponents, [&](const Expression& exponent) { return is_multiple(exponent, q); }))
            return q;
    return 0;
}

/// Returns an expression without its sign and a factor that is a number.
Expression without_factor(Expression expression) {
    for (;;) {
        const Node& node = expression.node();
        const auto operand = [&](NodeIndex index) { return Expression(expression.graph(), index); };
        if (node.operation == Operation::negate)
            expression = operand(node.left);
        else if (node.operation == Operation::multiply && operand(node.left).node().operation == Operation::number)
            expression = operand(node.right);
        else
            return expression;
    }
}

bool vanishes_with(const Expression& radicand, std::span<const Expression> ends) {
    const Expression bare = without_factor(radicand), opposite = without_factor(-radicand);
    return std::ranges::any_of(ends, [&](const Expression& end) {
        const Expression other = without_factor(end);
        return other == bare || other == opposite;
    });
}

/// Collects the uniformised modes of a copy of a system's model, whose graph may grow and is discarded afterwards.
class Uniformiser {
public:
    explicit Uniformiser(const System& system)
        : model_(system.model()), options_(system.options()), states_(model_.state_symbols()), state_index_(states_),
          root_(unused_symbol(model_, "root_of_radicand")), elapsed_(unused_symbol(model_, "elapsed")) {
        grown_.graph = model_.graph;
        grown_.name = model_.name;
        for (const Expression& state : states_)
            add_state(state);
        add_state(root_);
        add_state(elapsed_);
        const std::vector<double> values = model_.parameter_values();
        for (const Expression& parameter : model_.parameter_symbols())
            grown_.parameters.push_back({.name = parameter.name(), .value = values[grown_.parameters.size()]});
    }

    std::vector<UniformisedRoot> add(const System& system, std::size_t mode) {
        std::vector<UniformisedRoot> roots;
        const std::vector<Expression> rates = model_.expand(model_.modes[mode].rates);
        const std::vector<Expression> ends = ends_of_mode(model_, mode);
        const PowerParts parts(rates, state_index_);
        for (const Powers& powers : parts.powers()) {
            if (!vanishes_with(powers.radicand, ends) || std::ranges::any_of(powers.exponents, is_negative))
                continue;
            UniformisedRoot root;
            root.degree = degree_of(powers);
            root.radicand = system.with_gradient(powers.radicand);
            root.exponents = system.function_of_parameters(powers.exponents);
            root.output = radicands_.size();
            radicands_.push_back(powers.radicand);
            if (root.degree > 0)
                fields_.push_back(parts.replaced(powers.radicand, [&](const Expression& exponent) {
                    return pow(root_, std::round(exponent.node().value * root.degree));
                }));
            else
                fields_.push_back(extended_rates(rates, std::span(&powers.radicand, 1), state_index_));
            root.inside =
                root.degree > 0 ? add_inside(fields_.back(), powers.radicand, root.degree) : add_in_time(rates);
            root.outside =
                add_in_time(parts.replaced(powers.radicand, [&](const Expression&) { return model_.number(0); }));
            roots.push_back(std::move(root));
        }
        return roots;
    }

    std::optional<System> compile(std::vector<std::vector<UniformisedRoot>>& roots) {
        if (radicands_.empty())
            return std::nullopt;
        System system = System(grown_, options_).observing(radicands_);
        for (auto& of_mode : roots)
            for (UniformisedRoot& root : of_mode)
                root.field = system.function_of(fields_[root.output]);
        return system;
    }

private:
    void add_state(const Expression& symbol) {
        grown_.states.push_back({.name = symbol.name(), .initial = model_.number(0)});
    }
    std::size_t add_mode(std::vector<Expression> rates) {
        grown_.modes.push_back({.name = fmt::format("mode{}", grown_.modes.size()), .rates = std::move(rates)});
        return grown_.modes.size() - 1;
    }
    /// Adds a mode in which the independent variable is the time.
    std::size_t add_in_time(std::vector<Expression> rates) {
        rates.push_back(model_.number(0));
        rates.push_back(model_.number(1));
        return add_mode(std::move(rates));
    }
    std::size_t add_inside(const std::vector<Expression>& field, const Expression& radicand, int degree) {
        const Expression clock = degree * pow(root_, degree - 1);
        std::vector<Expression> rates;
        for (const Expression& rate : field)
            rates.push_back(clock * rate);
        Expression growth = model_.number(0);
        for (JacobianEntry& entry : sparse_jacobian({&radicand, 1}, state_index_))
            growth = growth + entry.value * field[entry.column];
        rates.push_back(growth);
        rates.push_back(clock);
        return add_mode(std::move(rates));
    }

    Model model_, grown_;
    SystemOptions options_;
    std::vector<Expression> states_;
    SymbolIndex state_index_;
    Expression root_, elapsed_;
    std::vector<Expression> radicands_;
    std::vector<std::vector<Expression>> fields_;
};

} // namespace

std::vector<Expression> ends_of_mode(Model& model, std::size_t mode) {
    const Mode& item = model.modes[mode];
    std::vector<Expression> ends = item.ends;
    for (const std::size_t event : item.watched)
        ends.push_back(model.events[event].function);
    return model.expand(ends);
}

std::vector<Expression> extended_rates(const std::vector<Expression>& rates, std::span<const Expression> ends,
                                       const SymbolIndex& states) {
    std::vector<Expression> extended = rates;
    if (rates.empty() || ends.empty())
        return extended;
    for (const Powers& powers : PowerParts(rates, states).powers()) {
        const Expression& radicand = powers.radicand;
        if (!vanishes_with(radicand, ends))
            continue;
        // max(g, 0), exactly: the root of a square is the absolute value.
        const Expression positive = (radicand + sqrt(pow(radicand, 2))) / 2;
        extended = PowerParts(extended, states).replaced(radicand, [&](const Expression& exponent) {
            return exponent.is_number(0.5) ? sqrt(positive) : pow(positive, exponent);
        });
    }
    return extended;
}

UniformisedSystem::UniformisedSystem(const System& system) {
    Uniformiser uniformiser(system);
    for (std::size_t mode = 0; mode < system.model().modes.size(); ++mode)
        roots_.push_back(uniformiser.add(system, mode));
    modes_ = uniformiser.compile(roots_);
}

} // namespace graze
