// The generalised Henon map (X, Y) -> (Y, alpha - beta X - Y^2 + R X Y) in closed form, R = -1/2: all orbits of periods
// 1 and 2, with their tori.
//
// Fixed points X = Y: alpha = (1 + beta) X + (1 - R) X^2; trace (R - 2) X, determinant beta - R X.
//   fold:  1 - trace + determinant = 0, X = -(1 + beta)/(2 - 2 R), alpha = -(1 + beta)^2/(4 - 4 R).
//   flip:  1 + trace + determinant = 0, X = (1 + beta)/2, alpha = (3 - R)(1 + beta)^2/4.
//   torus: determinant = 1, X = (beta - 1)/R, with |trace| < 2. Its resonances have trace 2, -2, -1, 0.
//   Fold and flip meet at beta = -1, alpha = 0, where the trace is 0 and the determinant -1. There both
//   curves turn in alpha.
// Period 2, s = X + Y, p = X Y: the difference of both equations gives s = 1 + beta, the sum
//   p = (s^2 - alpha)/(1 + R), so that there is one such orbit at most. It is real if s^2 > 4 p, that is above the
//   flips of the fixed points. determinant = beta^2 - R beta s + R^2 p, trace = -2 beta + R s - 2 R s^2 + (R + 2)^2 p.
//   fold:  only where s^2 = 4 p, at the flips.
//   flip:  linear in p; for R = -1/2 alpha = 1.5 s^2 - s + 0.8, which turns in alpha at s = 1/3.
//   torus: p = s (2 - R - (1 - R) s)/R^2; for R = -1/2 alpha = 4 s^2 - 5 s, trace = 2 + 20 s - 12.5 s^2. The curve
//          begins at the fold-flip (s = 0) and goes to s < 0, where it ends in R2 of the flips of period 2, at trace
//          -2; and it begins at R2 of the fixed points (s = 8/5) and leaves the box at trace 0.553.
// Degenerate flips and tori were looked for along all curves by `graze run` and not found.
//
//   beta   fold alpha    flip alpha   torus alpha   flip of period 2   torus of period 2
//  -1.1    -0.00166667   0.00875      -             0.915              0.54
//  -0.5    -0.04166667   0.21875      -             0.675              -
//   0.5    -0.375        1.96875      -             2.675              -
//   0.65   -0.45375      2.3821875    1.89          (3.234)            2.64
//   0.9    -0.60166667   (3.15875)    0.44          -                  -
//   1.2    -0.80666667   -            -0.64         -                  -
// (in parentheses: outside the box)
//
// Other attractors: tori and locked orbits of long periods beyond the torus curves, periods 4, 8, ... and chaos beyond
// the flips of period 2; below the folds, and far above the flips, motions are unbounded.

#pragma once

#include "known.hpp"

#include <cmath>

namespace graze::testing::truth::torus_map {

inline constexpr double R = -0.5;
inline constexpr Box box{"beta", "alpha", -1.3, 1.5, -1.2, 2.8, 2};

inline double fixed_point_alpha(double beta, double x) {
    return (1 + beta) * x + (1 - R) * x * x;
}

inline std::vector<double> folds(double beta) {
    return {fixed_point_alpha(beta, -(1 + beta) / (2 - 2 * R))};
}

inline std::vector<double> flips(double beta) {
    return {fixed_point_alpha(beta, (1 + beta) / 2)};
}

inline std::vector<double> tori(double beta) {
    const double x = (beta - 1) / R;
    if (std::abs((R - 2) * x) > 2)
        return {};
    return {fixed_point_alpha(beta, x)};
}

inline double double_alpha(double beta, double p) {
    return (1 + beta) * (1 + beta) - (1 + R) * p;
}

inline std::vector<double> double_flips(double beta) {
    const double s = 1 + beta,
                 p = -(1 - 2 * beta + R * s - 2 * R * s * s + beta * beta - R * beta * s) / ((R + 2) * (R + 2) + R * R);
    return {double_alpha(beta, p)};
}

/// The trace of the orbit of period 2 whose determinant is 1 is 2 + linear s + square s^2.
inline constexpr double linear = R - 2 + (R + 2) * (R + 2) * (2 - R) / (R * R),
                        square = -2 * R - (R + 2) * (R + 2) * (1 - R) / (R * R);

inline std::vector<double> double_tori(double beta) {
    const double s = 1 + beta, p = s * (2 - R - (1 - R) * s) / (R * R);
    if (s * s < 4 * p || std::abs(2 + linear * s + square * s * s) > 2)
        return {};
    return {double_alpha(beta, p)};
}

inline const std::vector<NamedCurve> curves{{"SN", 1, 0, folds},
                                            {"PD", 1, 0, flips},
                                            {"NS", 1, 0, tori},
                                            {"PD", 2, 0, double_flips},
                                            {"NS", 2, 0, double_tori}};

inline Joint resonance(const char* type, double trace) {
    const double x = trace / (R - 2), beta = 1 + R * x;
    return {type, 1, beta, fixed_point_alpha(beta, x)};
}

/// The root s < 0 of the trace.
inline Joint double_resonance(const char* type, double trace) {
    const double s = (-linear + std::sqrt(linear * linear - 4 * square * (2 - trace))) / (2 * square),
                 p = s * (2 - R - (1 - R) * s) / (R * R);
    return {type, 2, s - 1, double_alpha(s - 1, p)};
}

inline std::vector<Joint> joints() {
    return {{"FP", 1, -1, 0},         {"EX", 1, -1, 0},           {"EX", 2, -2. / 3, double_flips(-2. / 3)[0]},
            resonance("R1", 2),       resonance("R2", -2),        resonance("R3", -1),
            resonance("R4", 0),       double_resonance("R2", -2), double_resonance("R3", -1),
            double_resonance("R4", 0)};
}

} // namespace graze::testing::truth::torus_map
