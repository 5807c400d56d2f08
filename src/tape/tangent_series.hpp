#pragma once

#include "graze/tape/jet.hpp"
#include "graze/tape/tangent_equations.hpp"
#include "tape/aligned_numbers.hpp"
#include "tape/kernel_table.hpp"

#include <cstddef>
#include <span>
#include <vector>

namespace graze {

/// Taylor coefficients of what changes along a motion in some directions: of the solutions of the first variational
/// equations. The motion's series are computed once, by a single jet of which the equations' coefficients are
/// followers; for each direction there are convolutions with these.
class TangentSeries {
public:
    /// @param tape of which the equations' coefficients are followers; @param like any single jet of it: coefficients
    /// are found in others where they are in this one
    /// @param moving of each parameter, whether any direction changes it
    /// @param directions that there may be at once; more than one register holds are computed in several goes
    /// @throws InputError for entries that are out of range or not in order
    TangentSeries(const Tape& tape, const TangentEquations& equations, const Jet& like, std::span<const char> moving,
                  std::size_t directions, InstructionSet set = best_instruction_set());
    TangentSeries(const TangentSeries&) = delete; // rows point to terms
    TangentSeries& operator=(const TangentSeries&) = delete;

    /// Directions that are computed together.
    std::size_t width() const { return width_; }
    int order() const { return order_; }

    /// Changes where the step begins, row by row. @param matrix states x directions; @param seeds parameters x
    /// directions; @param first of the directions to be taken; @param count at most the width
    void load(std::span<const double> matrix, std::span<const double> seeds, std::size_t directions, std::size_t first,
              std::size_t count);
    /// From numbers laid out as `evaluate` leaves them; parameters' changes are those of another.
    void load(std::span<const double> states, const TangentSeries& parameters);
    /// All coefficients, once the jet's followers have been computed.
    void compute(const Jet& jet);
    /// Coefficients 0 and 1 alone, for which followers need only have been begun.
    void begin(const Jet& jet);

    /// Coefficients of a state's changes: (order() + 1) * width() numbers, [k * width() + direction].
    const double* state(std::size_t index) const { return numbers_.data() + index * size_; }
    /// Coefficients of what changes an entry's source, likewise.
    const double* source(std::size_t index) const;
    /// Sums of the states' series, and of their derivatives with respect to time. @param values, slopes
    /// [state * width() + direction]
    void evaluate(double time, std::span<double> values, std::span<double> slopes);
    /// The largest share that the last two terms of any state's changes have in their first three, or in floors where
    /// these are larger. @param floors [state * width() + direction], or none
    double tails(double step, std::span<const double> floors) const;
    /// The first state, from one on, of which the slope of a change at the end of a step is not the rate that `end`
    /// has there: |h| |slope - rate| exceeds a share of the larger of both ends' sizes and |h| / 4 times the larger of
    /// both rates. As many as there are states if there is none.
    /// @param end begun there; @param values, slopes as from `evaluate`
    std::size_t find_misfit(const TangentSeries& end, const EndAllowance& allowance, double length,
                            std::span<const double> values, std::span<const double> slopes, std::size_t from) const;

private:
    TangentStates in_use() const {
        return {numbers_.data(),
                states_,
                size_,
                static_cast<int>(count_),
                order_,
                followed_.data(),
                followed_.data() + followed_.size()};
    }
    std::size_t row_of_source(std::size_t source) const;
    std::vector<int> degrees_of_rows(const Tape& tape, const TangentEquations& equations) const;
    TangentRow row_of(std::size_t row, std::span<const TangentTerm> terms);
    void find_rows(const Tape& tape, const TangentEquations& equations, const Jet& like);

    const TangentKernels& kernels_;
    std::size_t states_, parameters_, intermediates_, width_;
    int order_;
    std::size_t size_, count_ = 0;            ///< numbers in a series; directions that are in use
    std::vector<std::size_t> parameter_rows_; ///< of those that move
    std::vector<std::size_t> moving_;         ///< which these are
    std::vector<TangentTerm> terms_;
    std::vector<TangentRow> rows_;
    TangentOperands operands_{};
    AlignedNumbers numbers_;            ///< of states, then intermediate quantities, then parameters
    std::vector<Series> series_;        ///< of states
    std::vector<int> degrees_;          ///< of all of these
    std::vector<std::size_t> followed_; ///< states of which the last terms say how far a step may go
    std::vector<double> times_;
};

} // namespace graze
