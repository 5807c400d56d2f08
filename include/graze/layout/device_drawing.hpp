#pragma once

#include "graze/layout/device_file.hpp"
#include "graze/layout/grid_polygon.hpp"

#include <vector>

namespace graze {

/// One of the two flexures, in coordinates of its own: y grows from the edge of the bridge towards the frame, x is that
/// of the H.
struct FlexureDrawing {
    std::vector<GridBox> beams;   ///< from left to right
    std::vector<GridBox> trusses; ///< that join them: near the bridge, the one in the middle first, then near the frame
    GridBox finger;               ///< of the frame, from which the first beams hang, up to the level of the bars' ends
    std::vector<GridBox> lugs;    ///< of the mass: they join the last beams to the bars
    GridBox notch;                ///< all between the bars
    std::vector<GridPolygon> etched; ///< of the notch
};

/// All outlines of one device. The origin is the die's centre, x points along the channel to the edge of the die.
struct DeviceDrawing {
    DeviceDimensions dimensions;
    GridPoint centre; ///< of the H
    FlexureDrawing flexure;
    GridPoint upper, lower; ///< where the flexure's own origin comes; the lower one is mirrored, y pointing down

    GridPolygon mass; ///< the H with its lugs; without trusses and beams
    GridPolygon electrode, base;
    std::vector<GridPolygon> stops;
    std::vector<GridPolygon> etched;   ///< from the front, through (mask 2), without the notches
    std::vector<GridPolygon> chambers; ///< from the back (mask 1)
    GridBox die, chamber_box;          ///< the latter without the channel

    /// Beams and trusses of both flexures in coordinates of the device.
    std::vector<GridBox> beams() const;
    std::vector<GridBox> trusses() const;
    GridBox in_device(const GridBox& of_flexure, bool in_lower) const;
};

/// Draws a device from dimensions that are on the grid. Nothing that is returned is wrong: outlines are closed, do not
/// meet themselves, have no acute angles or accidental steps (edges shorter than half the least dimension), and parts
/// that are not joined are apart.
/// @param file whose places errors name @throws InputError for dimensions that do not go together
DeviceDrawing draw_device(const DeviceDimensions& dimensions, const DeviceFile& file);
inline DeviceDrawing draw_device(const DeviceFile& file) {
    return draw_device(file.device, file);
}

} // namespace graze
