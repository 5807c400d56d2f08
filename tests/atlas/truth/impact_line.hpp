// The linear oscillator with one stop, x'' + 2 zeta x' + x = F cos(omega t), x <= 1, x' -> -e x', in closed form: all
// orbits of the period of the force with no or one impact (Shaw and Holmes 1983).
//
// Without impact the amplitude is P = F/((1 - omega^2)^2 + 4 zeta^2 omega^2)^(1/2). It touches the stop at P = 1.
// With one impact of speed V in n periods, T = 2 pi n/omega: x = h + P cos(omega t + phi), where h is a free vibration,
// (h, h')(T) = M (h, h')(0). Position and velocity at both ends give h(0) = q V, h'(0) = kappa h(0), with
//   kappa = (1 - M11)/M12, q = (1 + e)/(M21 + (M22 - 1) kappa), and P cos phi = 1 - q V, P omega sin phi = r V, r =
//   kappa q + e.
// So P^2 = (1 - q V)^2 + (r V/omega)^2: two V at most for each F.
//   touch: V = 0.
//   fold:  dP/dV = 0, V = q/(q^2 + r^2/omega^2), for q > 0, that is omega < omega_0 = 2 (1 - zeta^2)^(1/2) for n = 1.
//   flip:  the monodromy matrix is [[-e, 0], [(1 + e) f/V, -e]] M, F cos(phase) - 1 at the impact being
//          f = -omega^2 - ((1 - omega^2) q + 2 zeta r) V. 1 + trace + determinant = 0 is linear in V:
//          V (1 + e^2 E - e trace M - (1 + e) M12 ((1 - omega^2) q + 2 zeta r)) = (1 + e) M12 omega^2,
//          E = exp(-2 zeta T). V > 0 for omega > omega_0.
//   At omega_0 = 1.98997, M12 = 0: an impact without speed does not act on the next pass (VS), and fold and flip end.
//   There are no other points of codimension two. None of these orbits in the box meets the stop a second time: their
//   distance was computed at 1000 points of the period for 80 speeds at each of 25 frequencies.
//
//   omega  touch F      fold F       flip F
//   1.4    1.000000000  0.505405801  -
//   1.6    1.592482339  0.920930912  -
//   1.8    2.268744146  1.778090345  -
//   2.0    3.026549190  -            3.027268192
//   2.2    3.865126130  -            4.307151050
//   2.3    4.314591522  -            5.536033233
//   2.4    4.784140466  -            7.715160147
// The flip leaves the box at omega = 2.409167566, F = 8.
//
// Other attractors in the box, which have longer periods: one impact in 2 periods for omega >= 2.1 and F from 1.6 on
// (`Line` with n = 2 has their folds and flips, but they also touch again), 2 impacts in 2 periods beyond the flip, 2
// in 3 and 2 in 4, and so on; chaos; and long periods with chatter and rest at omega <= 2. Unstable orbits with more
// impacts in one period may exist, too. So the limits are one period and one contact.

#pragma once

#include "known.hpp"

#include <cmath>
#include <numbers>

namespace graze::testing::truth::impact_line {

inline constexpr Box box{"omega", "amplitude", 1.4, 2.6, 0.5, 8, 1};

/// Orbits with one impact in n periods at a frequency.
struct Line {
    double omega, zeta = 0.1, e = 0.7;
    double m12 = 0, trace = 0, damping = 0, q = 0, r = 0, stiffness = 0;

    explicit Line(double frequency, int n = 1) : omega(frequency) {
        const double T = 2 * std::numbers::pi * n / omega, w = std::sqrt(1 - zeta * zeta), decay = std::exp(-zeta * T),
                     c = std::cos(w * T), s = std::sin(w * T) / w;
        const double m11 = decay * (c + zeta * s), m22 = decay * (c - zeta * s), m21 = -decay * s;
        m12 = decay * s;
        trace = m11 + m22;
        damping = decay * decay;
        const double kappa = (1 - m11) / m12;
        q = (1 + e) / (m21 + (m22 - 1) * kappa);
        r = kappa * q + e;
        stiffness = std::hypot(1 - omega * omega, 2 * zeta * omega);
    }
    double force(double speed) const { return stiffness * std::hypot(1 - q * speed, r * speed / omega); }
    double fold_speed() const { return q / (q * q + r * r / (omega * omega)); }
    double flip_speed() const {
        const double push = (1 + e) * m12;
        return push * omega * omega /
               (1 + e * e * damping - e * trace - push * ((1 - omega * omega) * q + 2 * zeta * r));
    }
};

inline std::vector<double> touches(double omega) {
    return {Line(omega).stiffness};
}

inline std::vector<double> folds(double omega) {
    const Line line(omega);
    return line.fold_speed() > 0 ? std::vector{line.force(line.fold_speed())} : std::vector<double>{};
}

inline std::vector<double> flips(double omega) {
    const Line line(omega);
    return line.flip_speed() > 0 ? std::vector{line.force(line.flip_speed())} : std::vector<double>{};
}

inline const std::vector<NamedCurve> curves{{"GR", 1, 0, touches}, {"SN", 1, 1, folds}, {"PD", 1, 1, flips}};

inline std::vector<Joint> joints() {
    const double zeta = 0.1, omega = 2 * std::sqrt(1 - zeta * zeta);
    return {{"VS", 1, omega, std::hypot(1 - omega * omega, 2 * zeta * omega)}};
}

} // namespace graze::testing::truth::impact_line
