#pragma once

#include "tape/kernel_table.hpp"

#include <vector>

namespace graze {

/// Offsets of all parts in the jet's memory, in doubles.
struct JetLayout {
    JetLayout(const Tape& tape, int highest, int width);

    std::uint32_t order;
    std::size_t number; ///< size of a number
    std::size_t series; ///< size of a series
    std::size_t registers, reciprocals, constant_outputs;
    std::size_t size;
};

/// A kernel and its operands. A null kernel means: second operands of the step before.
struct KernelStep {
    Kernel kernel;
    KernelOperands operands;
    bool reads_order = true; ///< whether the kernel serves several orders
};

/// Chooses kernels and operands for the steps of each order, starting with orders 0 and 1. Some series are computed for
/// all higher orders at once: before the other steps if they depend only on an argument of degree 1, after them if
/// nothing depends on them.
class StepFinder {
public:
    /// For the states and outputs.
    StepFinder(const Tape& tape, const KernelTable& table, const JetLayout& layout, double* memory,
               const std::vector<TermOperands>& terms);
    /// For one part of the deferred code. @param part index in Tape::deferred_code
    StepFinder(const Tape& tape, std::size_t part, const KernelTable& table, const JetLayout& layout, double* memory,
               const std::vector<TermOperands>& terms);

    /// @param joins_states whether one kernel may compute two states
    std::vector<KernelStep> steps(int order, bool joins_states = true) const;
    bool is_state(const KernelStep& step) const { return step.operands.result < register_at(tape_.states); }
    std::vector<KernelStep> before_all() const;
    std::vector<KernelStep> after_all() const;

    /// A single instruction, or several that depend on each other, with all orders above 1. Instructions that do not
    /// feed back into their operands have less latency when computed this way.
    struct Run {
        bool whole = false;                         ///< all orders by one kernel
        std::vector<std::vector<KernelStep>> steps; ///< for each order from 2 on
    };
    std::vector<Run> runs() const;

private:
    static constexpr std::uint32_t none = 0xffffffff;

    double* register_at(std::uint32_t index) const { return memory_ + layout_.registers + index * layout_.series; }
    double* constant_at(std::uint32_t index) const { return memory_ + index * layout_.number; }

    /// When the coefficients of orders above 1 are computed.
    enum class Time : unsigned char { at_each_order, before_all, after_all };

    /// Linear combinations that are needed for the rate of one state only are computed with that state.
    void find_private_rates(const std::vector<std::uint32_t>& uses);
    void find_times(const std::vector<std::uint32_t>& uses);
    void add_states(int order, bool joins_states, std::vector<KernelStep>& steps) const;
    void add_instructions(int order, std::vector<KernelStep>& steps) const;
    /// Adds the instructions first .. behind - 1.
    void add_instructions(int order, std::size_t first, std::size_t behind, std::uint32_t reciprocals,
                          std::vector<KernelStep>& steps) const;
    std::size_t end_of_run(std::size_t first, const std::vector<std::size_t>& behind) const;

    /// True when an instruction is a sine and the next one the cosine of the same argument.
    bool starts_pair(std::size_t i) const;
    /// Returns the kernel for a function (and its partner, if one of a pair); null if it needs more than its argument.
    Kernel whole_kernel(std::size_t i) const;
    KernelStep whole_step(std::size_t i) const;
    /// Returns the kernel for an instruction joined with the one before, whose step is given; null where there is none.
    Kernel joint_kernel(std::size_t i, int order, const KernelStep& before) const;

    KernelOperands combination_operands(const Instruction& instruction) const;
    KernelOperands operands_of(const Instruction& instruction, std::uint32_t& reciprocals) const;
    static std::size_t combination_row(const Instruction& instruction);
    using CombinationRow = Kernel (CombinationKernels::*)[combination_kernels];
    KernelStep combination_step(const Instruction& instruction, CombinationRow row) const;
    /// May exchange operands where the kernel needs them in a certain order.
    KernelStep series_step(const Instruction& instruction, int order, KernelOperands operands) const;

    const Tape& tape_;
    const std::vector<Instruction>& code_;
    bool has_states_;               ///< the code also computes states
    std::uint32_t reciprocals_ = 0; ///< number of reciprocals stored by earlier code
    const KernelTable& table_;
    const JetLayout& layout_;
    double* memory_;
    const std::vector<TermOperands>& terms_;
    /// For registers that are computed together with a state, the instruction.
    std::vector<std::uint32_t> combination_of_;
    std::vector<Time> times_; ///< for each instruction
};

} // namespace graze
