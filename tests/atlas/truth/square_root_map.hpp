// The square-root map of a grazing in two dimensions in closed form: all orbits of periods 1 and 2.
//
// In each turn of the clock the probe swings as x + cos(theta) from the phase -pi to pi. It meets the wall at the phase
// -psi where x = wall - cos(psi), 0 < psi < pi, with the speed sin(psi). Then x becomes X = x - k sin(psi), and the
// probe moves away: after the impact its distance is cos(psi) - cos(theta) + (1 + e) sin(psi) (theta + psi), whose
// derivative sin(theta) + (1 + e) sin(psi) is positive if (1 + e) sin(psi) > 1 or psi < pi/2. So a turn has one contact
// at most unless psi > 2.4; orbits of period 1 or 2 with such an x have m beyond both boxes. Without contact, for x <
// wall - 1, X = x. At the phase pi the map acts: x' = a X + y + m, y' = -d X. Along an orbit x_(n+1) = a X_n - d
// X_(n-1) + m. Write g = dX/dx = 1 - k cot(psi); each g has one psi = arccot((1 - g)/k). Turns without contact have g
// = 1.
//
// Period 1, L = a - d: m = x - L X, trace a g, determinant d g.
//   touch: psi = 0, x = X = wall - 1.
//   fold:  g = 1/(a - d).   flip: g = -1/(a + d).   torus: g = 1/d, where |a/d| < 2. In box 1 the torus lies at m > 2.
//   On the touch g is minus infinity: the fold ends there at a = d (DF), the flip at a = -d (DP); at a = 0 the first
//   pass after a contact is not changed (VS). Fold and flip meet at a = 0 (FP).
// Period 2, one contact: (1 + d) x_1 = a X_0 + m for the turn without contact, so that
//   m (1 + a/(1 + d)) = x_0 - (a^2/(1 + d) - d) X_0; trace (a^2 - d) g - d, determinant d^2 g.
//   fold:  g = (1 + d)/(a^2 - d - d^2), from the touch at a^2 = d + d^2.
//   flip:  g = -(1 - d)/(a^2 - d + d^2), from the touch at a^2 = d - d^2. Both meet at a^2 = d (1 - d^2).
//   In all of this a > -d and 0 < psi < 2 M, see below; at psi = 2 M the other turn touches.
// Period 2, two contacts, psi = M - D and M + D, 0 < D < M: the difference of both equations is
//   (1 + a + d) (x_1 - x_0) = (a + d) k (sin psi_1 - sin psi_0), so that tan M = (a + d) k/(1 + a + d) is the same for
//   all; the sum gives m = (1 - L)(wall - cos M cos D) + L k sin M cos D. G = g_0 g_1 and S = g_0 + g_1 are linear in
//   z = sin^2 D over Q = sin^2 M - z: G = 1 + (k^2 (cos^2 M - z) - k sin 2M)/Q, S = 2 - k sin 2M/Q;
//   trace a^2 G - d S, determinant d^2 G. They begin at the flip (D = 0) and end where one turn touches (D = M), the
//   same touch as above.
//   fold:  nowhere but at D = 0. All m are the same where (1 - L) cos M = L k sin M, that is
//          a^2 (1 + k^2) = (1 + d)^2 + d^2 k^2: outside the box.
//   flip:  1 + a^2 G - d S + d^2 G = 0, linear in z; z > sin^2 M in the box, so there is none.
//   torus: d^2 G = 1 has no |trace| < 2 there.
// The touch of period 2 ends at a = -d on that of period 1 (M = 0). Where (1 - g)/k = cot 2M on the fold of period 2,
// that curve ends on it. Neither its flips nor a further contact's effects vanish on it in the box (VS, DF, DP would
// need 1 - k cot 2M = d/a^2, d/(a^2 - d^2), d/(a^2 + d^2); the smallest such a is 0.88).
//
// Box 1, d = 0.3 (m at the touch; fold, flip; at period 2 touch, fold, flip):
//   a      touch   fold         flip         touch 2      fold 2       flip 2
//  -0.5    0.9     0.730228440  -            -            -            -
//  -0.1    0.7     0.643978022  0.653288912  0.672972973  0.664633225  -
//   0.2    0.55    0.545463898  0.574825596  0.63         0.525524814  -
//   0.4    0.45    -            0.555864692  0.615680473  0.439887645  -
//   0.6    0.35    -            0.545809416  0.594343891  0.349821946  0.357907530
//   0.8    0.25    -            0.539087730  0.563167260  -            0.325030100
// Box 2, d = -0.5: touch 0.25 - a/2, and tori, which are all subcritical (their coefficient has no zero):
//   a = -0.4: 0.527807808, -0.2: 0.480790021, 0: 0.433772234, 0.1: 0.410263340. All orbits of period 2, and folds and
//   flips of period 1, have m > 0.9, since a < -d. (At a = 0.4 flips with psi near pi would be in a box up to there.)
//
// Other attractors: in box 1 period 3 with one contact beyond the touch at some a, and none else at 272 points; in box
// 2 periods 3, 4, 5, 7, 10 and chaos between the touch and the tori.

#pragma once

#include "known.hpp"

#include <algorithm>
#include <cmath>

