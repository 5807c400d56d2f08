#pragma once

#include "graze/layout/process_conditions.hpp"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace graze {

/// Variation of one number of the process about its nominal value.
struct SpreadParts {
    double wafer = 0; ///< standard deviation from wafer to wafer
    /// Systematic excess at the edge of each wafer; proportional to the squared distance from the middle.
    double radial = 0;
    double device = 0; ///< standard deviation within a wafer
};

struct ProcessSpread {
    SpreadParts bias;      ///< um
    SpreadParts thickness; ///< um, of moving parts
    SpreadParts taper;     ///< deg
    SpreadParts stop_gap;  ///< um, in addition to the effect of the other numbers
    /// Correlation length of the variation within a wafer, in um; 0: independent from device to device.
    double correlation = 0;
    bool tuned = false; ///< whether each device is driven at the nominal ratio to its own natural frequency

    bool is_empty() const;
};

/// Deviation of one device from the nominal one.
struct ProcessDeparture {
    double bias = 0, thickness = 0, taper = 0, stop_gap = 0; ///< in the units above
};

struct DepartureField {
    const char* name;
    SpreadParts ProcessSpread::*spread;
    double ProcessDeparture::*departure;
    const char* unit;
};
std::span<const DepartureField> departure_fields();

struct SitePlace {
    double x = 0, y = 0; ///< um, from the centre of the wafer
};

/// Draws the deviations of the devices of a wafer. The variation within a wafer is a normal field with the correlation
/// exp(-(distance/length)^2/2); results depend only on the seed, the wafer's number and the sites.
/// @throws InputError for more than 2000 sites with a correlation length, whose correlation matrix must be factored
std::vector<ProcessDeparture> departures_of(const ProcessSpread& spread, std::span<const SitePlace> sites,
                                            double wafer_radius, std::uint64_t seed, std::size_t wafer);

} // namespace graze
