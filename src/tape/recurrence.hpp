#pragma once

#include "graze/tape/tape.hpp"

namespace graze {

/// How the coefficients of a function's series follow from those of its argument a.
enum class Recurrence {
    own,            ///< in a way of its own
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
