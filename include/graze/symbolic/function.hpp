#pragma once

#include "graze/symbolic/expression.hpp"

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
    /// @throws std::invalid_argument when an output contains a symbol that is not among the inputs, or an input is
    ///         not a symbol, is named twice, or belongs to another graph
    Function(std::span<const Expression> inputs, std::span<const Expression> outputs);

    std::size_t inputs() const { return inputs_; }
    std::size_t outputs() const { return outputs_.size(); }
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
    std::size_t inputs_ = 0;
    std::size_t slots_ = 0;
    std::vector<std::pair<std::uint32_t, double>> numbers_;
    std::vector<Step> steps_;
    std::vector<std::uint32_t> outputs_;
};

/// Value of an expression without symbols; NaN outside an operation's domain.
/// @throws std::invalid_argument when symbols remain
double constant_value(const Expression& expression);

} // namespace graze
