#pragma once

#include "graze/layout/device_file.hpp"
#include "graze/layout/grid_polygon.hpp"

#include <vector>

namespace graze {

/// One of the two flexures, in its own coordinates: y increases from the edge of the bridge towards the frame, x is
/// that of the H.
struct FlexureDrawing {
    std::vector<GridBox> beams; ///< from left to right
    /// Trusses, first those near the bridge (the middle one first), then those near the frame.
    std::vector<GridBox> trusses;
    GridBox finger; ///< part of the frame from which the first beams hang; it ends at the level of the bars' ends
    std::vector<GridBox> lugs;       ///< parts of the mass that join the last beams to the bars
    GridBox notch;                   ///< area between the bars
    std::vector<GridPolygon> etched; ///< trenches within the notch
};

/// All outlines of one device. The origin is the centre of the die; x points along the channel to the edge of the die.
struct DeviceDrawing {
    DeviceDimensions dimensions;
    GridPoint centre; ///< centre of the H
    FlexureDrawing flexure;
    GridPoint upper, lower; ///< positions of the flexures' origins; the lower flexure is mirrored, with y pointing down

    GridPolygon mass; ///< H with its lugs, without trusses and beams
    GridPolygon electrode, base;
    std::vector<GridPolygon> stops;
    std::vector<GridPolygon> etched; ///< trenches etched through from the front (mask 2), without those of the notches
    std::vector<GridPolygon> chambers; ///< chambers etched from the back (mask 1)
    GridBox die, chamber_box;          ///< chamber_box excludes the channel

    /// Beams, and trusses, of both flexures in coordinates of the device.
    std::vector<GridBox> beams() const { return in_both(flexure.beams); }
    std::vector<GridBox> trusses() const { return in_both(flexure.trusses); }
    std::vector<GridBox> in_both(const std::vector<GridBox>& of_flexure) const;
    GridBox in_device(const GridBox& of_flexure, bool in_lower) const;
    /// Whether a point of the device is in a box of either flexure.
    bool has(const GridBox& of_flexure, GridPoint at) const {
        return in_device(of_flexure, false).contains(at) || in_device(of_flexure, true).contains(at);
    }
};

/// Draws a device from dimensions that are on the grid. The result is valid: outlines are closed, do not intersect
/// themselves, have no acute angles or accidental steps (edges shorter than half the least dimension), and parts that
/// are not connected do not touch.
/// @param file gives the places for error messages @throws InputError for inconsistent dimensions
DeviceDrawing draw_device(const DeviceDimensions& dimensions, const DeviceFile& file);
inline DeviceDrawing draw_device(const DeviceFile& file) {
    return draw_device(file.device, file);
}

} // namespace graze
