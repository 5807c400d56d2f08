#include "graze/symbolic/function.hpp"

#include "base/special_numbers.hpp"
#include "graze/base/input_error.hpp"
#include "graze/base/require.hpp"
#include "graze/symbolic/piece_table.hpp"
#include "symbolic/evaluate.hpp"
#include "symbolic/interval_operation.hpp"
#include "symbolic/subgraph.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

namespace graze {

namespace {

/// Bounds the distance of the computed value of one operation from the true one, to first order: the propagated errors
/// of the operands plus its own rounding. At the end of an operation's domain, where the slope is unbounded, the square
/// root of the error is used. Functions of one operand ignore the second.
/// @param value the computed value
double operation_error(Operation operation, double value, double left, double left_error, double right,
                       double right_error) {
    const double rounding = epsilon * std::abs(value);
    const auto steep = [&](double slope) {
        return left_error > 0 ? std::min(std::abs(slope) * left_error, 2 * std::sqrt(left_error)) : 0;
    };
    switch (operation) {
    case Operation::number:
    case Operation::symbol:
        return 0;
    case Operation::add:
    case Operation::subtract:
        return left_error + right_error + rounding;
    case Operation::multiply:
        return std::abs(right) * left_error + std::abs(left) * right_error + rounding;
    case Operation::divide:
        return (left_error + std::abs(value) * right_error) / std::abs(right) + rounding;
    case Operation::power: {
        const double by_base = left_error > 0 ? std::abs(right * std::pow(left, right - 1)) * left_error : 0;
        const double by_exponent = right_error > 0 && left > 0 ? std::abs(value * std::log(left)) * right_error : 0;
        return (std::isfinite(by_base) ? by_base : std::pow(left_error, std::abs(right))) + by_exponent + rounding;
    }
    case Operation::negate:
        return left_error;
    case Operation::sqrt:
        return steep(0.5 / value) + rounding;
    case Operation::exp:
        return std::abs(value) * left_error + rounding;
    case Operation::log:
        return left_error / std::abs(left) + rounding;
    case Operation::sin:
    case Operation::cos:
        return std::sqrt(std::max(0.0, 1 - value * value)) * left_error + left_error * left_error + rounding;
    case Operation::tan:
        return (1 + value * value) * left_error + rounding;
    case Operation::asin:
    case Operation::acos:
        return steep(1 / std::sqrt(std::max(0.0, (1 - left) * (1 + left)))) + rounding;
    case Operation::atan:
        return left_error / (1 + left * left) + rounding;
    case Operation::sinh:
        return std::sqrt(1 + value * value) * left_error + rounding;
    case Operation::cosh:
        return std::sqrt(std::max(0.0, value * value - 1)) * left_error + left_error * left_error + rounding;
    case Operation::tanh:
        return std::max(0.0, 1 - value * value) * left_error + left_error * left_error + rounding;
    default: // the square covers places where the slope is zero
        return std::abs(function_slope(operation, left, value)) * left_error + left_error * left_error + rounding;
    }
}

} // namespace

Function::Function(std::span<const Expression> inputs, std::span<const Expression> outputs)
    : Function(SymbolIndex(inputs), outputs) {}

Function::Function(const SymbolIndex& inputs, std::span<const Expression> outputs) : output_count_(outputs.size()) {
    compile(inputs, outputs);
}

Function::Function(const SymbolIndex& inputs, std::size_t outputs, std::span<const Output> given, Others others)
    : output_count_(outputs), others_(others) {
    if (others == Others::inputs && outputs > inputs.size())
        throw InputError("a function has fewer inputs than outputs that are inputs handed through", "");
    std::vector<Expression> values;
    for (const Output& output : given) {
        if (output.place >= outputs || (!places_.empty() && output.place <= places_.back()))
            throw InputError("the places of a function's outputs do not rise, or there is no such place", "");
        places_.push_back(static_cast<std::uint32_t>(output.place));
        values.push_back(output.value);
    }
    compile(inputs, values);
    if (places_.size() == outputs)
        places_.clear();
}

/// Slots are numbered: first the inputs that are used, then one for each number and operation.
void Function::compile(const SymbolIndex& inputs, std::span<const Expression> outputs) {
    const Subgraph part = subgraph_of(outputs);
    if (part.graph && !inputs.are_of(part.graph))
        throw InputError("an input belongs to another graph than the outputs", "");
    inputs_ = inputs.size();
    for (const Subgraph::Item& item : part.items) {
        const Node& node = part.node(item);
        if (node.operation != Operation::symbol)
            continue;
        const std::optional<std::size_t> input = inputs.find(item.index);
        if (!input)
            throw InputError("'" + part.graph->symbol_name(node) + "' is not an input", "");
        used_.push_back(static_cast<std::uint32_t>(*input));
    }
    std::ranges::sort(used_);
    slots_ = used_.size();
    std::vector<std::uint32_t> slots(part.items.size());
    for (std::size_t position = 0; position < slots.size(); ++position) {
        const Subgraph::Item& item = part.items[position];
        const Node& node = part.node(item);
        if (node.operation == Operation::symbol) {
            const auto input = static_cast<std::uint32_t>(*inputs.find(item.index));
            slots[position] = static_cast<std::uint32_t>(std::ranges::lower_bound(used_, input) - used_.begin());
            continue;
        }
        slots[position] = static_cast<std::uint32_t>(slots_++);
        if (node.operation == Operation::number)
            numbers_.emplace_back(slots[position], node.value);
        else if (node.operation == Operation::lookup)
            steps_.push_back({node.operation, slots[position], slots[item.left], look_up(*part.graph, node)});
        else
            steps_.push_back({node.operation, slots[position], slots[item.left],
                              arity(node.operation) == 2 ? slots[item.right] : slots[item.left]});
    }
    for (const std::uint32_t root : part.roots)
        outputs_.push_back(slots[root]);
    uses_all_ = used_.size() == inputs_;
    if (uses_all_)
        used_ = {};
}

/// Keeps the table that a node looks up. @return what a step stores
std::uint32_t Function::look_up(const Graph& graph, const Node& node) {
    const auto [table, derivative] = Graph::lookup_of(node);
    auto found = std::ranges::find(tables_, graph.tables()[table]);
    if (found == tables_.end())
        found = tables_.insert(found, graph.tables()[table]);
    return static_cast<std::uint32_t>(4 * (found - tables_.begin()) + derivative);
}

double Function::error_of(const Step& step, double value, double left, double left_error, double right,
                          double right_error) const {
    if (step.operation != Operation::lookup)
        return operation_error(step.operation, value, left, left_error, right, right_error);
    const int derivative = derivative_of(step);
    const PieceTable::Piece piece = table_of(step).piece_at(left);
    double error = 0, power = 1;
    for (int k = 1; k + derivative <= table_of(step).degree(); ++k)
        error += std::abs(piece.at(left, derivative + k)) * (power *= left_error);
    return error + epsilon * (std::abs(value) + std::abs(piece.coefficients[0]) +
                              std::abs(piece.at(left, derivative + 1) * (std::abs(left) + std::abs(piece.knot))));
}

template <class Number>
void Function::take_inputs(std::span<const Number> inputs, std::span<Number> slots) const {
    if (uses_all_)
        std::copy_n(inputs.begin(), inputs_, slots.begin());
    else
        for (std::size_t slot = 0; slot < used_.size(); ++slot)
            slots[slot] = inputs[used_[slot]];
}

template <class Number>
void Function::give_outputs(std::span<const Number> slots, std::span<const Number> inputs,
                            std::span<Number> results) const {
    if (outputs_.size() == output_count_) {
        for (std::size_t output = 0; output < outputs_.size(); ++output)
            results[output] = slots[outputs_[output]];
        return;
    }
    if (others_ == Others::zero)
        std::fill_n(results.begin(), output_count_, Number{});
    else if (results.data() != inputs.data())
        std::copy_n(inputs.begin(), output_count_, results.begin());
    for (std::size_t output = 0; output < outputs_.size(); ++output)
        results[places_[output]] = slots[outputs_[output]];
}

void Function::evaluate(std::span<const double> inputs, std::span<double> results, std::span<double> work) const {
    require_room(inputs.size(), inputs_, "inputs of a function");
    require_room(results.size(), output_count_, "results of a function");
    require_room(work.size(), slots_, "numbers for a function to work in");
    take_inputs<double>(inputs, work);
    for (const auto& [slot, value] : numbers_)
        work[slot] = value;
    for (const Step& step : steps_)
        work[step.result] = step.operation == Operation::lookup
                                ? table_of(step).value(work[step.left], derivative_of(step))
                                : evaluate_operation(step.operation, work[step.left], work[step.right]);
    give_outputs<double>(work, inputs, results);
}

void Function::error_bounds(std::span<const double> inputs, std::span<const double> errors, std::span<double> bounds,
                            std::span<double> work) const {
    require_room(inputs.size(), inputs_, "inputs of a function");
    require_room(errors.size(), inputs_, "errors of inputs");
    require_room(bounds.size(), output_count_, "error bounds of a function");
    require_room(work.size(), 2 * slots_, "numbers for a function to work in");
    const std::span<double> values = work.first(slots_), uncertain = work.subspan(slots_, slots_);
    take_inputs<double>(inputs, values);
    take_inputs<double>(errors, uncertain);
    for (const auto& [slot, value] : numbers_) {
        values[slot] = value;
        uncertain[slot] = 0;
    }
    for (const Step& step : steps_) {
        const bool table = step.operation == Operation::lookup;
        const std::uint32_t second = table ? step.left : step.right;
        const double left = values[step.left], right = values[second];
        values[step.result] =
            table ? table_of(step).value(left, derivative_of(step)) : evaluate_operation(step.operation, left, right);
        uncertain[step.result] =
            error_of(step, values[step.result], left, uncertain[step.left], right, uncertain[second]);
    }
    give_outputs<double>(uncertain, errors, bounds);
}

void Function::enclose(std::span<const Interval> inputs, std::span<Interval> results, std::span<Interval> work) const {
    require_room(inputs.size(), inputs_, "inputs of a function");
    require_room(results.size(), output_count_, "results of a function");
    require_room(work.size(), slots_, "intervals for a function to work in");
    take_inputs<Interval>(inputs, work);
    for (const auto& [slot, value] : numbers_)
        work[slot] = Interval::point(value);
    for (const Step& step : steps_)
        work[step.result] =
            step.operation == Operation::lookup
                ? table_of(step).enclose(work[step.left], derivative_of(step))
                : enclose_operation(step.operation, work[step.left], work[step.right], step.left == step.right);
    give_outputs<Interval>(work, inputs, results);
}

bool Function::narrow(std::span<Interval> inputs, std::span<const Interval> wanted, std::span<Interval> work) const {
    require_room(inputs.size(), inputs_, "inputs of a function");
    require_room(output_count_, wanted.size(), "outputs of a function");
    require_room(work.size(), slots_, "intervals for a function to work in");
    // Only operations on which the wanted outputs depend are inverted: others may be undefined.
    std::vector<bool> matters(slots_);
    for (std::size_t output = 0; output < outputs_.size(); ++output) {
        const std::size_t place = places_.empty() ? output : places_[output];
        if (place >= wanted.size())
            break;
        Interval& value = work[outputs_[output]];
        value = intersection(value, wanted[place]);
        matters[outputs_[output]] = true;
        if (value.empty())
            return false;
    }
    for (std::size_t step = steps_.size(); step-- > 0;) {
        const auto& [operation, result, left, second] = steps_[step];
        if (!matters[result])
            continue;
        const std::uint32_t right = operation == Operation::lookup ? left : second;
        narrow_operands(operation, work[result], work[left], work[right], left == right);
        matters[left] = matters[right] = true;
        if (work[left].empty() || work[right].empty())
            return false;
    }
    for (std::size_t slot = 0; slot < (uses_all_ ? inputs_ : used_.size()); ++slot) {
        Interval& input = inputs[uses_all_ ? slot : used_[slot]];
        input.lower = work[slot].lower;
        input.upper = work[slot].upper;
    }
    return true;
}

std::vector<double> Function::operator()(std::span<const double> inputs) const {
    require_size(inputs.size(), inputs_, "inputs of a function");
    std::vector<double> results(output_count_);
    std::vector<double> work(slots_);
    evaluate(inputs, results, work);
    return results;
}

double constant_value(const Expression& expression) {
    const Subgraph part = subgraph_of(std::span(&expression, 1));
    for (const Subgraph::Item& item : part.items)
        if (part.node(item).operation == Operation::symbol)
            throw InputError("'" + part.graph->symbol_name(part.node(item)) + "' has no value", "");
    // Constant folding has turned every expression without symbols that has a value into a number.
    return expression.is_number() ? expression.node().value : std::numeric_limits<double>::quiet_NaN();
}

} // namespace graze
