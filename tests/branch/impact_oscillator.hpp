// The linear impact oscillator with one impact per period of its force, in closed form.

#pragma once

#include "follow.hpp"

#include <cmath>
#include <numbers>

namespace graze::testing {

/// One impact per period of the force, or per several periods, of x'' + 2 zeta x' + x = cos(omega t) at a stop sigma,
/// in closed form (Shaw and Holmes 1983): see the test of `solve_orbit`. Here sigma follows from the velocity before
/// the impact.
struct Oscillator {
    double zeta = 0.05, omega, e = 0.7;
    double a = 0, b = 0, k = 0, radius = 0, decay = 0, c = 0, s = 0, d = 0, in_phase = 0, out_of_phase = 0;

    explicit Oscillator(double at = 2.4, double periods = 1) : omega(at) {
        const double T = 2 * std::numbers::pi * periods / omega;
        d = std::sqrt(1 - zeta * zeta);
        decay = std::exp(-zeta * T);
        c = std::cos(d * T);
        s = std::sin(d * T);
        const double denominator = (1 - omega * omega) * (1 - omega * omega) + 4 * zeta * zeta * omega * omega;
        in_phase = (1 - omega * omega) / denominator;
        out_of_phase = 2 * zeta * omega / denominator;
        radius = std::hypot(in_phase, out_of_phase);
        const double m11 = decay * (c + zeta / d * s), m12 = decay * s / d, m21 = -m12,
                     m22 = decay * (c - zeta / d * s);
        a = m12 / (1 - m11);
        b = (1 - m22 - m21 * a) * e / (1 + e);
        k = (b - 1) / omega;
    }
    /// Returns the stop at which an orbit with this velocity after the impact exists.
    double sigma(double after, bool upper) const {
        const double z = after / b;
        return a * z + (upper ? 1 : -1) * std::sqrt(radius * radius - k * k * z * z);
    }
    /// Returns sigma at the fold, where its derivative with respect to the velocity is zero.
    double fold(bool upper) const { return (upper ? 1 : -1) * radius * std::hypot(a, k) / std::abs(k); }
    double product() const { return e * e * decay * decay; }
    double trace(double after, double phase, double stop) const {
        const double before = -after / e, force = std::cos(phase) - stop;
        return -2 * e * decay * c +
               (e * (force - 2 * zeta * before) + force - 2 * zeta * after) / before * decay * s / d;
    }
    double phase(double after, double stop) const {
        const double z = after / b, p = stop - a * z, q = k * z;
        return std::atan2(out_of_phase * p - in_phase * q, in_phase * p + out_of_phase * q);
    }
};

inline Model oscillator_model(const Oscillator& known, double sigma) {
    return shipped_with("impact-oscillator",
                        {{"zeta", known.zeta}, {"omega", known.omega}, {"e", known.e}, {"sigma", sigma}});
}

} // namespace graze::testing
