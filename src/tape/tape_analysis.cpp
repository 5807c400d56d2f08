#include "tape/tape_analysis.hpp"

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <numeric>

namespace graze {

namespace {

std::uint32_t limited_degree(std::uint32_t degree) {
    return degree > Tape::highest_degree ? Tape::unbounded : degree;
}

std::uint32_t degree_of_result(const Tape& tape, const Instruction& instruction) {
    const auto& degrees = tape.degrees;
    switch (instruction.operation) {
    case SeriesOperation::linear_combination: {
        std::uint32_t degree = 0;
        for (std::uint32_t i = instruction.left; i != instruction.right; ++i)
            degree = std::max(degree, degrees[tape.terms[i].series]);
        return degree;
    }
    case SeriesOperation::multiply:
        if (degrees[instruction.left] == Tape::unbounded || degrees[instruction.right] == Tape::unbounded)
            return Tape::unbounded;
        return limited_degree(degrees[instruction.left] + degrees[instruction.right]);
    case SeriesOperation::square:
        return degrees[instruction.left] == Tape::unbounded ? Tape::unbounded
                                                            : limited_degree(2 * degrees[instruction.left]);
    case SeriesOperation::derivative:
        return degrees[instruction.left];
    case SeriesOperation::divide:
        return degrees[instruction.left] == 0 && degrees[instruction.right] == 0 ? 0 : Tape::unbounded;
    case SeriesOperation::reciprocal:
    case SeriesOperation::sqrt:
    case SeriesOperation::power_constant:
        return degrees[instruction.left] == 0 ? 0 : Tape::unbounded;
    default: // functions of `third`
        return degrees[instruction.third] == 0 ? 0 : Tape::unbounded;
    }
}

std::uint32_t degree_of_state(const Tape& tape, std::uint32_t state, bool rate_is_zero) {
    const Tape::Location& rate = tape.rates[state];
    if (rate.constant)
        return rate_is_zero ? 0 : 1;
    return tape.degrees[rate.index] == Tape::unbounded ? Tape::unbounded : limited_degree(tape.degrees[rate.index] + 1);
}

} // namespace

void find_degrees(Tape& tape, const std::vector<bool>& rate_is_zero) {
    tape.degrees.assign(tape.registers, 0);
    // Degrees only grow, up to `unbounded`, so the iteration ends.
    for (bool changed = true; changed;) {
        changed = false;
        const auto set = [&](std::uint32_t reg, std::uint32_t degree) {
            changed |= tape.degrees[reg] != degree;
            tape.degrees[reg] = degree;
        };
        for (std::uint32_t i = 0; i < tape.states; ++i)
            set(i, degree_of_state(tape, i, rate_is_zero[i]));
        for (const Instruction& instruction : tape.code)
            set(instruction.result, degree_of_result(tape, instruction));
    }
}

namespace {

constexpr std::uint32_t no_definition = 0xffffffff;

/// Returns the instruction that computes each register.
std::vector<std::uint32_t> definitions_of(const Tape& tape) {
    std::vector<std::uint32_t> definition(tape.registers, no_definition);
    for (std::uint32_t i = 0; i < tape.code.size(); ++i)
        definition[tape.code[i].result] = i;
    return definition;
}

/// Visits registers and their dependences.
/// @param enter receives a register and returns whether to visit its dependences
template <class Enter>
void visit_dependences(const Tape& tape, const std::vector<std::uint32_t>& definition,
                       std::vector<std::uint32_t> pending, Enter&& enter) {
    while (!pending.empty()) {
        const std::uint32_t reg = pending.back();
        pending.pop_back();
        if (enter(reg) && definition[reg] != no_definition)
            visit_operands(tape, tape.code[definition[reg]],
                           [&](std::uint32_t operand) { pending.push_back(operand); });
    }
}

std::vector<std::uint32_t> registers_at(std::span<const Tape::Location> locations) {
    std::vector<std::uint32_t> registers;
    for (const Tape::Location& location : locations)
        if (!location.constant)
            registers.push_back(location.index);
    return registers;
}

std::vector<bool> registers_behind(const Tape& tape, std::initializer_list<std::span<const Tape::Location>> ends) {
    std::vector<bool> needed(tape.registers, false);
    std::vector<std::uint32_t> pending(tape.states);
    std::iota(pending.begin(), pending.end(), 0U);
    for (const std::span<const Tape::Location> locations : ends)
        for (const std::uint32_t reg : registers_at(locations))
            pending.push_back(reg);
    visit_dependences(tape, definitions_of(tape), std::move(pending), [&](std::uint32_t reg) {
        const bool is_new = !needed[reg];
        needed[reg] = true;
        return is_new;
    });
    return needed;
}

} // namespace

std::vector<bool> needed_registers(const Tape& tape) {
    return registers_behind(tape, {tape.rates, tape.outputs, tape.deferred});
}

void separate_deferred_code(Tape& tape, std::span<const std::uint32_t> groups) {
    if (groups.empty())
        return;
    constexpr std::uint32_t value = 0xfffffffe; // owner of registers needed for rates and outputs
    const std::uint32_t count = *std::max_element(groups.begin(), groups.end()) + 1;
    constexpr std::uint32_t first = 0, shared = 1; // indices in `deferred_code`; group g has index g + 1
    std::vector<std::uint32_t> owner(tape.registers, no_definition);
    const std::vector<bool> of_value = registers_behind(tape, {tape.rates, tape.outputs});
    for (std::uint32_t reg = 0; reg < tape.registers; ++reg)
        if (of_value[reg])
            owner[reg] = value;
    const std::vector<std::uint32_t> definition = definitions_of(tape);
    std::vector<std::vector<Tape::Location>> ends(count);
    for (std::size_t i = 0; i < groups.size(); ++i)
        ends[groups[i]].push_back(tape.deferred[i]);
    for (std::uint32_t group = 0; group < count; ++group) {
        const std::uint32_t own = group == 0 ? first : 1 + group;
        visit_dependences(tape, definition, registers_at(ends[group]), [&](std::uint32_t reg) {
            if (owner[reg] == value || owner[reg] == first || owner[reg] == shared || owner[reg] == own)
                return false;
            owner[reg] = owner[reg] == no_definition ? own : shared;
            return true;
        });
    }
    tape.deferred_code.resize(count + 1);
    std::vector<Instruction> code;
    for (const Instruction& instruction : tape.code)
        (owner[instruction.result] == value ? code : tape.deferred_code[owner[instruction.result]])
            .push_back(instruction);
    tape.code = std::move(code);
}

namespace {

/// Adds high powers, which are narrow peaks where their bases are not: each base is guarded with its highest power.
void add_powers(const Tape& tape, GuardingRegisters& guards) {
    constexpr double high = 64;
    std::vector<std::uint32_t> base(tape.registers);
    std::iota(base.begin(), base.end(), 0U);
    std::vector<double> power(tape.registers, 1), highest(tape.registers, 1);
    const auto set = [&](std::uint32_t result, std::uint32_t of, double exponent) {
        base[result] = base[of];
        power[result] = exponent;
        highest[base[of]] = std::max(highest[base[of]], std::abs(exponent));
    };
    for (const Instruction& instruction : tape.code) {
        if (instruction.operation == SeriesOperation::square)
            set(instruction.result, instruction.left, 2 * power[instruction.left]);
        if (instruction.operation == SeriesOperation::multiply && base[instruction.left] == base[instruction.right])
            set(instruction.result, instruction.left, power[instruction.left] + power[instruction.right]);
        if (instruction.operation == SeriesOperation::power_constant)
            for (const auto& [index, value] : tape.literals)
                if (index == instruction.right)
                    set(instruction.result, instruction.left, value * power[instruction.left]);
    }
    for (std::uint32_t index = 0; index < tape.registers; ++index)
        if (highest[index] >= high && tape.degrees[index] > 0)
            guards.arguments.push_back({index, GuardKind::power, highest[index]});
}

} // namespace

GuardingRegisters guarding_registers(const Tape& tape) {
    GuardingRegisters guards;
    const auto add = [&](std::uint32_t reg, GuardKind kind) {
        const GuardingRegisters::Argument guard{reg, kind, 1};
        if (std::find(guards.arguments.begin(), guards.arguments.end(), guard) == guards.arguments.end())
            guards.arguments.push_back(guard);
    };
    for (const Instruction& instruction : tape.code) {
        const auto argument_degree = [&] { return tape.degrees[instruction.third]; };
        switch (instruction.operation) {
        case SeriesOperation::sin:
        case SeriesOperation::cos:
            // The sine of a phase is of size one itself, so its own series limits the step.
            if (argument_degree() > 1)
                add(instruction.third, GuardKind::other);
            break;
        case SeriesOperation::sinh:
        case SeriesOperation::cosh:
            if (argument_degree() > 0)
                add(instruction.third, GuardKind::other);
            break;
        case SeriesOperation::exp:
            if (argument_degree() > 0)
                add(instruction.third, GuardKind::exponential);
            break;
        case SeriesOperation::tanh:
            if (argument_degree() > 0)
                add(instruction.third, GuardKind::hyperbolic_tangent);
            break;
        case SeriesOperation::divide:
        case SeriesOperation::reciprocal:
        case SeriesOperation::sqrt:
        case SeriesOperation::power_constant:
        case SeriesOperation::tan:
            if (tape.degrees[instruction.result] > 1)
                guards.quotients.push_back(instruction.result);
            break;
        default:
            break;
        }
    }
    add_powers(tape, guards);
    return guards;
}

std::vector<bool> affine_registers(const Tape& tape) {
    std::vector<bool> affine(tape.registers, false);
    std::fill_n(affine.begin(), tape.states, true);
    for (const Instruction& instruction : tape.code) {
        if (instruction.operation != SeriesOperation::linear_combination)
            continue;
        bool all = true;
        for (std::uint32_t i = instruction.left; i != instruction.right; ++i)
            all = all && affine[tape.terms[i].series];
        affine[instruction.result] = all;
    }
    return affine;
}

void remove_unneeded(Tape& tape) {
    const std::vector<bool> needed = needed_registers(tape);
    std::vector<std::uint32_t> number(tape.registers, 0);
    std::vector<std::uint32_t> degrees;
    for (std::uint32_t i = 0; i < tape.registers; ++i) {
        if (!needed[i])
            continue;
        number[i] = static_cast<std::uint32_t>(degrees.size());
        degrees.push_back(tape.degrees[i]);
    }
    std::vector<Instruction> code;
    std::vector<Term> terms;
    for (Instruction instruction : tape.code) {
        if (!needed[instruction.result])
            continue;
        instruction.result = number[instruction.result];
        if (instruction.operation == SeriesOperation::linear_combination) {
            const auto first = static_cast<std::uint32_t>(terms.size());
            for (std::uint32_t i = instruction.left; i != instruction.right; ++i)
                terms.push_back({number[tape.terms[i].series], tape.terms[i].coefficient});
            instruction.left = first;
            instruction.right = static_cast<std::uint32_t>(terms.size());
        } else {
            // Operands that the operation does not read become register 0.
            instruction.left = number[instruction.left];
            if (instruction.operation != SeriesOperation::power_constant)
                instruction.right = number[instruction.right];
            instruction.third = number[instruction.third];
        }
        code.push_back(instruction);
    }
    for (auto* locations : {&tape.rates, &tape.outputs, &tape.deferred})
        for (Tape::Location& location : *locations)
            if (!location.constant)
                location.index = number[location.index];
    tape.registers = static_cast<std::uint32_t>(degrees.size());
    tape.degrees = std::move(degrees);
    tape.code = std::move(code);
    tape.terms = std::move(terms);
}

} // namespace graze
