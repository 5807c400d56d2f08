#pragma once

#include "graze/record/period.hpp"

#include <cstddef>
#include <vector>

namespace graze {

/// Values of all channels at one phase of a period.
struct SectionPoint {
    std::size_t period = 0; ///< number of the period
    double phase = 0;       ///< part of the period, from 0 to 1
    double time = 0;
    std::vector<double> values; ///< values of all channels
    bool image = false;         ///< whether it is the symmetric image of a recorded point
};

/// Returns all channels at a phase of a period, interpolated between samples (see interpolate).
/// @param phase from 0 to 1. @throws InputError when it is not
SectionPoint section(const Period& period, double phase);

/// A symmetry of the recorded motion: another motion results when some channels change their sign and the phase is
/// shifted. For the electromagnetic testbed it is the current, and half a period (Eq. (5.11) of B. E. Wilcox's
/// dissertation).
struct RecordSymmetry {
    std::vector<std::size_t> negated; ///< channels that change their sign
    double shift = 0.5;               ///< shift of the phase, as a part of the period
};

/// Returns the symmetric image of a point: signs change, and its phase is earlier by the shift. With a shift of half a
/// period, a point recorded half a period after the section thus becomes a point of the section.
/// @throws InputError when there is no such channel
SectionPoint image_of(const SectionPoint& point, const RecordSymmetry& symmetry);
/// Returns the point of a section that is the image of the one recorded later by the shift. @throws InputError likewise
SectionPoint image_section(const Period& period, double phase, const RecordSymmetry& symmetry);

} // namespace graze
