#include "graze/symbolic/function.hpp"

#include "graze/symbolic/require.hpp"
#include "symbolic/evaluate.hpp"
#include "symbolic/operation_error.hpp"
#include "symbolic/subgraph.hpp"

#include <algorithm>
#include <limits>
#include <stdexcept>
#include <unordered_map>

namespace graze {

Function::Function(std::span<const Expression> inputs, std::span<const Expression> outputs) : inputs_(inputs.size()) {
    const Subgraph part = subgraph_of(outputs);
    // Slots: the inputs, then one for each number and operation.
    std::unordered_map<NodeIndex, std::uint32_t> input_slots;
    for (std::size_t input = 0; input < inputs.size(); ++input) {
        if (inputs[input].empty() || !inputs[input].is_symbol())
            throw std::invalid_argument("the inputs of a function must be symbols");
        if (part.graph && inputs[input].graph() != part.graph)
            throw std::invalid_argument("an input belongs to another graph than the outputs");
        if (!input_slots.emplace(inputs[input].index(), static_cast<std::uint32_t>(input)).second)
            throw std::invalid_argument("'" + inputs[input].name() + "' is an input twice");
    }
    slots_ = inputs_;
    std::vector<std::uint32_t> slots(part.items.size());
    for (std::size_t position = 0; position < slots.size(); ++position) {
        const Subgraph::Item& item = part.items[position];
        const Node& node = part.node(item);
        if (node.operation == Operation::symbol) {
            const auto found = input_slots.find(item.index);
            if (found == input_slots.end())
                throw std::invalid_argument("'" + part.graph->symbol_name(node) + "' is not an input");
            slots[position] = found->second;
            continue;
        }
        slots[position] = static_cast<std::uint32_t>(slots_++);
        if (node.operation == Operation::number)
            numbers_.emplace_back(slots[position], node.value);
        else
            steps_.push_back({node.operation, slots[position], slots[item.left],
                              arity(node.operation) == 2 ? slots[item.right] : slots[item.left]});
    }
    for (const std::uint32_t root : part.roots)
        outputs_.push_back(slots[root]);
}

void Function::evaluate(std::span<const double> inputs, std::span<double> results, std::span<double> work) const {
    require_room(inputs.size(), inputs_, "inputs of a function");
    require_room(results.size(), outputs_.size(), "results of a function");
    require_room(work.size(), slots_, "numbers for a function to work in");
    std::copy_n(inputs.begin(), inputs_, work.begin());
    for (const auto& [slot, value] : numbers_)
        work[slot] = value;
    for (const Step& step : steps_)
        work[step.result] = evaluate_operation(step.operation, work[step.left], work[step.right]);
    for (std::size_t output = 0; output < outputs_.size(); ++output)
        results[output] = work[outputs_[output]];
}

void Function::error_bounds(std::span<const double> inputs, std::span<const double> errors, std::span<double> bounds,
                            std::span<double> work) const {
    require_room(inputs.size(), inputs_, "inputs of a function");
    require_room(errors.size(), inputs_, "errors of inputs");
    require_room(bounds.size(), outputs_.size(), "error bounds of a function");
    require_room(work.size(), 2 * slots_, "numbers for a function to work in");
    const std::span<double> values = work.first(slots_), uncertain = work.subspan(slots_, slots_);
    std::copy_n(inputs.begin(), inputs_, values.begin());
    std::copy_n(errors.begin(), inputs_, uncertain.begin());
    for (const auto& [slot, value] : numbers_) {
        values[slot] = value;
        uncertain[slot] = 0;
    }
    for (const Step& step : steps_) {
        const double left = values[step.left], right = values[step.right];
        values[step.result] = evaluate_operation(step.operation, left, right);
        uncertain[step.result] = operation_error(step.operation, values[step.result], left, uncertain[step.left], right,
                                                 uncertain[step.right]);
    }
    for (std::size_t output = 0; output < outputs_.size(); ++output)
        bounds[output] = uncertain[outputs_[output]];
}

std::vector<double> Function::operator()(std::span<const double> inputs) const {
    require_size(inputs.size(), inputs_, "inputs of a function");
    std::vector<double> results(outputs_.size());
    std::vector<double> work(slots_);
    evaluate(inputs, results, work);
    return results;
}

double constant_value(const Expression& expression) {
    const Subgraph part = subgraph_of(std::span(&expression, 1));
    for (const Subgraph::Item& item : part.items)
        if (part.node(item).operation == Operation::symbol)
            throw std::invalid_argument("'" + part.graph->symbol_name(part.node(item)) + "' has no value");
    // Without symbols, whatever has a value has been folded to a number.
    return expression.is_number() ? expression.node().value : std::numeric_limits<double>::quiet_NaN();
}

} // namespace graze
