#pragma once

#include "graze/record/period.hpp"

#include <cstddef>
#include <vector>

namespace graze {

/// What was recorded at one phase of a period.
struct SectionPoint {
    std::size_t period = 0; ///< its number
    double phase = 0;       ///< part of the period, from 0 to 1
    double time = 0;
    std::vector<double> values; ///< of all channels
    bool image = false;         ///< whether it is the symmetric image of what was recorded
};

/// All channels at a part of the period, between samples by interpolate.
/// @param phase from 0 to 1. @throws InputError when it is not
SectionPoint section(const Period& period, double phase);

/// A symmetry of what is recorded: the motion that another one becomes when some channels change their sign and a part
/// of the period passes. Of the electromagnetic testbed it is the current, and half a period (Eq. (5.11) of B. E.
/// Wilcox's dissertation).
struct RecordSymmetry {
    std::vector<std::size_t> negated; ///< channels
    double shift = 0.5;               ///< part of the period
};

/// The image of what was recorded at a phase: signs change, and it belongs to a phase that is by the shift earlier.
/// What was recorded half a period after the section therefore becomes a point of the section.
/// @throws InputError when there is no such channel
SectionPoint image_of(const SectionPoint& point, const RecordSymmetry& symmetry);
/// The point of a section that is an image: of what was recorded later by the shift. @throws InputError likewise
SectionPoint image_section(const Period& period, double phase, const RecordSymmetry& symmetry);

} // namespace graze
