#include "graze/layout/plate_attraction.hpp"

#include "layout/require_size.hpp"

#include <cmath>
#include <numbers>

namespace graze {

namespace {

/// Increase of the effective extent of the plates by the fringe field.
double fringe(double gap, double backing) {
    return gap / std::numbers::pi * (1 + std::sqrt(backing / (gap + backing)));
}

} // namespace

EquivalentPlates equivalent_plates(const FacingPlates& plates) {
    require_positive(plates.length, "length of the electrode");
    require_positive(plates.height, "height of the electrode");
    require_not_negative(plates.backing, "depth of the electrode behind the gap");
    require_positive(plates.gap, "gap of the electrodes after the etch");
    const double top = plates.gap.top, bottom = plates.gap.bottom;
    const double gap = 2 * top * (bottom / (top + bottom));
    // A/d^2 = (height)(length)/(g0 g1)
    const double steeper = gap / top * (gap / bottom), edge = fringe(gap, plates.backing);
    return {steeper * (plates.height + edge) * (plates.length + edge), gap};
}

double capacitance_by_length(double height, double gap, double backing) {
    require_positive(height, "height of the electrode");
    require_positive(gap, "gap of the electrodes");
    require_not_negative(backing, "depth of the electrode behind the gap");
    const double straight = height / gap, behind = backing / gap;
    return straight + (1 + std::log(2 * std::numbers::pi * straight) +
                       std::log1p(2 * behind + 2 * std::sqrt(behind + behind * behind))) /
                          std::numbers::pi;
}

} // namespace graze
