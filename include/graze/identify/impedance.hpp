#pragma once

#include "graze/identify/estimate.hpp"
#include "graze/identify/residual_test.hpp"
#include "graze/record/harmonic.hpp"

#include <span>

namespace graze {

/// Impedance of a coil under a sinusoidal voltage, with its mass clamped.
struct Impedance {
    double frequency = 0;      ///< w, in radians per unit of time
    Harmonic voltage, current; ///< sines fitted to the channels; phases refer to the middle of the record
    Estimate magnitude;        ///< V0/I0
    Estimate lag;              ///< phase phi by which the current lags, in radians
    Estimate resistance;       ///< R
    Estimate inductance;       ///< total inductance L
    ResidualTest voltage_test{}, current_test{}; ///< tests of whether the channels are sines with random noise
};

/// Estimates the impedance from amplitudes and phases of voltage and current: R = V0/I0 cos(phi), w L = V0/I0 sin(phi),
/// which is Eqs. (5.17) to (5.19) of B. E. Wilcox's dissertation solved for both. Sines with a common frequency are
/// fitted to all samples of both channels by least squares.
/// @param guess initial guess of the frequency, in radians per unit of time; 0: from the spectrum of the voltage
/// @throws InputError when there are fewer than two periods, or no current
Impedance impedance(std::span<const double> times, std::span<const double> voltage, std::span<const double> current,
                    double guess = 0);

/// Returns the leakage inductance L - beta1/(beta2 + d - q), Eq. (5.3), with its error from those of the constants.
/// @throws InputError for an air gap beta2 + d - q that is not positive
Estimate leakage_inductance(const Estimate& inductance, const Estimate& beta1, const Estimate& beta2, double gap,
                            double displacement);

} // namespace graze
