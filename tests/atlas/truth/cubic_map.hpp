// The cubic map X -> f(X) = a X - X^3 + b in closed form: all orbits of periods 1 and 2.
//
// Fixed points X: b = X (1 - a + X^2), multiplier f' = a - 3 X^2.
//   fold: f' = 1, so X^2 = (a - 1)/3, 27 b^2 = 4 (a - 1)^3. Both folds meet in the cusp a = 1, b = 0.
//   flip: f' = -1, so X^2 = (a + 1)/3, 27 b^2 = 4 (a + 1) (2 - a)^2. Degenerate where f''^2/2 + f'''/3 = 18 X^2 - 2 =
//   0,
//         that is X^2 = 1/9, a = -2/3, b = +-16/27. The curve turns in a at a = -1, b = 0 and in b at a = 0.
// Orbits X, Y of period 2, s = X + Y, p = X Y: the difference of both equations gives p = s^2 - a - 1, the sum
//   b = (a + 2) s - s^3; X and Y are real and differ if s^2 > 4 p, that is 3 s^2 < 4 (a + 1).
//   Multiplier (a - 3 X^2)(a - 3 Y^2) = a^2 - 3 a (a + 1 - p) + 9 p^2.
//   fold: db/ds = 0, so 27 b^2 = 4 (a + 2)^3, real for a > -2/3: the curve ends at the degenerate flips.
//   flip: 9 p^2 + 3 a p - 2 a^2 - 3 a + 1 = 0, so p = (-a +- w)/6 with w^2 = 9 a^2 + 12 a - 4, and s^2 = p + a + 1;
//   always
//         real. The curve turns in a where w = 0, a = (8^(1/2) - 2)/3. It has no degenerate flip: the Schwarzian
//         derivative of the second iterate vanishes with the multiplier -1 only if (q^2 + 3 q)^2 + 2 q + 10 = 0 for a
//         real q.
// Flips of two orbits cross at a = 2, b = 0, outside the box. Everything is symmetric in b (X -> -X); for b = 0 exactly
// the cusp is a branch point.
//
//   a      fold b     flip b     fold of period 2   flips of period 2
//  -1.0    -          0          -                  -
//  -0.5    -          0.680414   0.707107           -
//   0.5    -          0.707107   (1.521452)         0.981450, 1.478142
//   1.0    0          0.544331   (2)                0.761233, (1.984702)
//   1.5    0.136083   0.304290   (2.520288)         0.493179, (2.512435)
// (in parentheses: outside the box)
//
// Other attractors: for large |b|, and for a < -1, motions are unbounded. Beyond the flips of period 2 there are
// periods 4, 8, ..., chaos, and windows of longer periods. None of these is an orbit of a period up to 2.

#pragma once

#include "known.hpp"

#include <algorithm>
#include <cmath>

namespace graze::testing::truth::cubic_map {

inline constexpr Box box{"a", "b", -1.4, 1.9, -1.5, 1.5, 2};

inline std::vector<double> both_signs(double b) {
    if (b == 0)
        return {0};
    return {-std::abs(b), std::abs(b)};
}

inline std::vector<double> folds(double a) {
    if (a < 1)
        return {};
    return both_signs(2 * std::pow((a - 1) / 3, 1.5));
}

inline std::vector<double> flips(double a) {
    if (a < -1)
        return {};
    return both_signs(2 * (2 - a) / 3 * std::sqrt((a + 1) / 3));
}

inline std::vector<double> double_folds(double a) {
    if (a < -2. / 3)
        return {};
    return both_signs(2 * std::pow((a + 2) / 3, 1.5));
}

inline std::vector<double> double_flips(double a) {
    const double square = 9 * a * a + 12 * a - 4;
    if (square < 0 || a < 0)
        return {};
    std::vector<double> found;
    for (const double w : {-std::sqrt(square), std::sqrt(square)}) {
        const double s = std::sqrt((-a + w) / 6 + a + 1);
        for (const double b : both_signs((a + 2) * s - s * s * s))
            found.push_back(b);
    }
    std::sort(found.begin(), found.end());
    return found;
}

inline const std::vector<NamedCurve> curves{
    {"SN", 1, 0, folds}, {"PD", 1, 0, flips}, {"SN", 2, 0, double_folds}, {"PD", 2, 0, double_flips}};

/// Both curves of folds of period 2 end in GF.
inline std::vector<Joint> joints() {
    const double turn = (std::sqrt(8.) - 2) / 3, s = std::sqrt(1 + 5 * turn / 6), b = (turn + 2) * s - s * s * s,
                 highest = 4 / std::sqrt(27.);
    return {{"CP", 1, 1, 0},    {"GF", 1, -2. / 3, 16. / 27}, {"GF", 1, -2. / 3, -16. / 27},
            {"EX", 1, -1, 0},   {"EX", 1, 0, highest},        {"EX", 1, 0, -highest},
            {"EX", 2, turn, b}, {"EX", 2, turn, -b}};
}

} // namespace graze::testing::truth::cubic_map
