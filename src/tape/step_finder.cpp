#include "tape/step_finder.hpp"

#include "tape/tape_analysis.hpp"

#include <algorithm>

namespace graze {

Layout::Layout(const Tape& tape, int highest, int width)
    : order(static_cast<std::uint32_t>(highest)), number(static_cast<std::size_t>(width)) {
    series = (order + 1) * number;
    registers = (tape.constants * number + 7) / 8 * 8;
    reciprocals = registers + tape.registers * series;
    const auto keeps_reciprocal = [](const Instruction& instruction) {
        return instruction.operation == SeriesOperation::divide || instruction.operation == SeriesOperation::sqrt ||
               instruction.operation == SeriesOperation::power_constant;
    };
    constant_outputs =
        reciprocals + static_cast<std::size_t>(std::ranges::count_if(tape.code, keeps_reciprocal)) * number;
    const auto is_constant = [](const Tape::Location& location) { return location.constant; };
    size = constant_outputs + static_cast<std::size_t>(std::ranges::count_if(tape.outputs, is_constant)) * series;
}

StepFinder::StepFinder(const Tape& tape, const KernelTable& table, const Layout& layout, double* memory,
                       const std::vector<TermOperands>& terms)
    : tape_(tape), table_(table), layout_(layout), memory_(memory), terms_(terms) {
    find_private_rates();
}

std::vector<KernelStep> StepFinder::steps(int order) const {
    std::vector<KernelStep> steps;
    if (order > 0)
        add_states(order, steps);
    add_instructions(order, steps);
    return steps;
}

void StepFinder::find_private_rates() {
    std::vector<std::uint32_t> uses(tape_.registers, 0);
    const auto use = [&](std::uint32_t reg) { ++uses[reg]; };
    for (const auto* locations : {&tape_.rates, &tape_.outputs})
        for (const Tape::Location& location : *locations)
            if (!location.constant)
                use(location.index);
    for (const Instruction& instruction : tape_.code)
        visit_operands(tape_, instruction, use);
    std::vector<bool> is_rate(tape_.registers, false);
    for (const Tape::Location& rate : tape_.rates)
        if (!rate.constant)
            is_rate[rate.index] = true;
    combination_of_.assign(tape_.registers, none);
    for (std::uint32_t i = 0; i < tape_.code.size(); ++i) {
        const std::uint32_t result = tape_.code[i].result;
        if (tape_.code[i].operation == SeriesOperation::linear_combination && is_rate[result] && uses[result] == 1)
            combination_of_[result] = i;
    }
}

void StepFinder::add_states(int order, std::vector<KernelStep>& steps) const {
    for (std::uint32_t i = 0; i < tape_.states; ++i) {
        const Tape::Location& rate = tape_.rates[i];
        if (rate.constant || static_cast<std::uint32_t>(order) > tape_.degrees[i])
            continue;
        const std::uint32_t combination = combination_of_[rate.index];
        if (combination == none) {
            steps.push_back({table_.state, {register_at(i), register_at(rate.index), {}, {}, {}, {}}});
            continue;
        }
        KernelOperands operands = combination_operands(tape_.code[combination]);
        operands.result = register_at(i);
        const Kernel kernel = order == 1 ? table_.state_combination_value
                                         : table_.state_combination[combination_row(tape_.code[combination])];
        steps.push_back({kernel, operands});
    }
}

void StepFinder::add_instructions(int order, std::vector<KernelStep>& steps) const {
    std::uint32_t reciprocals = 0;
    for (std::size_t i = 0; i < tape_.code.size(); ++i) {
        const Instruction& instruction = tape_.code[i];
        KernelStep step{nullptr, operands_of(instruction, reciprocals)};
        if (combination_of_[instruction.result] != none ||
            static_cast<std::uint32_t>(order) > tape_.degrees[instruction.result])
            continue;
        if (order == 0 && starts_pair(i)) {
            steps.push_back(
                {table_.sine_and_cosine,
                 {step.operands.result, step.operands.third, {}, register_at(tape_.code[i + 1].result), {}, {}}});
            ++i;
            continue;
        }
        step.kernel = kernel_of(instruction, order, step.operands);
        steps.push_back(step);
    }
}

bool StepFinder::starts_pair(std::size_t i) const {
    return tape_.code[i].operation == SeriesOperation::sin && i + 1 < tape_.code.size() &&
           tape_.code[i + 1].operation == SeriesOperation::cos && tape_.code[i].third == tape_.code[i + 1].third;
}

KernelOperands StepFinder::combination_operands(const Instruction& instruction) const {
    return {register_at(instruction.result),  {}, constant_at(instruction.third), {}, terms_.data() + instruction.left,
            terms_.data() + instruction.right};
}

KernelOperands StepFinder::operands_of(const Instruction& instruction, std::uint32_t& reciprocals) const {
    const auto reciprocal = [&] { return memory_ + layout_.reciprocals + reciprocals++ * layout_.number; };
    KernelOperands operands{register_at(instruction.result), register_at(instruction.left), {}, {}, {}, {}};
    switch (instruction.operation) {
    case SeriesOperation::linear_combination:
        return combination_operands(instruction);
    case SeriesOperation::divide:
        operands.right = register_at(instruction.right);
        operands.third = reciprocal();
        break;
    case SeriesOperation::sqrt:
        operands.third = reciprocal();
        break;
    case SeriesOperation::power_constant:
        operands.right = constant_at(instruction.right);
        operands.third = reciprocal();
        break;
    default:
        operands.right = register_at(instruction.right);
        operands.third = register_at(instruction.third);
    }
    return operands;
}

std::size_t StepFinder::combination_row(const Instruction& instruction) {
    const std::uint32_t count = instruction.right - instruction.left;
    return count < combination_kernels ? count : 0;
}

Kernel StepFinder::kernel_of(const Instruction& instruction, int order, KernelOperands& operands) const {
    switch (instruction.operation) {
    case SeriesOperation::linear_combination:
        return order == 0 ? table_.combination_value : table_.combination[combination_row(instruction)];
    case SeriesOperation::multiply:
        if (order > 0 && std::min(tape_.degrees[instruction.left], tape_.degrees[instruction.right]) <= 1) {
            if (tape_.degrees[instruction.left] > 1)
                operands = {operands.result, operands.right, operands.left, {}, {}, {}};
            return table_.multiply_linear;
        }
        break;
    default:
        if (const Recurrence recurrence = recurrence_of(instruction.operation);
            order > 0 && is_product(recurrence) && tape_.degrees[instruction.third] <= 1)
            return recurrence == Recurrence::product ? table_.function_of_linear : table_.minus_function_of_linear;
        break;
    }
    const auto row = static_cast<int>(instruction.operation);
    const bool last = static_cast<std::uint32_t>(order) == std::min(layout_.order, tape_.degrees[instruction.result]);
    return last && table_.closing[row][order] ? table_.closing[row][order] : table_.series[row][order];
}

} // namespace graze
