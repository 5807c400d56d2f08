#pragma once

#include "graze/tape/jet.hpp"
#include "tape/aligned_numbers.hpp"
#include "tape/kernel_table.hpp"

#include <cstddef>
#include <span>
#include <vector>

namespace graze {

/// Taylor coefficients of the changes of a motion in some directions: solutions of the first variational equations. The
/// series of the motion are computed once, by a single jet whose deferred expressions are the coefficients of the
/// equations; each direction is convolved with them.
class TangentSeries {
public:
    /// @param tape with the equations' coefficients among its deferred expressions; @param like any single jet of the
    /// tape; other jets must have the same layout
    /// @param moving for each parameter, whether any direction changes it
    /// @param directions the largest number at once; more directions than `width()` are computed in several passes
    /// @throws InputError for entries that are out of range or not in order
    TangentSeries(const Tape& tape, const TangentEquations& equations, const Jet& like, std::span<const char> moving,
                  std::size_t directions, InstructionSet set = best_instruction_set());
    TangentSeries(const TangentSeries&) = delete; // rows point to terms
    TangentSeries& operator=(const TangentSeries&) = delete;

    /// Number of directions that are computed together.
    std::size_t width() const { return width_; }
    int order() const { return order_; }

    /// Sets the changes at the beginning of the step. @param matrix states x directions; @param seeds parameters x
    /// directions, both row by row; @param first first direction to take; @param count at most the width
    void load(std::span<const double> matrix, std::span<const double> seeds, std::size_t directions, std::size_t first,
              std::size_t count);
    /// Sets them from values laid out as by `evaluate`; the changes of parameters are copied from `parameters`.
    void load(std::span<const double> states, const TangentSeries& parameters);
    /// Computes all coefficients, after the jet's deferred expressions.
    void compute(const Jet& jet);
    /// Computes coefficients 0 and 1 only, for which the jet's `begin_deferred` is enough.
    void begin(const Jet& jet);

    /// Returns the coefficients of the changes of a state: (order() + 1) * width() numbers, [k * width() + direction].
    const double* state(std::size_t index) const { return numbers_.data() + index * size_; }
    /// Returns the coefficients of the changes of a source of entries, in the same layout.
    const double* source(std::size_t index) const;
    /// Evaluates the states' series and their derivatives with respect to time. @param values, slopes [state * width()
    /// + direction]
    void evaluate(double time, std::span<double> values, std::span<double> slopes);
    /// Returns the largest ratio, over all states and directions, of the last two terms to the first three, or to
    /// `floors` where these are larger. @param floors [state * width() + direction], or empty
    double tails(double step, std::span<const double> floors) const;
    /// Returns the first state, from `from` on, for which the slope of a change at the end of a step differs from the
    /// rate that `end` has there: |h| |slope - rate| exceeds the allowance of the larger of both ends' sizes plus |h| /
    /// 4 times the larger of both rates. Returns the number of states if there is none.
    /// @param end series after `begin` at the end; @param values, slopes as from `evaluate`
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
