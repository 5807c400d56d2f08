#pragma once

#include <functional>
#include <optional>
#include <span>

namespace graze {

/// Returns the least value of a smooth function around a circle: from the least of its values at equally spaced angles,
/// by parabolas through three angles.
/// @param samples values at the angles 0, 1/n, 2/n, ... turns @param value at any angle; none where it is not known
double least_around(std::span<const double> samples, const std::function<std::optional<double>(double turns)>& value);

} // namespace graze
