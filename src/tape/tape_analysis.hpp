#pragma once

#include "graze/tape/tape.hpp"
#include "tape/kernel_table.hpp"
#include "tape/recurrence.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace graze {

/// Applies to each register that an instruction reads. Needs the tape's degrees.
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

/// Fills in `degrees`: the smallest that are consistent with the rates. Degrees above 4 are not told from unbounded.
void find_degrees(Tape& tape, const std::vector<bool>& rate_is_zero);

/// The registers that rates, outputs and followers depend on; states are always among them.
std::vector<bool> needed_registers(const Tape& tape);

/// Registers that are states or sums of multiples of them, and constants: at the ends of steps these have the values
/// that their polynomials have, whatever those of the states are worth.
std::vector<bool> affine_registers(const Tape& tape);

/// Registers whose series tell how far others may be followed, whatever their share of the sums that they enter:
/// arguments of functions without singularities, bases of high powers, or quotients, roots and other functions that
/// have some.
struct GuardingRegisters {
    struct Argument {
        std::uint32_t index;
        GuardKind kind;
        double exponent = 1; ///< of a power
        bool operator==(const Argument&) const = default;
    };
    std::vector<Argument> arguments;
    std::vector<std::uint32_t> quotients;
};
GuardingRegisters guarding_registers(const Tape& tape);

/// Removes instructions that nothing needs and renumbers registers.
void remove_unneeded(Tape& tape);

/// Moves instructions that only followers need from `code` to `follower_code`.
/// @param groups of the followers
void set_followers_apart(Tape& tape, std::span<const std::uint32_t> groups);

} // namespace graze
