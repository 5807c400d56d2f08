// A driven oscillator with a stop, in any units, with a closed form of the force at which its steady motion touches.

#pragma once

#include "follow.hpp"

#include <array>
#include <cmath>
#include <complex>
#include <numbers>

namespace graze::testing {

/// m q'' + c q' + k q = F cos(omega t) with a stop at q = sigma; units of length, time and mass.
struct DrivenOscillator {
    double length = 1, time = 1, mass = 1;
    double m = 1.3 * mass, c = 0.2 * mass / time, k = 2.1 * mass / (time * time), omega = 1.7 / time,
           sigma = 0.8 * length;

    /// F for the unit of the amplitude.
    std::complex<double> stiffness() const { return {k - m * omega * omega, c * omega}; }
    double force() const { return sigma * std::abs(stiffness()); }
    /// Returns the derivatives of the force with respect to m, c, k, omega, sigma, e.
    std::array<double, 6> derivatives() const {
        const double size = std::abs(stiffness()), real = stiffness().real(), imaginary = stiffness().imag();
        return {-sigma * real * omega * omega / size,
                sigma * imaginary * omega / size,
                sigma * real / size,
                sigma * (-2 * real * m * omega + imaginary * c) / size,
                size,
                0};
    }
    Model model() const {
        return OneMode{
            .parameters = fmt::format(
                "F = {:.17g}\nm = {:.17g}\nc = {:.17g}\nk = {:.17g}\nomega = {:.17g}\nsigma = {:.17g}\ne = 0.8",
                force(), m, c, k, omega, sigma),
            .states = "q = 0\nv = 0",
            .rates = "q = 'v', v = '(F*cos(theta) - c*v - k*q)/m'",
            .clock = "omega",
            .stops = {{"stop", "sigma - q", "v = '-e*v'", "impact"}}}
            .model();
    }
    /// Returns the touching motion.
    SpecialPoint grazing(const Model& made) const {
        const std::complex<double> amplitude = force() / stiffness(), i(0, 1);
        const double turn = 2 * std::numbers::pi, phase = std::fmod(turn - std::arg(amplitude), turn);
        SpecialPoint point;
        point.type = PointType::grazing;
        point.solution.orbit =
            given_orbit(made, "free:start", {{amplitude.real(), (i * omega * amplitude).real(), 0}}, {turn / omega});
        point.parameter = force();
        point.time = phase / omega;
        return point;
    }
};

} // namespace graze::testing
