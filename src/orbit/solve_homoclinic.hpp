#pragma once

#include "graze/orbit/solve.hpp"

#include <vector>

namespace graze {

class HomoclinicEnds;

/// A homoclinic orbit at the value of a parameter that is solved for.
struct HomoclinicSolution {
    OrbitSolution solution; ///< with the eigenvalues of the saddle; `error` is that of the parameter, over its scale
    /// The error of the parameter: its change from twice the distances from the saddle, and round-off.
    double parameter = 0, error = 0;
    std::vector<double> saddle; ///< state of the saddle
    double moved = 0;           ///< largest change from the candidate, relative to the scale of each unknown
};

/// Finds the homoclinic orbit near a candidate, and the value of the parameter at which it exists. Where it leaves the
/// saddle and where it approaches it, it lies in the linear spaces (HomoclinicEnds). The error by that shrinks with the
/// distances from the saddle, which are made so small that it is of the order of round-off.
/// @throws InputError when the candidate does not fit the model or the options are out of range
HomoclinicSolution solve_homoclinic(const System& system, const Orbit& candidate, ParameterId parameter,
                                    const OrbitOptions& options = {});

/// True when an orbit should be solved for anew at other distances from its saddle: they are far from those at which
/// its error is of the order of round-off.
bool distances_need_renewal(const HomoclinicEnds& ends);

} // namespace graze
