#pragma once

#include "graze/tape/tape.hpp"

namespace graze {

/// The recurrence for the coefficients of a function's series, given those of its argument a.
enum class Recurrence {
    own,            ///< its own kernel
    product,        ///< y' = a' w
    minus_product,  ///< y' = -a' w
    quotient,       ///< y' = a' / w
    minus_quotient, ///< y' = -a' / w
};
Recurrence recurrence_of(SeriesOperation operation);
constexpr bool is_product(Recurrence recurrence) {
    return recurrence == Recurrence::product || recurrence == Recurrence::minus_product;
}

} // namespace graze