namespace graze::testing::truth::square_root_map {

inline constexpr Box box{"a", "m", -0.7, 0.8, 0, 1.2, 2};
/// The second box: with d = -1/2.
inline constexpr Box torus_box{"a", "m", -0.4, 0.1, 0, 0.9, 2};

/// The map with the default values of k and wall.
struct SquareRootMap {
    double a, d = 0.3, k = 1, wall = 1.5;

    double angle(double g) const { return std::atan2(k, 1 - g); }
    double touch() const { return (1 - a + d) * (wall - 1); }
    /// Returns m of the orbit of period 1 whose contact is at this angle.
    double single(double psi) const { return (1 - a + d) * (wall - std::cos(psi)) + (a - d) * k * std::sin(psi); }

    /// Returns M; of the orbits with a > -d.
    double mean_angle() const { return std::atan((a + d) * k / (1 + a + d)); }
    /// Returns m of the orbit of period 2 one of whose turns has a contact at this angle.
    double alternate(double psi) const {
        const double x = wall - std::cos(psi), moved = x - k * std::sin(psi);
        return (x - (a * a / (1 + d) - d) * moved) / (1 + a / (1 + d));
    }
    double double_touch() const { return alternate(2 * mean_angle()); }
    /// Returns m of the orbit of period 2 with contacts at the angles M - D and M + D.
    double twice(double D) const {
        const double M = mean_angle();
        return (1 - a + d) * (wall - std::cos(M) * std::cos(D)) + (a - d) * k * std::sin(M) * std::cos(D);
    }

    /// Returns m of the orbit of period 2 with one contact whose effect is g, if there is one.
    std::vector<double> alternate_of_effect(double g) const {
        const double psi = angle(g);
        return a > -d && psi > 0 && psi < 2 * mean_angle() ? std::vector{alternate(psi)} : std::vector<double>{};
    }
};

inline std::vector<double> touches(double a) {
    return {SquareRootMap{a}.touch()};
}

/// Beyond a = d the fold lies at m > 1.4, outside the box.
inline std::vector<double> folds(double a) {
    const SquareRootMap map{a};
    return a < map.d ? std::vector{map.single(map.angle(1 / (a - map.d)))} : std::vector<double>{};
}

/// Below a = -d the flip lies at m > 4, outside the box.
inline std::vector<double> flips(double a) {
    const SquareRootMap map{a};
    return a > -map.d ? std::vector{map.single(map.angle(-1 / (a + map.d)))} : std::vector<double>{};
}

inline std::vector<double> double_touches(double a) {
    const SquareRootMap map{a};
    return a > -map.d ? std::vector{map.double_touch()} : std::vector<double>{};
}

inline std::vector<double> double_folds(double a) {
    const SquareRootMap map{a};
    return map.alternate_of_effect((1 + map.d) / (a * a - map.d - map.d * map.d));
}

inline std::vector<double> double_flips(double a) {
    const SquareRootMap map{a};
    return map.alternate_of_effect(-(1 - map.d) / (a * a - map.d + map.d * map.d));
}

/// The contacts of touches do not count the one without speed.
inline const std::vector<NamedCurve> curves{{"GR", 1, 0, touches},      {"SN", 1, 1, folds},
                                            {"PD", 1, 1, flips},        {"GR", 2, 1, double_touches},
                                            {"SN", 2, 1, double_folds}, {"PD", 2, 1, double_flips}};

/// Where the fold of period 2 touches: (1 - g)/k = cot 2M as a function of a, by bisection.
inline double double_fold_at_touch() {
    double low = -0.29, high = 0;
    for (int i = 0; i < 60; ++i) {
        const double a = (low + high) / 2;
        (double_folds(a).empty() ? low : high) = a;
    }
    return high;
}

/// Types are those on the curves of touches; the folds and flips that end there name the same points GR. At a = 0 both
/// states decouple, so that the fold of period 2 passes through FP of period 1.
inline std::vector<Joint> joints() {
    const double d = SquareRootMap{0}.d, fold_end = std::sqrt(d + d * d), flip_end = std::sqrt(d - d * d),
                 meet = std::sqrt(d * (1 - d * d)), touching = double_fold_at_touch();
    return {{"VS", 1, 0, touches(0)[0]},
            {"DF", 1, d, touches(d)[0]},
            {"DP", 1, -d, touches(-d)[0]},
            {"FP", 1, 0, folds(0)[0]},
            {"FP", 2, meet, double_folds(meet)[0]},
            {"GR", 2, fold_end, touches(fold_end)[0]},
            {"GR", 2, flip_end, touches(flip_end)[0]},
            {"SN", 2, touching, double_touches(touching)[0]},
            {"DG", 2, -d, touches(-d)[0]}};
}

inline std::vector<double> torus_box_touches(double a) {
    return {SquareRootMap{a, -0.5}.touch()};
}

inline std::vector<double> torus_box_tori(double a) {
    const SquareRootMap map{a, -0.5};
    return {map.single(map.angle(1 / map.d))};
}

inline const std::vector<NamedCurve> torus_box_curves{{"GR", 1, 0, torus_box_touches}, {"NS", 1, 1, torus_box_tori}};

inline std::vector<Joint> torus_box_joints() {
    return {{"VS", 1, 0, torus_box_touches(0)[0]}, {"R4", 1, 0, torus_box_tori(0)[0]}};
}

} // namespace graze::testing::truth::square_root_map
