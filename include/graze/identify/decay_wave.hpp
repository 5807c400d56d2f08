#pragma once

#include "graze/identify/residual_test.hpp"

namespace graze {

/// An oscillation c + exp(-decay t) (a cos(turn t) + b sin(turn t)) through the samples of a release by least squares.
struct DecayWave {
    double turn = 0, decay = 0;                   ///< in radians, and as a rate, by unit of time
    double turn_variance = 0, decay_variance = 0; ///< squares of standard errors
    double covariance = 0;                        ///< of the two
    double freedom = 0;                           ///< samples less unknowns
    ResidualTest left{};                          ///< whether the samples are such an oscillation
};

} // namespace graze
