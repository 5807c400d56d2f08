#pragma once

namespace graze {

/// The distances from a saddle, or from a saddle cycle, at which a homoclinic orbit begins and ends, in units of the
/// scales of its states.
struct EndDistances {
    double departure = 0, approach = 0;
};

/// Returns the distances at which it is known to round-off that the orbit begins in the linear unstable space and ends
/// in the linear stable one. @param growth, decay rates of the slowest growth and decay beside the saddle
/// @param effect what the curvature of the spaces may change, to leading order
EndDistances wanted_distances(double growth, double decay, double effect = 1e-13);

} // namespace graze
