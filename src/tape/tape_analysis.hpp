#pragma once

#include "graze/tape/tape.hpp"
#include "tape/kernel_table.hpp"
#include "tape/recurrence.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace graze {

/// Calls `visit` for each register that an instruction reads. Needs the tape's degrees.
template <class Visit>
void visit_operands(const Tape& tape, const Instruction& instruction, Visit&& visit) {
    switch (instruction.operation) {
    case SeriesOperation::linear_combination:
        for (std::uint32_t i = instruction.left; i != instruction.right; ++i)
            visit(tape.terms[i].series);
        return;
    case SeriesOperation::multiply:
    case SeriesOperation::divide:
        visit(instruction.left);
        visit(instruction.right);
        return;
    case SeriesOperation::square:
    case SeriesOperation::reciprocal:
    case SeriesOperation::sqrt:
    case SeriesOperation::power_constant:
    case SeriesOperation::derivative:
        visit(instruction.left);
        return;
    default: { // functions of `third`
        const std::uint32_t degree = tape.degrees[instruction.third];
        const bool product = is_product(recurrence_of(instruction.operation));
        visit(instruction.third);
        if (product && degree > 0)
            visit(instruction.right);
        if (degree > (product ? 1 : 0))
            visit(instruction.left);
    }
    }
}

/// Fills in `degrees`: the smallest that are consistent with the rates. Degrees above 4 count as unbounded.
void find_degrees(Tape& tape, const std::vector<bool>& rate_is_zero);

/// Returns the registers on which rates, outputs and deferred expressions depend; states are always included.
std::vector<bool> needed_registers(const Tape& tape);

/// Returns the registers that are states, or constants plus multiples of states: at ends of steps their values agree
/// with their polynomials, however accurate the states are.
std::vector<bool> affine_registers(const Tape& tape);

/// Registers whose series limit the step, whatever their share of the sums that contain them: arguments of functions
/// without singularities, bases of high powers, and quotients, roots and other functions with singularities.
struct GuardingRegisters {
    struct Argument {
        std::uint32_t index;
        GuardKind kind;
        double exponent = 1; ///< exponent of a power
        bool operator==(const Argument&) const = default;
    };
    std::vector<Argument> arguments;
    std::vector<std::uint32_t> quotients;
};
GuardingRegisters guarding_registers(const Tape& tape);

/// Removes instructions that nothing needs and renumbers registers.
void remove_unneeded(Tape& tape);

/// Moves instructions that only deferred expressions need from `code` to `deferred_code`.
/// @param groups the group of each deferred expression
void separate_deferred_code(Tape& tape, std::span<const std::uint32_t> groups);

} // namespace graze
