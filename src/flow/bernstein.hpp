#pragma once

#include "graze/flow/roots.hpp"

#include <span>

namespace graze::bernstein {

/// Relative round-off of one operation.
inline constexpr double unit_roundoff = 0x1p-53;

/// Converts power coefficients on [0, 1] (value, and a bound on its size) to Bernstein coefficients.
/// @param reciprocals 1 / binomial(n, k), k = 0..n
///
/// Each result is known to (n + 2) u times its bound, plus the uncertainty of the input: the bounds are computed by the
/// same sums as the values, without cancellation.
void from_power(std::span<BernsteinCoefficient> b, std::span<const double> reciprocals);

/// De Casteljau's algorithm at the midpoint: `left` receives the left half, `b` keeps the right half. Adds at most n u
/// times the bound to the uncertainty, for the same reason.
void halve(std::span<BernsteinCoefficient> b, std::span<BernsteinCoefficient> left);

/// Recomputes Bernstein coefficients on [left, left + width] from power coefficients, by a shift of the origin in
/// double-double arithmetic: the bounds are local, so that digits lost to global cancellation are recovered.
/// @param error uncertainty of the polynomial due to round-off at the right end
void expand(std::span<const double> c, double left, double width, double error, std::span<const double> reciprocals,
            std::span<BernsteinCoefficient> b);

/// Least and greatest possible value of the coefficients (the polynomial lies between them), and their greatest
/// uncertainty. Coefficients that vanish identically at the start (a root at the open end) are left out.
struct Range {
    double low, high, uncertainty;
};
Range range(std::span<const BernsteinCoefficient> b, double scale, double floor);

/// Returns the largest number of sign variations that the coefficients may have given their uncertainty, or 2 if more:
/// by Descartes' rule there are at most as many roots inside.
int root_variations(std::span<const BernsteinCoefficient> b, double scale, double floor);

/// The same for the derivative: there are at most as many extrema inside.
int extremum_variations(std::span<const BernsteinCoefficient> b, double scale);

} // namespace graze::bernstein
