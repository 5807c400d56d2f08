#pragma once

#include "graze/tape/series.hpp"
#include "graze/tape/tape.hpp"

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string_view>

namespace graze {

/// Instruction sets for which the kernels are compiled.
enum class InstructionSet { baseline, avx2, avx512 };
/// Returns the widest instruction set that this processor supports.
InstructionSet best_instruction_set();
bool is_supported(InstructionSet set);
std::string_view name_of(InstructionSet set);

/// The meaning of the lanes of a jet.
enum class LaneKind {
    single,   ///< one trajectory
    ensemble, ///< independent trajectories of one tape, side by side
};

/// Whether a jet of a single lane uses machine code made from its tape, which computes the same, bit for bit, in less
/// time. It is made on x86-64 processors with AVX2, if the library was built with the assembler (`GRAZE_NATIVE`).
enum class MachineCode {
    never,
    in_long_runs, ///< once jets of the tape have computed some thousand times, unless the tape excludes it
    at_once,      ///< for tests; the same unless the tape excludes it
};

/// Highest order for which kernels exist.
inline constexpr int highest_order = 32;

/// Tolerances for the difference between the polynomials at the end of a step and the model there.
struct EndAllowance {
    double rates = 0,
           values = 0;   ///< tolerances relative to the sizes of states and outputs, for their rates and values
    double smallest = 0; ///< added to each size
};

/// Computes Taylor coefficients of states and outputs of a tape (Jorba and Zou 2005; Griewank and Walther 2008, chapter
/// 13). Each number is stored once per lane: coefficient k of a series, lane l, is at [k * width() + l]. On one
/// instruction set, a `single` jet and each lane of an `ensemble` jet agree bit for bit.
class Jet {
public:
    virtual ~Jet() = default;
    Jet(const Jet&) = delete;
    Jet& operator=(const Jet&) = delete;

    virtual int order() const = 0;
    virtual int width() const = 0;

    /// @param parameters [parameter * width() + lane]
    /// @throws InputError (here and below) when a span is too short or an index out of range
    virtual void set_parameters(std::span<const double> parameters) = 0;
    /// Computes coefficients 0 .. order() from states [state * width() + lane].
    virtual void compute(std::span<const double> states) = 0;
    /// Computes only coefficients 0 and 1, a cheap evaluation at a point. A later `compute` of the same states
    /// continues from there. All other coefficients are undefined.
    virtual void begin(std::span<const double> states) = 0;

    /// Coefficients of a state or output: (order() + 1) * width() numbers, valid until the next `compute`.
    virtual const double* state(std::size_t index) const = 0;
    virtual const double* output(std::size_t index) const = 0;

    /// Computes the deferred expressions of group 0 and of the given groups (an empty group is allowed).
    /// `begin_deferred` computes only their coefficients 0 and 1.
    /// @throws OrderError unless `compute` (or, for `begin_deferred`, `begin`) has been called before
    virtual void compute_deferred(std::span<const std::uint32_t> groups) = 0;
    virtual void begin_deferred(std::span<const std::uint32_t> groups) = 0;
    /// Coefficients of a deferred expression, laid out as those of an output; only coefficient 0 if it is a constant.
    virtual const double* deferred(std::size_t index) const = 0;
    virtual std::size_t deferred_count() const = 0;

    /// Series of lane 0 of all states, then of all outputs; lane l of each is l numbers later. Valid until the next
    /// `compute`.
    virtual std::span<const Series> series() const = 0;

    /// Finds in each lane the largest step at which the last two terms of each series are at most a tolerance relative
    /// to its size (Jorba and Zou 2005) and do not grow; then applies `guard_steps`.
    /// @param log_tolerance logarithm of the tolerance to base 2
    /// @param references [lane] lengths of time at which the sizes of series are taken, such as the last step
    /// @param steps [lane] infinity where the last two terms of all series are zero, NaN where a coefficient is not
    /// finite
    virtual void find_steps(double log_tolerance, std::span<const double> references,
                            std::span<double> steps) const = 0;
    /// Shortens steps over which the argument of an exponential, sine or the like changes too much, or a quotient or
    /// root comes too close to its singularity, for series of this order to converge. This matters where the function
    /// is negligible in the sum that contains it: far from a narrow peak or a steep slope the other criteria do not see
    /// it.
    /// @param steps [lane] non-finite ones are unchanged
    virtual void guard_steps(std::span<double> steps) const = 0;

    /// Evaluates the series of all states, in each lane at its own time.
    /// @param times [lane]
    /// @param values [state * width() + lane]
    virtual void evaluate_states(std::span<const double> times, std::span<double> values) const = 0;
    /// The same with the derivatives with respect to time. @param slopes [state * width() + lane]
    virtual void evaluate_states(std::span<const double> times, std::span<double> values,
                                 std::span<double> slopes) const = 0;
    /// Compares the polynomials at the ends of steps with the model: returns per lane the largest excess of a
    /// difference over its allowance, of all states and outputs; at most 0 if all are within it, infinity where a
    /// number is not finite.
    /// @param end jet of the same tape and order, after `begin` at the ends; @param lengths [lane] of the steps
    /// @param values, slopes of the states at the ends, as from `evaluate_states`; @param worst [lane] the result
    /// @throws InputError for a jet of another tape
    virtual void find_disagreement(const Jet& end, const EndAllowance& allowance, std::span<const double> lengths,
                                   std::span<const double> values, std::span<const double> slopes,
                                   std::span<double> worst) const = 0;
    /// Evaluates the series of one output, in each lane at its own time. @param values [lane]
    virtual void evaluate_output(std::size_t index, std::span<const double> times, std::span<double> values) const = 0;
    /// Bounds the first outputs from below on [0, lengths[lane]]: their values are convex combinations of the partial
    /// sums at the end, so the least partial sum less its round-off is a bound; -infinity if it is not finite.
    /// @param least [output * width() + lane]; its size gives the number of outputs
    /// @param sizes likewise: sum |c_k| length^k of each series
    virtual void bound_outputs(std::span<const double> lengths, std::span<double> least,
                               std::span<double> sizes) const = 0;

protected:
    Jet() = default;
};

/// Returns the number of lanes of a jet.
int lanes_of(LaneKind kind, InstructionSet set);

/// Makes a jet; the tape is not needed afterwards. Computing does not allocate. Parameters are 0 until they are set.
/// @param order 1 .. highest_order
/// @param code has an effect only on jets of a single lane
/// @throws InputError when the instruction set is not supported or the order out of range
std::unique_ptr<Jet> make_jet(const Tape& tape, int order, LaneKind kind, InstructionSet set = best_instruction_set(),
                              MachineCode code = MachineCode::in_long_runs);

} // namespace graze
