#pragma once

#include "graze/symbolic/expression.hpp"
#include "graze/symbolic/symbol_index.hpp"

#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

namespace graze {

/// Expressions compiled for evaluation in double precision: a straight list of operations over inputs.
class Function {
public:
    Function() = default;
    /// @throws InputError when an output contains a symbol that is not among the inputs, or an input is
    ///         not a symbol, is named twice, or belongs to another graph
    Function(std::span<const Expression> inputs, std::span<const Expression> outputs);
    Function(const SymbolIndex& inputs, std::span<const Expression> outputs);

    /// One of many outputs of which most are 0, or inputs handed through.
    struct Output {
        std::size_t place = 0;
        Expression value{};
    };
    /// What outputs are that are not given: 0, or the inputs in the same places.
    enum class Others { zero, inputs };
    /// Room and the time to make it go by the size of what is given, not by the number of outputs.
    /// @param outputs their number; @param given by rising place
    /// @throws InputError as above, and for places that do not rise, or outputs that are no inputs
    Function(const SymbolIndex& inputs, std::size_t outputs, std::span<const Output> given, Others others);

    std::size_t inputs() const { return inputs_; }
    std::size_t outputs() const { return output_count_; }
    /// Number of operations.
    std::size_t operations() const { return steps_.size(); }
    /// Number of doubles that `evaluate` needs to work in.
    std::size_t workspace() const { return slots_; }

    /// Evaluates without allocating. The result follows IEEE rules: not finite outside an operation's domain.
    /// @throws InputError, here and below, when there are fewer numbers than these
    /// @param inputs  as many as inputs()
    /// @param results as many as outputs(); may be the same memory as the inputs
    /// @param work    at least workspace(); its contents afterwards are unspecified
    void evaluate(std::span<const double> inputs, std::span<double> results, std::span<double> work) const;
    /// How far results may be from those of exact arithmetic, to first order: each operation rounds, and passes on
    /// what its operands are uncertain by. What cancels in a result does not hide there. Infinite or NaN where a
    /// result is.
    /// @param errors of the inputs, absolute, as many as inputs()
    /// @param bounds as many as outputs()
    /// @param work   at least 2 workspace()
    void error_bounds(std::span<const double> inputs, std::span<const double> errors, std::span<double> bounds,
                      std::span<double> work) const;
    /// Convenience that allocates.
    std::vector<double> operator()(std::span<const double> inputs) const;

private:
    struct Step {
        Operation operation;
        std::uint32_t result, left, right;
    };
    void compile(const SymbolIndex& inputs, std::span<const Expression> outputs);
    void take_inputs(std::span<const double> inputs, std::span<double> slots) const;
    void give_outputs(std::span<const double> slots, std::span<const double> inputs, std::span<double> results) const;

    std::size_t inputs_ = 0;
    std::size_t slots_ = 0;
    std::size_t output_count_ = 0;
    Others others_ = Others::zero;
    std::vector<std::uint32_t> used_; ///< inputs, in the first slots; empty where those are all inputs
    bool uses_all_ = true;
    std::vector<std::pair<std::uint32_t, double>> numbers_;
    std::vector<Step> steps_;
    std::vector<std::uint32_t> outputs_; ///< slots of the outputs that are given
    std::vector<std::uint32_t> places_;  ///< of those among all; empty where all are given
};

/// Value of an expression without symbols; NaN outside an operation's domain.
/// @throws InputError when symbols remain
double constant_value(const Expression& expression);

} // namespace graze
