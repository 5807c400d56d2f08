#include "tape/constant_pool.hpp"

#include "symbolic/evaluate.hpp"

#include <bit>

namespace graze {

namespace {

/// Calls `visit` for each reference to a constant in a tape.
template <class Visit>
void visit_constants(Tape& tape, Visit&& visit) {
    const auto visit_code = [&](std::vector<Instruction>& code) {
        for (Instruction& instruction : code) {
            if (instruction.operation == SeriesOperation::linear_combination)
                visit(instruction.third);
            else if (instruction.operation == SeriesOperation::power_constant)
                visit(instruction.right);
        }
    };
    visit_code(tape.code);
    for (std::vector<Instruction>& code : tape.deferred_code)
        visit_code(code);
    for (Term& term : tape.terms)
        visit(term.coefficient);
    for (auto* locations : {&tape.rates, &tape.outputs, &tape.deferred})
        for (Tape::Location& location : *locations)
            if (location.constant)
                visit(location.index);
}

} // namespace

ConstantPool::ConstantPool(std::uint32_t parameters) : parameters_(parameters), entries_(parameters) {}

std::uint32_t ConstantPool::literal(double value) {
    const auto [found, added] =
        literals_.try_emplace(std::bit_cast<std::uint64_t>(value), static_cast<std::uint32_t>(entries_.size()));
    if (added)
        entries_.push_back({true, value, {}});
    return found->second;
}

std::optional<double> ConstantPool::value_of(std::uint32_t constant) const {
    const Entry& entry = entries_[constant];
    return entry.is_literal ? std::optional(entry.value) : std::nullopt;
}

std::uint32_t ConstantPool::apply(Operation operation, std::uint32_t left, std::uint32_t right) {
    const bool binary = arity(operation) == 2;
    if (value_of(left) && (!binary || value_of(right)))
        return literal(evaluate_operation(operation, entries_[left].value, binary ? entries_[right].value : 0));
    if (operation == Operation::multiply && is(left, 1))
        return right;
    if ((operation == Operation::multiply || operation == Operation::divide) && is(right, 1))
        return left;
    if (operation == Operation::add && is(left, 0))
        return right;
    if ((operation == Operation::add || operation == Operation::subtract) && is(right, 0))
        return left;
    const auto [found, added] =
        results_.try_emplace({operation, left, binary ? right : 0}, static_cast<std::uint32_t>(entries_.size()));
    if (added)
        entries_.push_back({false, 0, {operation, found->second, left, binary ? right : left}});
    return found->second;
}

void ConstantPool::move_to(Tape& tape) const {
    std::vector<bool> used(entries_.size(), false);
    visit_constants(tape, [&](std::uint32_t constant) { used[constant] = true; });
    for (std::size_t i = entries_.size(); i-- > parameters_;)
        if (used[i] && !entries_[i].is_literal)
            used[entries_[i].code.left] = used[entries_[i].code.right] = true;

    std::vector<std::uint32_t> number(entries_.size());
    tape.constants = 0;
    for (std::uint32_t i = 0; i < entries_.size(); ++i) {
        if (i >= parameters_ && !used[i])
            continue;
        number[i] = tape.constants++;
        if (i < parameters_)
            continue;
        const Entry& entry = entries_[i];
        if (entry.is_literal)
            tape.literals.emplace_back(number[i], entry.value);
        else
            tape.constant_code.push_back(
                {entry.code.operation, number[i], number[entry.code.left], number[entry.code.right]});
    }
    visit_constants(tape, [&](std::uint32_t& constant) { constant = number[constant]; });
}

} // namespace graze
