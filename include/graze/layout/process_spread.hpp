#pragma once

#include "graze/layout/process_conditions.hpp"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace graze {

/// How one number of the process differs from its nominal value, which it has in the middle of a mean wafer.
struct SpreadParts {
    double wafer = 0;  ///< standard deviation of what a wafer has in common
    double radial = 0; ///< what the edge of each wafer has more than its middle; grows with the square of the distance
    double device = 0; ///< standard deviation of what differs over a wafer
};

struct ProcessSpread {
    SpreadParts bias;       ///< um
    SpreadParts thickness;  ///< um, of what moves
    SpreadParts taper;      ///< deg
    SpreadParts stop_gap;   ///< um, besides what the others make of it
    double correlation = 0; ///< um, over which what differs over a wafer does; 0: from device to device
    bool tuned = false;     ///< whether each device is driven in the nominal proportion to its own frequency

    bool is_empty() const;
};

/// What one device has more than the nominal one.
struct ProcessDeparture {
    double bias = 0, thickness = 0, taper = 0, stop_gap = 0; ///< units as above
};

struct DepartureField {
    const char* name;
    SpreadParts ProcessSpread::*spread;
    double ProcessDeparture::*departure;
    const char* unit;
};
std::span<const DepartureField> departure_fields();

struct SitePlace {
    double x = 0, y = 0; ///< um, from the wafer's middle
};

/// Departures of the devices of a wafer. What differs over it is a normal field with the correlation
/// exp(-(distance/length)^2/2); all depends on the seed, the wafer's number and the sites alone.
/// @throws InputError for more than 2000 sites with a correlation length, whose correlations would have to be factored
std::vector<ProcessDeparture> departures_of(const ProcessSpread& spread, std::span<const SitePlace> sites,
                                            double wafer_radius, std::uint64_t seed, std::size_t wafer);

} // namespace graze
