#pragma once

#include "tape/step_finder.hpp"

#include <cstddef>
#include <vector>

namespace graze {

/// A coefficient 0 of a series or a number, by its offset in the memory of a jet.
using Offset = std::ptrdiff_t;
inline constexpr Offset no_offset = -1;

/// What a kernel does at one order, in terms of places instead of addresses, so that code made from it serves
/// all jets of a tape.
struct NativeStep {
    enum class Kind {
        state,             ///< from its rate
        state_combination, ///< from a rate that is a linear combination; at order 1 with its constant, `right`
        combination,       ///< at order 0 with its constant, `right`
        multiply,
        divide,
        square,
        reciprocal,
        square_root,
        function_by_product,
        function_by_quotient,
        function_of_linear,
        multiply_linear,
        derivative,
        pair,        ///< sine and cosine, or the hyperbolic functions, of an argument of degree 1
        exponential, ///< of an argument of degree 1
        other,       ///< by its kernel
    };
    struct Term {
        Offset series, coefficient;
    };
    Kind kind = Kind::other;
    int order = 0;
    bool negative = false;
    Offset result = no_offset, left = no_offset, right = no_offset, third = no_offset;
    std::vector<Term> terms; ///< of combinations
    Kernel kernel = nullptr; ///< of `other`
};

/// Returns the steps of some orders, in a sequence in which each finds its operands.
/// @param memory that of the jet for which the finder was made
std::vector<NativeStep> native_steps(const StepFinder& finder, const KernelTable& table, const double* memory,
                                     int first, int last);

} // namespace graze
