#include "tape/step_finder.hpp"

#include "tape/tape_analysis.hpp"

#include <algorithm>

namespace graze {

namespace {

std::uint32_t reciprocals_in(const std::vector<Instruction>& code) {
    return static_cast<std::uint32_t>(std::ranges::count_if(code, [](const Instruction& instruction) {
        return instruction.operation == SeriesOperation::divide || instruction.operation == SeriesOperation::sqrt ||
               instruction.operation == SeriesOperation::power_constant;
    }));
}

/// Counts how often the code reads each register.
void add_uses(const Tape& tape, const std::vector<Instruction>& code, std::vector<std::uint32_t>& uses) {
    for (const Instruction& instruction : code)
        visit_operands(tape, instruction, [&](std::uint32_t reg) { ++uses[reg]; });
}
void add_uses(std::span<const Tape::Location> locations, std::vector<std::uint32_t>& uses) {
    for (const Tape::Location& location : locations)
        if (!location.constant)
            ++uses[location.index];
}

} // namespace

JetLayout::JetLayout(const Tape& tape, int highest, int width)
    : order(static_cast<std::uint32_t>(highest)), number(static_cast<std::size_t>(width)) {
    series = (order + 1) * number;
    registers = (tape.constants * number + 7) / 8 * 8;
    reciprocals = registers + tape.registers * series;
    std::size_t kept = reciprocals_in(tape.code);
    for (const std::vector<Instruction>& code : tape.deferred_code)
        kept += reciprocals_in(code);
    constant_outputs = reciprocals + kept * number;
    const auto is_constant = [](const Tape::Location& location) { return location.constant; };
    size = constant_outputs + static_cast<std::size_t>(std::ranges::count_if(tape.outputs, is_constant)) * series;
}

StepFinder::StepFinder(const Tape& tape, const KernelTable& table, const JetLayout& layout, double* memory,
                       const std::vector<TermOperands>& terms)
    : tape_(tape), code_(tape.code), has_states_(true), table_(table), layout_(layout), memory_(memory), terms_(terms) {
    std::vector<std::uint32_t> uses(tape.registers, 0);
    add_uses(tape, code_, uses);
    add_uses(tape.rates, uses);
    find_times(uses);
    add_uses(tape.outputs, uses);
    add_uses(tape.deferred, uses);
    for (const std::vector<Instruction>& code : tape.deferred_code)
        add_uses(tape, code, uses);
    find_private_rates(uses);
}

StepFinder::StepFinder(const Tape& tape, std::size_t part, const KernelTable& table, const JetLayout& layout,
                       double* memory, const std::vector<TermOperands>& terms)
    : tape_(tape), code_(tape.deferred_code[part]), has_states_(false), reciprocals_(reciprocals_in(tape.code)),
      table_(table), layout_(layout), memory_(memory), terms_(terms), combination_of_(tape.registers, none) {
    for (std::size_t before = 0; before < part; ++before)
        reciprocals_ += reciprocals_in(tape.deferred_code[before]);
    std::vector<std::uint32_t> uses(tape.registers, 0);
    for (const std::vector<Instruction>& code : tape.deferred_code)
        add_uses(tape, code, uses);
    find_times(uses);
}

std::vector<KernelStep> StepFinder::steps(int order, bool joins_states) const {
    std::vector<KernelStep> steps;
    if (order > 0 && has_states_)
        add_states(order, joins_states, steps);
    add_instructions(order, steps);
    return steps;
}

void StepFinder::find_times(const std::vector<std::uint32_t>& uses) {
    times_.assign(code_.size(), Time::at_each_order);
    for (std::size_t i = 0; i < code_.size(); ++i) {
        const Instruction& instruction = code_[i];
        if (tape_.degrees[instruction.result] != Tape::unbounded)
            continue;
        if (whole_kernel(i)) {
            times_[i] = Time::before_all;
            if (instruction.right != instruction.result)
                times_[++i] = Time::before_all;
        } else if (instruction.operation == SeriesOperation::linear_combination && uses[instruction.result] == 0) {
            times_[i] = Time::after_all;
        }
    }
}

void StepFinder::find_private_rates(const std::vector<std::uint32_t>& uses) {
    std::vector<bool> is_rate(tape_.registers, false);
    for (const Tape::Location& rate : tape_.rates)
        if (!rate.constant)
            is_rate[rate.index] = true;
    combination_of_.assign(tape_.registers, none);
    for (std::uint32_t i = 0; i < code_.size(); ++i) {
        const std::uint32_t result = code_[i].result;
        if (code_[i].operation == SeriesOperation::linear_combination && is_rate[result] && uses[result] == 1)
            combination_of_[result] = i;
    }
}

void StepFinder::add_states(int order, bool joins_states, std::vector<KernelStep>& steps) const {
    std::vector<KernelStep> combinations; // added last, so that the other kernels are adjacent
    for (std::uint32_t i = 0; i < tape_.states; ++i) {
        const Tape::Location& rate = tape_.rates[i];
        if (rate.constant || static_cast<std::uint32_t>(order) > tape_.degrees[i])
            continue;
        const std::uint32_t combination = combination_of_[rate.index];
        if (combination == none) {
            Kernel kernel = table_.state;
            if (joins_states && table_.two_states && !steps.empty() && steps.back().kernel == table_.state) {
                steps.back().kernel = table_.two_states;
                kernel = nullptr;
            }
            steps.push_back({kernel, {register_at(i), register_at(rate.index), {}, {}, {}, {}}});
            continue;
        }
        combinations.push_back(combination_step(code_[combination], order == 1
                                                                        ? &CombinationKernels::state_combination_value
                                                                        : &CombinationKernels::state_combination));
        combinations.back().operands.result = register_at(i);
    }
    steps.insert(steps.end(), combinations.begin(), combinations.end());
}

void StepFinder::add_instructions(int order, std::vector<KernelStep>& steps) const {
    add_instructions(order, 0, code_.size(), reciprocals_, steps);
}

void StepFinder::add_instructions(int order, std::size_t first, std::size_t behind, std::uint32_t reciprocals,
                                  std::vector<KernelStep>& steps) const {
    for (std::size_t i = first; i < behind; ++i) {
        const Instruction& instruction = code_[i];
        KernelStep step{nullptr, operands_of(instruction, reciprocals)};
        if (combination_of_[instruction.result] != none ||
            static_cast<std::uint32_t>(order) > tape_.degrees[instruction.result] ||
            (order > 1 && times_[i] != Time::at_each_order))
            continue;
        if (order == 0 && starts_pair(i)) {
            steps.push_back(
                {table_.sine_and_cosine,
                 {step.operands.result, step.operands.third, {}, register_at(code_[i + 1].result), {}, {}}});
            ++i;
            continue;
        }
        const Kernel joint = order > 0 && i > first && !steps.empty() ? joint_kernel(i, order, steps.back()) : nullptr;
        if (joint) {
            steps.back().kernel = joint;
            steps.back().reads_order = false;
        } else if (instruction.operation == SeriesOperation::linear_combination)
            step = combination_step(instruction, order == 0 ? &CombinationKernels::combination_value
                                                            : &CombinationKernels::combination);
        else
            step = series_step(instruction, order, step.operands);
        steps.push_back(step);
    }
}

/// Returns one past the last instruction that must be computed together with the first, order by order: a function may
/// need a later one, as the sine needs the cosine.
/// @param behind one past the instruction that computes each register
std::size_t StepFinder::end_of_run(std::size_t first, const std::vector<std::size_t>& behind) const {
    std::size_t end = first + 1;
    for (std::size_t i = first; i < end; ++i)
        visit_operands(tape_, code_[i], [&](std::uint32_t operand) { end = std::max(end, behind[operand]); });
    return end;
}

std::vector<StepFinder::Run> StepFinder::runs() const {
    std::vector<Run> runs;
    std::vector<std::size_t> behind(tape_.registers, 0);
    for (std::size_t i = 0; i < code_.size(); ++i)
        behind[code_[i].result] = i + 1;
    std::uint32_t reciprocals = reciprocals_;
    const auto highest = static_cast<int>(layout_.order);
    for (std::size_t first = 0; first < code_.size();) {
        const Instruction& one = code_[first];
        const std::size_t end = end_of_run(first, behind);
        Run run;
        std::uint32_t unused = reciprocals;
        const bool product = (one.operation == SeriesOperation::multiply || one.operation == SeriesOperation::square) &&
                             table_.whole_product != nullptr && tape_.degrees[one.result] == Tape::unbounded;
        const bool reciprocal = one.operation == SeriesOperation::reciprocal && end == first + 1 &&
                                table_.whole_reciprocal != nullptr && tape_.degrees[one.result] == Tape::unbounded;
        const bool sum =
            one.operation == SeriesOperation::linear_combination && tape_.degrees[one.result] == Tape::unbounded;
        if (sum) {
            run = {true, {{combination_step(one, &CombinationKernels::whole_combination)}}};
        } else if (times_[first] == Time::before_all) {
            run = {true, {{whole_step(first)}}};
        } else if (product) {
            KernelOperands operands = operands_of(one, unused);
            if (one.operation == SeriesOperation::square)
                operands.right = operands.left;
            run = {true, {{{table_.whole_product, operands}}}};
        } else if (reciprocal) {
            run = {true, {{{table_.whole_reciprocal, operands_of(one, unused)}}}};
        } else {
            for (int order = 2; order <= highest; ++order)
                add_instructions(order, first, end, reciprocals, run.steps.emplace_back());
        }
        runs.push_back(std::move(run));
        for (; first < end; ++first)
            static_cast<void>(operands_of(code_[first], reciprocals)); // counts the stored reciprocals
    }
    return runs;
}

/// Returns the step of a function of an argument of degree 1, together with the other function if it is one of a pair.
KernelStep StepFinder::whole_step(std::size_t i) const {
    const Instruction& one = code_[i];
    return {whole_kernel(i), {register_at(one.result), register_at(one.third), {}, register_at(one.right), {}, {}}};
}

std::vector<KernelStep> StepFinder::before_all() const {
    std::vector<KernelStep> steps;
    for (std::size_t i = 0; i < code_.size(); ++i) {
        if (times_[i] != Time::before_all)
            continue;
        steps.push_back(whole_step(i));
        if (code_[i].right != code_[i].result)
            ++i;
    }
    return steps;
}

std::vector<KernelStep> StepFinder::after_all() const {
    std::vector<KernelStep> steps;
    for (std::size_t i = 0; i < code_.size(); ++i)
        if (times_[i] == Time::after_all)
            steps.push_back(combination_step(code_[i], &CombinationKernels::whole_combination));
    return steps;
}

Kernel StepFinder::whole_kernel(std::size_t i) const {
    const Instruction& one = code_[i];
    const auto is_pair = [&](SeriesOperation first, SeriesOperation second) {
        return one.operation == first && i + 1 < code_.size() && code_[i + 1].operation == second &&
               one.right == code_[i + 1].result && code_[i + 1].right == one.result;
    };
    const bool is_function = one.operation == SeriesOperation::sin || one.operation == SeriesOperation::sinh ||
                             one.operation == SeriesOperation::exp;
    if (!is_function || tape_.degrees[one.third] > 1) // for other operations `third` is not a register
        return nullptr;
    if (is_pair(SeriesOperation::sin, SeriesOperation::cos))
        return table_.whole_sine_and_cosine;
    if (is_pair(SeriesOperation::sinh, SeriesOperation::cosh))
        return table_.whole_hyperbolic_pair;
    return one.operation == SeriesOperation::exp ? table_.whole_exponential : nullptr;
}

Kernel StepFinder::joint_kernel(std::size_t i, int order, const KernelStep& before) const {
    const Instruction &one = code_[i - 1], &other = code_[i];
    if (before.operands.result != register_at(one.result))
        return nullptr;
    if (other.operation == SeriesOperation::linear_combination) {
        const auto row = static_cast<int>(one.operation);
        const bool multiple = combination_row(other) == 1 && tape_.terms[other.left].series == one.result;
        return multiple && before.kernel == table_.series[row][order] ? table_.with_multiple[row][order] : nullptr;
    }
    const bool quotient = other.operation == SeriesOperation::divide && other.left == one.result;
    return quotient && before.kernel == table_.combinations.combination[2] ? table_.divide_combination[order] : nullptr;
}

bool StepFinder::starts_pair(std::size_t i) const {
    return code_[i].operation == SeriesOperation::sin && i + 1 < code_.size() &&
           code_[i + 1].operation == SeriesOperation::cos && code_[i].third == code_[i + 1].third;
}

KernelOperands StepFinder::combination_operands(const Instruction& instruction) const {
    KernelOperands operands{register_at(instruction.result),  {},
                            constant_at(instruction.third),   {},
                            terms_.data() + instruction.left, terms_.data() + instruction.right};
    if (combination_row(instruction) == 1) { // a single term is stored in the operands directly
        operands.left = register_at(tape_.terms[instruction.left].series);
        operands.third = constant_at(tape_.terms[instruction.left].coefficient);
    }
    return operands;
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

KernelStep StepFinder::combination_step(const Instruction& instruction, CombinationRow row) const {
    const std::size_t count = combination_row(instruction);
    return {(table_.combinations.*row)[count], combination_operands(instruction)};
}

KernelStep StepFinder::series_step(const Instruction& instruction, int order, KernelOperands operands) const {
    switch (instruction.operation) {
    case SeriesOperation::multiply:
        if (order > 0 && std::min(tape_.degrees[instruction.left], tape_.degrees[instruction.right]) <= 1) {
            if (tape_.degrees[instruction.left] > 1)
                operands = {operands.result, operands.right, operands.left, {}, {}, {}};
            return {table_.multiply_linear, operands};
        }
        break;
    default:
        if (const Recurrence recurrence = recurrence_of(instruction.operation);
            order > 0 && is_product(recurrence) && tape_.degrees[instruction.third] <= 1)
            return {recurrence == Recurrence::product ? table_.function_of_linear : table_.minus_function_of_linear,
                    operands};
        break;
    }
    const auto row = static_cast<int>(instruction.operation);
    const bool last = static_cast<std::uint32_t>(order) == std::min(layout_.order, tape_.degrees[instruction.result]);
    return {last && table_.closing[row][order] ? table_.closing[row][order] : table_.series[row][order], operands,
            false};
}

} // namespace graze
