#pragma once

#include "graze/orbit/solve.hpp"

#include <Eigen/Core>

#include <optional>
#include <vector>

namespace graze {

class HomoclinicEnds;

/// A homoclinic orbit at the value of a parameter that is solved for.
struct HomoclinicSolution {
    OrbitSolution solution; ///< with the eigenvalues of the saddle; `error` is that of the parameter, over its scale
    double parameter = 0, error = 0; ///< of the parameter: the effect of halving the distances from the saddle
    std::vector<double> saddle;      ///< state of the saddle
    double moved = 0;                ///< largest change from the candidate, relative to the scale of each unknown
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

/// What leads from a long periodic orbit to a homoclinic one.
struct HomoclinicCandidate {
    Orbit orbit;         ///< a first guess: from where the periodic orbit leaves the saddle to where it approaches it
    double distance = 0; ///< at which the periodic orbit passes the saddle, relative to the extent of its states
};
/// Returns the candidate for the homoclinic orbit beside a periodic orbit, from where that is slowest. Half of an orbit
/// with a symmetry leads to a candidate if the saddle is its own image. @return empty where the orbit passes no saddle
std::optional<HomoclinicCandidate> homoclinic_candidate(const System& system, const Orbit& orbit,
                                                        double tolerance);

} // namespace graze
