#pragma once

// What the translation units of the instruction sets offer to the rest: tables of kernels. Nothing here may contain
// inline functions, since code compiled for a wide instruction set must not be what the linker keeps for all.

#include "graze/tape/jet.hpp"
#include "graze/tape/series.hpp"
#include "graze/tape/tape.hpp"
#include "symbolic/function_table.hpp"

#include <cstddef>

namespace graze {

inline constexpr int operation_count = static_cast<int>(last_function) + 1;
inline constexpr int series_operation_count = static_cast<int>(SeriesOperation::acos) + 1;

/// One product of a linear combination.
struct TermOperands {
    const double* series;
    const double* coefficient;
};

/// Where a kernel finds its series. `third` is written to by the operations that keep a reciprocal.
struct KernelOperands {
    double* result;
    const double* left;
    const double* right;
    double* third;
    const TermOperands* terms;
    const TermOperands* terms_end;
};

/// Of a coefficient; as wide as an address, to which it is added.
using Order = std::ptrdiff_t;

union KernelLink;
/// Computes the coefficient of one order of one series (or of two, with the operands of both), and then calls the next
/// kernel, `next->kernel`, with the next operands, as its last act: a jump, where compilers optimise. It costs half of
/// a loop that calls one after another.
using Kernel = void (*)(const KernelOperands* operands, const KernelLink* next, Order order);
union KernelLink {
    Kernel kernel;
    const KernelOperands* operands; ///< behind `KernelTable::next_order`
};

enum class GuardKind : unsigned char { other, exponential, hyperbolic_tangent, power };

/// The argument of a function without singularities, such as exp: how far it may change over a step is bounded.
struct GuardedArgument {
    Series series;
    GuardKind kind;  ///< of its function
    double absolute; ///< bound on its change ...
    double relative; ///< ... and what each unit of its size adds: a high power follows that of the logarithm
    double seen;     ///< size below which a power is nothing beside one
};

/// Intermediate series that say how far others may be followed, whatever their own share of the sums that they enter.
struct Guards {
    const GuardedArgument* arguments;
    std::size_t argument_count;
    const Series* quotients; ///< and roots, which have singularities: they must converge
    std::size_t quotient_count;
};

/// What steps are chosen from.
struct FollowedSeries {
    const Series* series; ///< all of one stride
    std::size_t count;
    const Series* lines; ///< of degree 1: they must only be finite
    std::size_t line_count;
};

/// Series of a jet that may differ from the model at ends of steps.
struct EndComparison {
    const Series* states;
    const std::size_t* state_indices;
    std::size_t state_count;
    const Series* outputs;
    std::size_t output_count;
    int order;
};
/// What they are compared with. Numbers are [state * width + lane].
struct EndValues {
    const double *here, *there;    ///< memories of two jets of one tape, laid out alike
    const double *values, *slopes; ///< of the polynomials of all states in the first
    const EndAllowance& allowance;
};

/// A product in a row of the first variational equations: a series of the motion, times one of what changes by it.
struct TangentTerm {
    std::ptrdiff_t series;     ///< from the jet's first number on; its coefficients are side by side
    std::size_t source;        ///< where the other series is among those of the directions
    int degree, source_degree; ///< above which coefficients are zero
};
/// The row of a state's rate, or of an intermediate quantity that rows behind it are made of.
struct TangentRow {
    std::size_t result; ///< where its series is
    bool is_rate;
    /// In this sequence: coefficients that are constant; sources that are; others of which there are few products; all
    /// others.
    const TangentTerm *fixed, *still, *few, *many, *end;
};
/// Series of changes that are polynomials known to be of a degree up to this are not computed further than that.
inline constexpr int low_degree = 4;
/// Changes in some directions, in lanes: [row][order][lane].
struct TangentOperands {
    /// Those of intermediate quantities first. Rows before `lasting` and from `lasting_end` on are of low degree.
    const TangentRow *begin, *lasting, *lasting_end, *end;
    double* numbers;
};

/// The changes of the states alone, row after row in their sequence.
struct TangentStates {
    const double* numbers;
    std::size_t states, size;                   ///< numbers in a series
    int count, order;                           ///< lanes that are in use
    const std::size_t *followed, *followed_end; ///< those that are no polynomials of low degree
};
/// What these are compared with at the end of a step.
struct TangentEnds {
    const double* there;         ///< as `TangentStates::numbers`, begun there
    const double *sums, *slopes; ///< of the polynomials, [state * width + lane]
    double length, allowed, smallest;
};
/// What is done for directions, as many side by side as fit.
struct TangentKernels {
    int width;
    /// Coefficients of the intermediate quantities from 0 to below this order, and so of the states from 1 to it.
    void (*compute)(const TangentOperands& operands, const double* jet, int order);
    /// As that of KernelTable.
    void (*sums_and_slopes)(const Series* series, const int* degrees, std::size_t count, const double* times,
                            double* values, double* slopes);
    /// The largest share that the last two terms have in their sizes, the latter at least as given.
    /// @param floors [state * width + lane], or null
    double (*tails)(const TangentStates& states, double step, const double* floors);
    /// The first state, from one on, of which a slope differs by more than is allowed; their number if there is none.
    std::size_t (*misfit)(const TangentStates& states, const TangentEnds& ends, std::size_t from);
};
/// What is so small against anything a double can hold that nothing may be said of its relative accuracy.
inline constexpr double smallest_derivative = 1e-200;

/// An entry of a matrix A that is not zero throughout ...
struct ColumnTerm {
    const double* series;
    std::ptrdiff_t degree; ///< above which its coefficients are 0
    std::size_t row;       ///< of what it is multiplied by
};
/// ... all of them row by row, and the columns of a matrix W with W' = A W.
struct ColumnOperands {
    const ColumnTerm* terms;
    const ColumnTerm* const* row_ends; ///< one past the last term of each row
    double* columns;                   ///< series of the entries of W, column by column
    std::size_t rows, count, size;     ///< rows and columns of W; numbers in a series
};

/// What the columns are judged by: [entry * width + lane], entries column by column; [lane]; [row].
struct ColumnEnds {
    const double* there;            ///< like `ColumnOperands::columns`, begun at the ends
    const double *values, *slopes;  ///< of the polynomials at the ends
    const double *lengths, *scales; ///< of the steps; of the rows
    double allowed, smallest;       ///< share of sizes that differences may come to; what is added to sizes
};

/// Linear combinations of fewer terms than this have kernels of their own; row 0 is for all others.
inline constexpr int combination_kernels = 8;

/// Kernels of linear combinations, by number of terms.
struct CombinationKernels {
    Kernel combination[combination_kernels];       ///< for orders above 0
    Kernel combination_value[combination_kernels]; ///< at order 0, where the constant is added
    /// All coefficients from 2 to the order that it is called with.
    Kernel whole_combination[combination_kernels];
    /// Coefficients of a state from a rate that is a linear combination which nothing else needs ...
    Kernel state_combination[combination_kernels];
    Kernel state_combination_value[combination_kernels]; ///< ... for coefficient 1 of the state
};

/// So many numbers there have to be behind the last series.
inline constexpr int read_behind = 8;

struct KernelTable {
    int width; ///< doubles for each number
    /// Row `linear_combination` is empty.
    Kernel series[series_operation_count][highest_order + 1];
    /// Instead of those, where not null, at the last order of a series: nothing is done there for the next.
    Kernel closing[series_operation_count][highest_order + 1];
    CombinationKernels combinations;
    Kernel state;                    ///< coefficients of a state from those of its rate, which is a series
    Kernel multiply_linear;          ///< left operand of degree 1; orders above 0
    Kernel function_of_linear;       ///< y' = a' w, a of degree 1; orders above 0
    Kernel minus_function_of_linear; ///< y' = -a' w
    /// Both at order 0; the cosine goes to `third` (the argument is in `left`).
    Kernel sine_and_cosine;
    /// All coefficients from 2 to the order that they are called with, of an argument of degree 1, found likewise.
    Kernel whole_sine_and_cosine, whole_hyperbolic_pair, whole_exponential;
    /// All coefficients from 2 to the order of the product of two known series, and of one over one; only for one lane,
    /// or null. They may read `read_behind` numbers behind them.
    Kernel whole_product, whole_reciprocal;
    /// Goes on with the next order and the operands found in the link that follows.
    Kernel next_order;
    // Of two steps, one after the other; null where there is no such kernel.
    Kernel two_states;
    /// An operation, and a multiple of its result.
    Kernel with_multiple[series_operation_count][highest_order + 1];
    /// A linear combination of two terms, and its quotient by something.
    Kernel divide_combination[highest_order + 1];
    void (*literal)(double* result, double value);
    void (*sum)(const double* series, int order, const double* times, double* values);
    void (*sums_and_slopes)(const Series* series, const int* degrees, std::size_t count, const double* times,
                            double* values, double* slopes);
    void (*disagreement)(const EndComparison& comparison, const EndValues& ends, const double* lengths, double* worst);
    void (*bound)(const double* series, int order, const double* lengths, double* least, double* sizes);
    void (*steps)(const FollowedSeries& followed, int order, double log_tolerance, const double* references,
                  double* steps);
    /// Shortens steps that are too long for intermediate series: see `guard_kernels.hpp`.
    void (*guard)(const Guards& guards, int order, double* steps);
    /// Coefficients 1 .. highest of the columns from coefficient 0. (Only for ensembles.)
    void (*columns)(const ColumnOperands& operands, Order highest);
    /// The largest share, of all columns, that a column's last two terms have in its first three. (So are these two.)
    void (*column_tails)(const ColumnOperands& operands, Order highest, const double* lengths, const double* scales,
                         double* worst);
    /// By how much columns' slopes differ from their rates at ends of steps, in units of what is allowed; infinity
    /// where something is not finite.
    void (*column_misfit)(const ColumnOperands& operands, const ColumnEnds& ends, double* worst);
    Kernel constant[operation_count]; ///< on numbers; row `number` and `symbol` are empty
};

/// That of an instruction set, which the processor must have.
const KernelTable& kernel_table(LaneKind kind, InstructionSet set);
/// For so many directions, or the most that are worth computing together.
const TangentKernels& tangent_kernels(std::size_t directions, InstructionSet set);

namespace baseline {
const KernelTable& kernels(LaneKind kind);
const TangentKernels& tangent_kernels(std::size_t directions);
} // namespace baseline
namespace avx2 {
const KernelTable& kernels(LaneKind kind);
const TangentKernels& tangent_kernels(std::size_t directions);
} // namespace avx2
namespace avx512 {
const KernelTable& kernels(LaneKind kind);
const TangentKernels& tangent_kernels(std::size_t directions);
} // namespace avx512

} // namespace graze
