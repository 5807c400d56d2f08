#pragma once

#include "graze/identify/residual_test.hpp"

namespace graze {

/// A damped sine c + exp(-decay t) (a cos(turn t) + b sin(turn t)), fitted by least squares to the samples of a
/// release.
struct DecayWave {
    double turn = 0, decay = 0; ///< angular frequency of the damped oscillation, and decay rate, per unit of time
    double turn_variance = 0, decay_variance = 0; ///< squared standard errors of `turn` and `decay`
    double covariance = 0;                        ///< covariance of `turn` and `decay`
    double freedom = 0;                           ///< degrees of freedom: samples less unknowns
    ResidualTest residual_test{};                 ///< test of whether the samples are a damped sine with random noise
};

} // namespace graze
