#include "graze/tape/tape.hpp"

#include "graze/base/input_error.hpp"

#include "symbolic/subgraph.hpp"
#include "tape/native_code.hpp"
#include "tape/series_builder.hpp"
#include "tape/tape_analysis.hpp"

#include <map>
#include <unordered_map>
#include <utility>

namespace graze {

namespace {

std::vector<Expression> joined(std::span<const Expression> one, std::span<const Expression> other) {
    std::vector<Expression> all(one.begin(), one.end());
    all.insert(all.end(), other.begin(), other.end());
    return all;
}

std::vector<Expression> values_of(std::span<const DeferredExpression> deferred) {
    std::vector<Expression> values;
    for (const DeferredExpression& one : deferred)
        values.push_back(one.value);
    return values;
}

using Symbols = std::unordered_map<NodeIndex, LinearForm>;

/// Returns the registers of the states and the constants of the parameters.
Symbols symbols(SeriesBuilder& builder, std::span<const Expression> states, std::span<const Expression> parameters) {
    Symbols forms;
    std::uint32_t index = 0;
    for (const Expression& state : states)
        forms.emplace(state.index(), builder.series(index++));
    index = 0;
    for (const Expression& parameter : parameters)
        forms.emplace(parameter.index(), builder.constant(index++));
    return forms;
}

/// The tables that are looked up, each at one or more arguments. Within a piece the value is a polynomial, whose
/// coefficients are constants of the tape.
class Pieces {
public:
    void add(const Subgraph& subgraph) {
        for (const Subgraph::Item& item : subgraph.items) {
            const Node& node = subgraph.node(item);
            if (node.operation != Operation::lookup)
                continue;
            const std::size_t table = Graph::lookup_of(node).table;
            if (!places_.try_emplace({table, node.left}, pieces_.size()).second)
                continue;
            pieces_.push_back({subgraph.graph->tables()[table], numbers_});
            arguments_.push_back(subgraph.expression(subgraph.items[item.left]));
            numbers_ += static_cast<std::uint32_t>(pieces_.back().table->degree()) + 2;
        }
    }
    /// Returns how many constants they have.
    std::uint32_t numbers() const { return numbers_; }

    /// Returns the form of a lookup by Horner's rule.
    LinearForm form(SeriesBuilder& builder, const Node& node, LinearForm argument, std::uint32_t parameters) const {
        const auto [table, derivative] = Graph::lookup_of(node);
        const Tape::Piece& piece = pieces_[places_.at({table, node.left})];
        const std::uint32_t knot = parameters + piece.first;
        const LinearForm distance =
            builder.shared(builder.apply(Operation::subtract, std::move(argument), builder.constant(knot)));
        LinearForm value = builder.number(0);
        for (int k = piece.table->degree(); k >= derivative; --k) {
            double factor = 1;
            for (int i = 0; i < derivative; ++i)
                factor *= k - i;
            LinearForm coefficient =
                builder.apply(Operation::multiply, builder.constant(knot + 1 + static_cast<std::uint32_t>(k)),
                              builder.number(factor));
            value = builder.apply(Operation::add, builder.apply(Operation::multiply, std::move(value), distance),
                                  std::move(coefficient));
        }
        return value;
    }

