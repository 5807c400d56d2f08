#pragma once

namespace graze {

/// The wall that an etch leaves below the edge of a mask. Silicon recedes from the drawn edge by `bias` at the surface,
/// and by `slope` more for each unit of depth: a trench is wider than drawn by twice that, a line narrower. A positive
/// slope makes trenches wider towards their bottom. Any unit of length.
struct EtchedWall {
    double bias = 0;
    double slope = 0; ///< tangent of the angle from the vertical

    /// How far the wall is behind the drawn edge, in a depth below the surface.
    double recess(double depth) const { return bias + slope * depth; }
    /// Its mean between the surface and a depth.
    double mean_recess(double depth) const { return bias + 0.5 * slope * depth; }
};

/// A line of silicon between two trenches that are etched to a depth, or a trench between two walls: its width as drawn
/// becomes another one, which changes linearly with depth.
struct EtchedWidth {
    double top = 0, bottom = 0;

    double least() const { return top < bottom ? top : bottom; }
    double greatest() const { return top < bottom ? bottom : top; }
    double mean() const { return 0.5 * (top + bottom); }
    /// Mean of the third power over the depth: what bending in the plane depends on.
    double mean_cube() const;
};

EtchedWidth etched_line(const EtchedWall& wall, double drawn, double depth);
EtchedWidth etched_trench(const EtchedWall& wall, double drawn, double depth);

} // namespace graze
