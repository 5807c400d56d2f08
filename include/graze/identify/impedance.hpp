#pragma once

#include "graze/identify/estimate.hpp"
#include "graze/identify/residual_test.hpp"
#include "graze/record/harmonic.hpp"

#include <span>

namespace graze {

/// A coil with its mass clamped, under a sinusoidal voltage.
struct Impedance {
    double frequency = 0;                        ///< w, in radians by unit of time
    Harmonic voltage, current;                   ///< about the middle of the record
    Estimate magnitude;                          ///< V0/I0
    Estimate lag;                                ///< phi, in radians
    Estimate resistance;                         ///< R
    Estimate inductance;                         ///< L, all of it
    ResidualTest voltage_left{}, current_left{}; ///< whether they are sines
};

/// From amplitudes and phase of voltage and current: R = V0/I0 cos(phi), w L = V0/I0 sin(phi), which is Eqs. (5.17) to
/// (5.19) of B. E. Wilcox's dissertation solved for both. All samples tell them, by least squares, at the frequency
/// that both channels have together.
/// @param guess of the frequency, in radians by unit of time; 0: from the crossings of the voltage's mean
/// @throws InputError when there are less than two periods, or no current
Impedance impedance(std::span<const double> times, std::span<const double> voltage, std::span<const double> current,
                    double guess = 0);

/// Ll = L - beta1/(beta2 + d - q), Eq. (5.3), with the errors of the constants.
Estimate leakage_inductance(const Estimate& inductance, const Estimate& beta1, const Estimate& beta2, double gap,
                            double displacement);

} // namespace graze
