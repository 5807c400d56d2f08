#pragma once

#include "graze/layout/device_drawing.hpp"
#include "graze/layout/etched_wall.hpp"

#include <span>
#include <string>
#include <vector>

namespace graze {

/// Two parts that meet when the mass moves far enough along x.
struct FreeWay {
    double way = 0;       ///< um, travel of the mass until they meet, after the etch
    double needed = 0;    ///< um, travel to the stops or the fixed electrode, which the mass must meet first
    bool to_stops = true; ///< false: towards the fixed electrode
    std::string part;     ///< description of the two parts
    GridPoint at;         ///< position on the die, between them
    std::string key;      ///< dimension that determines their distance
};

/// Finds where parts meet when the mass moves along x in either direction, with the trusses moving by their share: of n
/// beams in a row each takes 1/n of the travel. Beams need no check of their own: they are closest to each other at
/// their ends, which belong to these parts. The frame is all that remains of the front besides moving parts, electrode
/// and stops.
/// @param front polygons of mask 2, in coordinates of the die @param depth thickness of moving parts, um
/// @return for each pair of parts and each direction, where they meet first
std::vector<FreeWay> free_ways(const DeviceDrawing& drawing, std::span<const GridPolygon> front, const EtchedWall& wall,
                               double depth);

} // namespace graze
