#pragma once

#include "graze/layout/device_drawing.hpp"
#include "graze/layout/etched_wall.hpp"

#include <span>
#include <string>
#include <vector>

namespace graze {

/// Two parts that meet when the mass moves far enough along x.
struct FreeWay {
    double way = 0;       ///< um, of the mass until they meet, after the etch
    double needed = 0;    ///< um, to the stops or to the fixed electrode: the mass must meet these first
    bool to_stops = true; ///< or else to the fixed electrode
    std::string part;     ///< what meets what, for people
    GridPoint at;         ///< of the die, between them
    std::string key;      ///< dimension between them
};

/// Moves the polygons of the mass along x, both ways, with the trusses by their share of its way: of n beams in a row
/// each takes an n-th. Beams need no look of their own: they are nowhere nearer to each other than at their ends, which
/// these parts are. The frame is what the front's mask leaves besides all that moves, electrode and stops.
/// @param front polygons of mask 2, of the die @param depth um, of what moves
/// @return for each two parts, to each side, where they meet first
std::vector<FreeWay> free_ways(const DeviceDrawing& drawing, std::span<const GridPolygon> front, const EtchedWall& wall,
                               double depth);

} // namespace graze
