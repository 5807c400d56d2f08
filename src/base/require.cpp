#include "graze/base/require.hpp"

#include "graze/base/input_error.hpp"

#include <fmt/format.h>

#include <cmath>

namespace graze {

namespace require_detail {

void refuse_size(std::size_t given, std::size_t needed, std::string_view what) {
    throw InputError(fmt::format("{} {} were given where {} are needed", given, what, needed),
                     fmt::format("give {}", needed));
}

void refuse_index(std::size_t index, std::size_t size, std::string_view what) {
    if (size == 0)
        throw InputError(fmt::format("there is no {} {}: there are none", what, index), "");
    throw InputError(fmt::format("there is no {} {}", what, index),
                     fmt::format("give 0 to {}: they are counted from 0", size - 1));
}

void refuse_value(double value, std::string_view what) {
    throw InputError(fmt::format("{} is {}", what, value), "give a finite number");
}

void refuse_nothing(std::string_view what) {
    throw InputError(fmt::format("{} is needed, and none is given", what), fmt::format("give {}", what));
}

} // namespace require_detail

void require_finite(double value, std::string_view what) {
    if (!std::isfinite(value))
        require_detail::refuse_value(value, what);
}

void require_finite(std::span<const double> values, std::string_view what) {
    for (const double value : values)
        require_finite(value, what);
}

} // namespace graze
