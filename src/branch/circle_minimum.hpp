#pragma once

#include <functional>
#include <optional>
#include <span>

namespace graze {

/// Returns the least value of a continuous function around a circle, from the low ones of its values at equally spaced
/// angles. Its rate may be discontinuous.
/// @param samples values at the angles 0, 1/n, 2/n, ... turns; infinite where there is none
/// @param value at any angle; none: stops the search
double least_around(std::span<const double> samples, const std::function<std::optional<double>(double turns)>& value);

} // namespace graze
