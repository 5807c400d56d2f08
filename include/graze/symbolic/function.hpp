#pragma once

#include "graze/symbolic/expression.hpp"
#include "graze/symbolic/interval.hpp"
#include "graze/symbolic/symbol_index.hpp"

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <utility>
#include <vector>

namespace graze {

/// Expressions compiled for evaluation in double precision: a flat list of operations over inputs.
class Function {
public:
    Function() = default;
    /// @throws InputError when an output contains a symbol that is not among the inputs, or an input is
    ///         not a symbol, is named twice, or belongs to another graph
    Function(std::span<const Expression> inputs, std::span<const Expression> outputs);
    Function(const SymbolIndex& inputs, std::span<const Expression> outputs);

    /// One given output: its value and its index among all outputs.
    struct Output {
        std::size_t place = 0;
        Expression value{};
    };
    /// The value of outputs that are not given: 0, or the input of the same index.
    enum class Others { zero, inputs };
    /// Compiles a function most of whose outputs are 0 or copies of inputs; time and memory are proportional to the
    /// size of the given outputs, not to the number of all outputs.
    /// @param outputs number of all outputs; @param given outputs by rising place
    /// @throws InputError as above, when places do not rise, or when a copied output has no input of its
    /// index
    Function(const SymbolIndex& inputs, std::size_t outputs, std::span<const Output> given, Others others);

    std::size_t inputs() const { return inputs_; }
    std::size_t outputs() const { return output_count_; }
    /// Returns the number of operations.
    std::size_t operations() const { return steps_.size(); }
    /// Returns the number of doubles that `evaluate` needs as workspace.
    std::size_t workspace() const { return slots_; }

    /// Evaluates without allocating. The result follows IEEE rules: not finite outside an operation's domain.
    /// @throws InputError, here and below, when a span is shorter than stated
    /// @param inputs  inputs() values
    /// @param results outputs() values; may be the same memory as the inputs
    /// @param work    at least workspace(); its contents afterwards are unspecified
    void evaluate(std::span<const double> inputs, std::span<double> results, std::span<double> work) const;
    /// Bounds the distance of the results from those of exact arithmetic, to first order: each operation adds its
    /// rounding and propagates the uncertainty of its operands, so that cancellation shows. Infinite or NaN where a
    /// result is.
    /// @param errors absolute errors of the inputs, inputs() values
    /// @param bounds outputs() values
    /// @param work   at least 2 workspace()
    void error_bounds(std::span<const double> inputs, std::span<const double> errors, std::span<double> bounds,
                      std::span<double> work) const;
    /// Encloses the values that the outputs have in a box of the inputs, those of exact arithmetic; numbers in the
    /// expressions are taken as the doubles that they are.
    /// @param inputs  inputs() intervals
    /// @param results outputs() intervals
    /// @param work    at least workspace(); its contents afterwards are what `narrow` needs
    void enclose(std::span<const Interval> inputs, std::span<Interval> results, std::span<Interval> work) const;
    /// Shrinks a box of the inputs to one that contains all its points at which the first outputs lie in given
    /// intervals, by inverting the operations from the last to the first. F. Benhamou, F. Goualard, L. Granvilliers,
    /// J.-F. Puget, Revising hull and box consistency, ICLP 1999.
    /// @param inputs the box that `enclose` was given
    /// @param wanted intervals of the first outputs; outputs beyond have any value, or none
    /// @param work   as `enclose` has left it; its contents afterwards are unspecified
    /// @return false if the box has no such point
    bool narrow(std::span<Interval> inputs, std::span<const Interval> wanted, std::span<Interval> work) const;
    /// The same as `evaluate` with allocation: returns the outputs.
    std::vector<double> operator()(std::span<const double> inputs) const;

private:
    /// `right` of a lookup: 4 times the index of its table, plus the derivative.
    struct Step {
        Operation operation;
        std::uint32_t result, left, right;
    };
    const PieceTable& table_of(const Step& step) const { return *tables_[step.right / 4]; }
    static int derivative_of(const Step& step) { return static_cast<int>(step.right % 4); }
    std::uint32_t look_up(const Graph& graph, const Node& node);
    double error_of(const Step& step, double value, double left, double left_error, double right,
                    double right_error) const;
    void compile(const SymbolIndex& inputs, std::span<const Expression> outputs);
    template <class Number>
    void take_inputs(std::span<const Number> inputs, std::span<Number> slots) const;
    template <class Number>
    void give_outputs(std::span<const Number> slots, std::span<const Number> inputs, std::span<Number> results) const;

    std::size_t inputs_ = 0;
    std::size_t slots_ = 0;
    std::size_t output_count_ = 0;
    Others others_ = Others::zero;
    std::vector<std::uint32_t> used_; ///< indices of the inputs in the first slots; empty if all inputs are used
    bool uses_all_ = true;
    std::vector<std::pair<std::uint32_t, double>> numbers_;
    std::vector<Step> steps_;
    std::vector<std::shared_ptr<const PieceTable>> tables_; ///< that are looked up
    std::vector<std::uint32_t> outputs_;                    ///< slots of the outputs that are given
    std::vector<std::uint32_t> places_;                     ///< their indices among all outputs; empty if all are given
};

/// Returns the value of an expression without symbols; NaN outside an operation's domain.
/// @throws InputError when the expression contains a symbol
double constant_value(const Expression& expression);

} // namespace graze
