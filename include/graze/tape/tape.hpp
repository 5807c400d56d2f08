#pragma once

#include "graze/symbolic/expression.hpp"
#include "graze/symbolic/function.hpp"
#include "graze/symbolic/piece_table.hpp"

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <utility>
#include <vector>

namespace graze {

/// An elementary operation on power series in time. Unless said otherwise operands are registers.
enum class SeriesOperation : std::uint8_t {
    /// c + c1 a1 + c2 a2 + ...: left, right: first and one past the last of `Tape::terms`; third: the constant c.
    /// All sums, differences and products with constants are of this kind.
    linear_combination,
    multiply,       ///< left * right
    divide,         ///< left / right
    square,         ///< left^2
    reciprocal,     ///< 1 / left
    sqrt,           ///< of `left`
    power_constant, ///< left^c; right: the constant c, which is not an integer (nor a half-integer) known beforehand
    derivative,     ///< k a_k with a = left: the series of t a'(t)
    // y(a) with y' = a' w (cos: -a' w). left: the `derivative` of a (unused where a has degree 1 or less); right: w,
    // which may be a register computed later, since w_k is not needed for y_k; third: a.
    exp,
    sin,
    cos,
    sinh,
    cosh,
    tan,
    tanh,
    erf,
    // y(a) with y' = a'/w (acos: -a'/w). left: derivative(a) / w; third: a.
    log,
    asin,
    atan,
    acos,
};

struct Instruction {
    SeriesOperation operation = SeriesOperation::linear_combination;
    std::uint32_t result = 0, left = 0, right = 0, third = 0;
};

/// One product of a linear combination.
struct Term {
    std::uint32_t series;      ///< a register
    std::uint32_t coefficient; ///< a constant
};

/// An operation on numbers that do not depend on time (parameters), done once per change of parameters.
struct ConstantInstruction {
    Operation operation;
    std::uint32_t result, left, right;
};

class NativeCodes;

/// Expressions compiled for the computation of Taylor coefficients along the flow of one vector field.
struct Tape {
    std::uint32_t states = 0;     ///< registers 0 .. states-1 are the states
    std::uint32_t parameters = 0; ///< constants 0 .. parameters-1 are the parameters
    std::uint32_t registers = 0;  ///< number of registers, each holds a series
    std::uint32_t constants = 0;  ///< number of constants: parameters, literals, results of `constant_code`
    /// The numbers of a table's piece: constants that a jet sets when it is given states. The knot, which is the
    /// constant at `first`, then the coefficients.
    struct Piece {
        std::shared_ptr<const PieceTable> table;
        std::uint32_t first = 0;
    };
    std::vector<Piece> pieces; ///< their constants follow the parameters
    Function piece_arguments;  ///< where each table is looked up, as a function of states and parameters
    std::vector<std::pair<std::uint32_t, double>> literals; ///< constant, value
    std::vector<ConstantInstruction> constant_code;
    std::vector<Instruction> code;
    std::vector<Term> terms; ///< of the linear combinations
    /// For each register, the degree of the polynomial in time that it is known to be, or `unbounded`: coefficients
    /// above the degree are 0. A phase, whose rate is constant, has degree 1.
    std::vector<std::uint32_t> degrees;
    static constexpr std::uint32_t unbounded = 0xffffffff;
    static constexpr std::uint32_t highest_degree = 4; ///< other than unbounded
    /// Where a rate or output is stored: a register, or a constant (whose higher coefficients are 0).
    struct Location {
        bool constant = false;
        std::uint32_t index = 0;
    };
    std::vector<Location> rates;   ///< one per state
    std::vector<Location> outputs; ///< event functions and other expressions along the flow
    /// Expressions computed from the others only on request; neither states nor outputs depend on them.
    std::vector<Location> deferred;
    /// Instructions for the deferred expressions: of group 0; shared by other groups; then of each other group alone.
    std::vector<std::vector<Instruction>> deferred_code;
    /// The machine code that jets of this tape and of its copies make in long runs; null: none.
    std::shared_ptr<NativeCodes> native_codes;
};

/// A term of the first variational equations of a mode: a coefficient that varies along the motion, times the change of
/// its source.
struct TangentEntry {
    std::size_t row = 0;      ///< intermediate quantities first, then the rates of states
    std::size_t source = 0;   ///< states first, then parameters, then intermediate quantities
    std::size_t deferred = 0; ///< index of the coefficient among the deferred expressions of the mode's tape
};

/// The first variational equations of a mode: the change of each rate with states and parameters, through intermediate
/// quantities where these save products. An intermediate quantity depends only on sources before it.
struct TangentEquations {
    std::size_t states = 0, parameters = 0, intermediates = 0;
    std::vector<TangentEntry> entries; ///< by rising row
};

/// An expression along the flow that is computed only on request, together with the others of its group.
struct DeferredExpression {
    Expression value;
    std::uint32_t group = 0; ///< group 0 is computed before every other group, which may use its results
};

/// Compiles expressions to a tape. Equal subexpressions are computed once, expressions of parameters once per change of
/// parameters, unneeded ones never. Sums are gathered into linear combinations; integer powers become products (finite
/// at 0), other constant powers obey a y' = c a' y (not finite at a = 0, even if c is a parameter with an integer
/// value).
/// @param states, parameters symbols; the expressions may contain no others
/// @param deferred do not affect the code for rates and outputs, bit for bit
/// @throws InputError when an expression contains another symbol
Tape compile_tape(std::span<const Expression> states, std::span<const Expression> parameters,
                  std::span<const Expression> rates, std::span<const Expression> outputs,
                  std::span<const DeferredExpression> deferred = {});

} // namespace graze
