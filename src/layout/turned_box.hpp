#pragma once

#include "graze/layout/grid_polygon.hpp"

#include <array>

namespace graze {

struct BoxCorner {
    double x = 0, y = 0;
};

/// A box that is rotated about the origin, and moved. Nanometres.
class TurnedBox {
public:
    TurnedBox(const GridBox& box, GridPoint at, double angle);

    const std::array<BoxCorner, 4>& corners() const { return corners_; }
    double reach() const { return reach_; } ///< distance of a corner from the middle
    /// Whether the interiors intersect (separating axis theorem: no side of either separates them).
    bool meets(const TurnedBox& other) const;

private:
    /// Whether another box lies completely beyond one of the sides.
    bool keeps_off(const TurnedBox& other) const;

    std::array<BoxCorner, 4> corners_;
    BoxCorner middle_;
    double reach_ = 0;
};

} // namespace graze
