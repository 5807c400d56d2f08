#pragma once

// The interface of the translation units of instruction sets: tables of kernels. This header may not contain inline
// functions: the linker could keep the copy compiled for a wide instruction set for all translation units.

#include "graze/tape/jet.hpp"
#include "graze/tape/series.hpp"
#include "graze/tape/tape.hpp"
#include "symbolic/function_table.hpp"

#include <cstddef>

namespace graze {

inline constexpr int operation_count = static_cast<int>(last_function) + 1;
inline constexpr int series_operation_count = static_cast<int>(SeriesOperation::acos) + 1;

/// One term of a linear combination.
struct TermOperands {
    const double* series;
    const double* coefficient;
};

/// The series of a kernel. `third` is written by operations that store a reciprocal.
struct KernelOperands {
    double* result;
    const double* left;
    const double* right;
    double* third;
    const TermOperands* terms;
    const TermOperands* terms_end;
};

/// Index of a coefficient; as wide as an address, to which it is added.
using Order = std::ptrdiff_t;

union KernelLink;
/// Computes the coefficient of one order of one series (or of two, with the operands of both), and then calls the next
/// kernel, `next->kernel`, with the next operands. This tail call compiles to a jump, which costs half of a loop that
/// calls one kernel after another.
using Kernel = void (*)(const KernelOperands* operands, const KernelLink* next, Order order);
union KernelLink {
    Kernel kernel;
    const KernelOperands* operands; ///< follows the link of `KernelTable::next_order`
    Order shift;                    ///< follows the link of `KernelTable::shift_order`
};

enum class GuardKind : unsigned char { other, exponential, hyperbolic_tangent, power };

/// The argument of a function without singularities, such as exp, whose change over a step is bounded.
struct GuardedArgument {
    Series series;
    GuardKind kind;  ///< kind of its function
    double absolute; ///< bound on its change is absolute + relative * size ...
    double relative; ///< ... since a high power depends on the change of the logarithm
    double seen;     ///< size below which a power is lost in a sum with 1
};

/// Intermediate series that limit the step, whatever their share of the sums that contain them.
struct Guards {
    const GuardedArgument* arguments;
    std::size_t argument_count;
    const Series* quotients; ///< quotients and roots: have singularities, so their series must converge
    std::size_t quotient_count;
};

/// The series from which steps are chosen.
struct FollowedSeries {
    const Series* series; ///< all of the same stride
    std::size_t count;
    const Series* lines; ///< series of degree 1: only checked to be finite
    std::size_t line_count;
};

/// The series of a jet that are compared with the model at ends of steps.
struct EndComparison {
    const Series* states;
    const std::size_t* state_indices;
    std::size_t state_count;
    const Series* outputs;
    std::size_t output_count;
    int order;
};
/// The values to compare. Layout [state * width + lane].
struct EndValues {
    const double *here, *there;    ///< memories of two jets of one tape, with equal layout
    const double *values, *slopes; ///< values and slopes of all states' polynomials, from the first jet
    const EndAllowance& allowance;
};

/// A term in a row of the first variational equations: a series of the motion times the series of a source's change.
struct TangentTerm {
    std::ptrdiff_t series;     ///< offset in the jet's memory; its coefficients are contiguous
    std::size_t source;        ///< offset of the source's series in the memory of the directions
    int degree, source_degree; ///< coefficients above these degrees are zero
};
/// The row of a state's rate, or of an intermediate quantity used by later rows.
struct TangentRow {
    std::size_t result; ///< offset of its series
    bool is_rate;
    /// Terms in this order: constant coefficients; constant sources; other terms with few products (one factor is a
    /// polynomial of low degree); terms with all products.
    const TangentTerm *fixed, *still, *few, *many, *end;
};
/// Changes that are polynomials in time of at most this degree are computed only up to it.
inline constexpr int low_degree = 4;
/// Changes in several directions (lanes): [row][order][lane].
struct TangentOperands {
    /// Rows of intermediate quantities come first. Rows before `lasting` and from `lasting_end` on are of low degree.
    const TangentRow *begin, *lasting, *lasting_end, *end;
    double* numbers;
};

/// The changes of the states, row after row.
struct TangentStates {
    const double* numbers;
    std::size_t states, size;                   ///< numbers in a series
    int count, order;                           ///< number of lanes in use; order of the series
    const std::size_t *followed, *followed_end; ///< states whose changes are not polynomials of low degree
};
/// The data at the end of a step, for comparison.
struct TangentEnds {
    const double* there;         ///< like `TangentStates::numbers`, with coefficients 0 and 1 at the end
    const double *sums, *slopes; ///< of the polynomials, [state * width + lane]
    double length, allowed, smallest;
};
/// Kernels for directions, as many side by side as fit into registers.
struct TangentKernels {
    int width;
    /// Computes coefficients 0 .. order - 1 of the intermediate quantities, and 1 .. order of the states.
    void (*compute)(const TangentOperands& operands, const double* jet, int order);
    /// Like KernelTable::sums_and_slopes.
    void (*sums_and_slopes)(const Series* series, const int* degrees, std::size_t count, const double* times,
                            double* values, double* slopes);
    /// Returns the largest ratio of the last two terms to the size of a series.
    /// @param floors [state * width + lane] lower bounds of the sizes, or null
    double (*tails)(const TangentStates& states, double step, const double* floors);
    /// Returns the first state, from `from` on, with a slope whose difference exceeds the allowance; or the number of
    /// states.
    std::size_t (*misfit)(const TangentStates& states, const TangentEnds& ends, std::size_t from);
};
/// Numbers below this size have no meaningful relative accuracy in sums of derivatives.
inline constexpr double smallest_derivative = 1e-200;

/// An entry of a matrix A that is not identically zero.
struct ColumnTerm {
    const double* series;
    std::ptrdiff_t degree; ///< its coefficients above this are 0
    std::size_t row;       ///< row of W by which it is multiplied
};
/// All entries row by row, and the columns of a matrix W with W' = A W.
struct ColumnOperands {
    const ColumnTerm* terms;
    const ColumnTerm* const* row_ends; ///< one past the last term of each row
    double* columns;                   ///< series of the entries of W, column by column
    std::size_t rows, count, size;     ///< rows and columns of W; numbers in a series
};

/// The data at the ends of steps, for comparison: [entry * width + lane], entries column by column; [lane]; [row].
struct ColumnEnds {
    const double* there;            ///< like `ColumnOperands::columns`, with coefficients 0 and 1 at the ends
    const double *values, *slopes;  ///< values and slopes of the polynomials at the ends
    const double *lengths, *scales; ///< step lengths; units of the rows
    double allowed, smallest;       ///< tolerance relative to sizes; added to each size
};

/// Linear combinations of fewer terms than this have specialised kernels; row 0 is for all others.
inline constexpr int combination_kernels = 8;

/// Kernels of linear combinations, by number of terms.
struct CombinationKernels {
    Kernel combination[combination_kernels];       ///< for orders above 0
    Kernel combination_value[combination_kernels]; ///< at order 0, where the constant is added
    /// All coefficients from 2 to the given order.
    Kernel whole_combination[combination_kernels];
    /// Coefficients of a state whose rate is a linear combination that is used nowhere else.
    Kernel state_combination[combination_kernels];
    Kernel state_combination_value[combination_kernels]; ///< the same for coefficient 1 of the state
};

/// Number of doubles that must be readable after the last series.
inline constexpr int read_behind = 8;

struct KernelTable {
    int width; ///< number of lanes
    /// Row `linear_combination` is empty.
    Kernel series[series_operation_count][highest_order + 1];
    /// Used at the last order of a series where not null: they prepare nothing for the next order.
    Kernel closing[series_operation_count][highest_order + 1];
    CombinationKernels combinations;
    Kernel state;                    ///< coefficients of a state from those of its rate, which is a series
    Kernel multiply_linear;          ///< left operand of degree 1; orders above 0
    Kernel function_of_linear;       ///< y' = a' w, a of degree 1; orders above 0
    Kernel minus_function_of_linear; ///< y' = -a' w
    /// Sine and cosine at order 0; the cosine goes to `third` (the argument is in `left`).
    Kernel sine_and_cosine;
    /// All coefficients from 2 to the given order, for an argument of degree 1; operands as for `sine_and_cosine`.
    Kernel whole_sine_and_cosine, whole_hyperbolic_pair, whole_exponential;
    /// All coefficients from 2 to the given order of a product of two known series, and of a reciprocal; null if there
    /// are several lanes. They may read `read_behind` numbers beyond the series.
    Kernel whole_product, whole_reciprocal;
    /// Continues with the next order and the operands in the following link.
    Kernel next_order;
    /// Adds the shift in the following link to the order.
    Kernel shift_order;
    // Two steps in one; null where there is no such kernel.
    Kernel two_states;
    /// An operation, followed by a multiple of its result.
    Kernel with_multiple[series_operation_count][highest_order + 1];
    /// A linear combination of two terms, followed by its quotient by a series.
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
    /// Computes coefficients 1 .. highest of the columns from coefficient 0. (Ensembles only, as are the next two.)
    void (*columns)(const ColumnOperands& operands, Order highest);
    /// Returns per lane the largest ratio, over all columns, of the last two terms to the column's first three.
    void (*column_tails)(const ColumnOperands& operands, Order highest, const double* lengths, const double* scales,
                         double* worst);
    /// Returns per lane by how much columns' slopes differ from their rates at ends of steps, relative to the
    /// allowance; infinity where a number is not finite.
    void (*column_misfit)(const ColumnOperands& operands, const ColumnEnds& ends, double* worst);
    Kernel constant[operation_count]; ///< operations on constants; rows `number` and `symbol` are empty
};

/// Returns the table of an instruction set, which the processor must support.
const KernelTable& kernel_table(LaneKind kind, InstructionSet set);
/// Returns the kernels for this number of directions, or for the largest number that is worth computing together.
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
