#pragma once

#include "picture/box.hpp"
#include "picture/curve.hpp"

#include <optional>
#include <vector>

namespace graze {

/// Places for the names of curves in a plane: for each curve the point of it that lies farthest from other curves, from
/// other names and from the given points; none for a curve that does not lie in the view.
/// @param curves each as lines; those in front choose first
/// @param avoided such as points that have labels of their own
std::vector<std::optional<PlanePoint>> places_of_names(const std::vector<std::vector<Polyline>>& curves,
                                                       const std::vector<PlanePoint>& avoided, const Box& view);

} // namespace graze
