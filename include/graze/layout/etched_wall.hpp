#pragma once

namespace graze {

/// The wall that an etch leaves below the edge of a mask. Silicon recedes from the drawn edge by `bias` at the surface,
/// and by `slope` more per unit of depth: a trench is wider than drawn by twice that, a line narrower. With a positive
/// slope trenches widen towards their bottom. Any unit of length.
struct EtchedWall {
    double bias = 0;
    double slope = 0; ///< tangent of the angle from the vertical

    /// Distance of the wall behind the drawn edge at a depth below the surface.
    double recess(double depth) const { return bias + slope * depth; }
    /// Mean of that distance between the surface and a depth.
    double mean_recess(double depth) const { return bias + 0.5 * slope * depth; }
};

/// Width of a line of silicon, or of a trench, after the etch: it changes linearly with depth.
struct EtchedWidth {
    double top = 0, bottom = 0;

    double least() const { return top < bottom ? top : bottom; }
    double greatest() const { return top < bottom ? bottom : top; }
    double mean() const { return 0.5 * (top + bottom); }
    /// Mean of the third power over the depth, which determines bending in the plane.
    double mean_cube() const {
        // Integral of the cube of a linear function, factored to avoid cancellation of fourth powers.
        return 0.25 * (top + bottom) * (top * top + bottom * bottom);
    }
};

/// Returns the width of a line, or a trench, of a drawn width after an etch of a given depth.
inline EtchedWidth etched_line(const EtchedWall& wall, double drawn, double depth) {
    return {drawn - 2 * wall.recess(0), drawn - 2 * wall.recess(depth)};
}
inline EtchedWidth etched_trench(const EtchedWall& wall, double drawn, double depth) {
    return {drawn + 2 * wall.recess(0), drawn + 2 * wall.recess(depth)};
}

} // namespace graze
