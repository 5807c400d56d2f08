#pragma once

#include "graze/symbolic/expression.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace graze {

/// An elementary operation on power series in time. "c" marks an operand that does not depend on time.
enum class SeriesOperation : std::uint8_t {
    add,               ///< a + b
    subtract,          ///< a - b
    multiply,          ///< a b
    divide,            ///< a / b
    square,            ///< a^2
    negate,            ///< -a
    add_constant,      ///< a + c
    subtract_constant, ///< a - c
    constant_subtract, ///< c - a
    multiply_constant, ///< a c
    divide_constant,   ///< a / c
    constant_divide,   ///< c / a
    sqrt,
    power_constant, ///< a^c, c not an integer
    derivative,     ///< k a_k: the series of t a'(t)
    // y' = a' w with w already a register; operands: derivative of a, w, and a for the value at order 0.
    exp,
    sin,
    cos,
    sinh,
    cosh,
    tan,
    tanh,
    // y' = a'/w; operands likewise.
    log,
    asin,
    acos,
    atan,
};

struct Instruction {
    SeriesOperation operation;
    std::uint32_t result, left, right, third; ///< registers (or constants, for operands marked c)
};

/// An operation on numbers that do not depend on time (parameters), done once per change of parameters.
struct ConstantInstruction {
    Operation operation;
    std::uint32_t result, left, right;
};

/// Expressions compiled for the computation of Taylor coefficients along the flow of one vector field.
struct Tape {
    std::uint32_t states = 0;     ///< registers 0 .. states-1 are the states
    std::uint32_t parameters = 0; ///< constants 0 .. parameters-1 are the parameters
    std::uint32_t registers = 0;  ///< series
    std::uint32_t constants = 0;  ///< numbers: parameters, literals, results of `constant_code`
    std::vector<std::pair<std::uint32_t, double>> literals; ///< constant, value
    std::vector<ConstantInstruction> constant_code;
    std::vector<Instruction> code;
    /// Where a rate or output is found: in a register, or in a constant (then its higher coefficients are 0).
    struct Location {
        bool constant = false;
        std::uint32_t index = 0;
    };
    std::vector<Location> rates;   ///< one per state
    std::vector<Location> outputs; ///< event functions and whatever else is wanted along the flow
};

/// @param states, parameters symbols; rates and outputs may contain no others
/// @throws std::invalid_argument when they do
Tape compile_tape(std::span<const Expression> states, std::span<const Expression> parameters,
                  std::span<const Expression> rates, std::span<const Expression> outputs);

} // namespace graze
