#pragma once

#include "tape/kernel_table.hpp"

#include <vector>

namespace graze {

/// Where everything is, in doubles from the start of the jet's memory.
struct Layout {
    Layout(const Tape& tape, int highest, int width);

    std::uint32_t order;
    std::size_t number; ///< size of a number
    std::size_t series; ///< size of a series
    std::size_t registers, reciprocals, constant_outputs;
    std::size_t size;
};

/// A kernel and what it is called with.
struct KernelStep {
    Kernel kernel;
    KernelOperands operands;
};

/// Finds the kernels and operands of the steps to be taken at each order.
class StepFinder {
public:
    StepFinder(const Tape& tape, const KernelTable& table, const Layout& layout, double* memory,
               const std::vector<TermOperands>& terms);

    std::vector<KernelStep> steps(int order) const;

private:
    static constexpr std::uint32_t none = 0xffffffff;

    double* register_at(std::uint32_t index) const { return memory_ + layout_.registers + index * layout_.series; }
    double* constant_at(std::uint32_t index) const { return memory_ + index * layout_.number; }

    /// Linear combinations that are needed for the rate of one state only are computed with that state.
    void find_private_rates();
    void add_states(int order, std::vector<KernelStep>& steps) const;
    void add_instructions(int order, std::vector<KernelStep>& steps) const;

    /// Whether an instruction is a sine and the next the cosine of the same argument.
    bool starts_pair(std::size_t i) const;

    KernelOperands combination_operands(const Instruction& instruction) const;
    KernelOperands operands_of(const Instruction& instruction, std::uint32_t& reciprocals) const;
    static std::size_t combination_row(const Instruction& instruction);
    /// May exchange operands where the kernel wants them in a certain order.
    Kernel kernel_of(const Instruction& instruction, int order, KernelOperands& operands) const;

    const Tape& tape_;
    const KernelTable& table_;
    const Layout& layout_;
    double* memory_;
    const std::vector<TermOperands>& terms_;
    /// For registers that are computed with a state, the instruction.
    std::vector<std::uint32_t> combination_of_;
};

} // namespace graze