    void move_to(Tape& tape, std::span<const Expression> inputs) {
        if (pieces_.empty())
            return;
        for (Tape::Piece& piece : pieces_)
            piece.first += tape.parameters;
        tape.pieces = std::move(pieces_);
        tape.piece_arguments = Function(inputs, arguments_);
    }

private:
    std::map<std::pair<std::size_t, NodeIndex>, std::size_t> places_; ///< by table and argument
    std::vector<Tape::Piece> pieces_;
    std::vector<Expression> arguments_;
    std::uint32_t numbers_ = 0;
};

/// Returns the forms of all expressions of a subgraph. A form that is used only once is moved, not copied.
std::vector<LinearForm> compile(SeriesBuilder& builder, const Subgraph& subgraph, const Symbols& symbols,
                                const Pieces& pieces, std::uint32_t parameters) {
    std::vector<std::uint32_t> uses(subgraph.items.size(), 0);
    for (const Subgraph::Item& item : subgraph.items) {
        const int operands = arity(subgraph.node(item).operation);
        if (operands > 0)
            ++uses[item.left];
        if (operands > 1)
            ++uses[item.right];
    }
    for (const std::uint32_t root : subgraph.roots)
        ++uses[root];

    std::vector<LinearForm> forms(subgraph.items.size());
    const auto operand = [&](std::uint32_t position) {
        return uses[position] == 1 ? std::move(forms[position]) : forms[position];
    };
    for (std::size_t i = 0; i < subgraph.items.size(); ++i) {
        const Subgraph::Item& item = subgraph.items[i];
        const Node& node = subgraph.node(item);
        if (node.operation == Operation::number) {
            forms[i] = builder.number(node.value);
        } else if (node.operation == Operation::symbol) {
            const auto found = symbols.find(item.index);
            if (found == symbols.end())
                throw InputError("'" + subgraph.graph->symbol_name(node) + "' is neither a state nor a parameter", "");
            forms[i] = found->second;
        } else if (node.operation == Operation::lookup) {
            forms[i] = pieces.form(builder, node, operand(item.left), parameters);
        } else {
            LinearForm left = operand(item.left);
            LinearForm right = arity(node.operation) == 2 ? operand(item.right) : LinearForm{};
            forms[i] = builder.apply(node.operation, std::move(left), std::move(right));
        }
        if (uses[i] > 1)
            forms[i] = builder.shared(std::move(forms[i]));
    }
    return forms;
}

void check(const Subgraph& subgraph, std::span<const Expression> symbols) {
    for (const Expression& symbol : symbols)
        if (symbol.empty() || !symbol.is_symbol() || (subgraph.graph != nullptr && symbol.graph() != subgraph.graph))
            throw InputError("states and parameters must be symbols of the graph of the expressions", "");
}

} // namespace

Tape compile_tape(std::span<const Expression> states, std::span<const Expression> parameters,
                  std::span<const Expression> rates, std::span<const Expression> outputs,
                  std::span<const DeferredExpression> deferred) {
    if (states.size() != rates.size())
        throw InputError("there must be as many rates as states", "");
    const Subgraph subgraph = subgraph_of(joined(rates, outputs)), behind = subgraph_of(values_of(deferred));
    for (const Subgraph* part : {&subgraph, &behind}) {
        check(*part, states);
        check(*part, parameters);
    }

    Tape tape;
    tape.states = static_cast<std::uint32_t>(states.size());
    tape.parameters = static_cast<std::uint32_t>(parameters.size());
    Pieces pieces;
    pieces.add(subgraph);
    pieces.add(behind);
    SeriesBuilder builder(tape.states, tape.parameters + pieces.numbers());
    const Symbols known = symbols(builder, states, parameters);
    const std::vector<LinearForm> forms = compile(builder, subgraph, known, pieces, tape.parameters);
    std::vector<bool> rate_is_zero;
    for (std::size_t i = 0; i < subgraph.roots.size(); ++i) {
        const Tape::Location location = builder.location(forms[subgraph.roots[i]]);
        if (i < rates.size()) {
            tape.rates.push_back(location);
            rate_is_zero.push_back(location.constant && builder.constants().is(location.index, 0));
        } else {
            tape.outputs.push_back(location);
        }
    }
    // Deferred expressions are compiled separately: they reuse existing registers, but do not change the code for rates
    // and outputs.
    builder.prefer_reciprocals();
    const std::vector<LinearForm> more = compile(builder, behind, known, pieces, tape.parameters);
    std::vector<std::uint32_t> groups;
    for (std::size_t i = 0; i < deferred.size(); ++i) {
        tape.deferred.push_back(builder.location(more[behind.roots[i]]));
        groups.push_back(deferred[i].group);
    }
    builder.move_to(tape);
    find_degrees(tape, rate_is_zero);
    remove_unneeded(tape);
    separate_deferred_code(tape, groups);
    builder.constants().move_to(tape);
    pieces.move_to(tape, joined(states, parameters));
    tape.native_codes = std::make_shared<NativeCodes>(tape);
    return tape;
}

} // namespace graze
