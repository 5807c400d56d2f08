#pragma once

#include "graze/flow/roots.hpp"

#include <span>

namespace graze::bernstein {

/// Relative round-off of one operation.
inline constexpr double unit_roundoff = 0x1p-53;

/// Replaces power coefficients on [0, 1] (value, and a bound on its size) by Bernstein coefficients.
/// @param reciprocals 1 / binomial(n, k), k = 0..n
///
/// Each result is known to (n + 2) u times its bound, plus what the input was uncertain by: the bounds pass through
/// the same sums as the values, none of which can cancel.
void from_power(std::span<BernsteinCoefficient> b, std::span<const double> reciprocals);

/// De Casteljau's rule at the middle: `left` receives the left half, `b` keeps the right half.
/// Adds at most n u times the bound to the uncertainty, for the same reason.
void halve(std::span<BernsteinCoefficient> b, std::span<BernsteinCoefficient> left);

/// Bernstein coefficients on [left, left + width] computed afresh from power coefficients, by a shift of the origin
/// in double-double arithmetic: their bounds are local, so that what cancels in the large is still known here.
/// @param error what round-off makes uncertain in the polynomial at the right end
void expand(std::span<const double> c, double left, double width, double error, std::span<const double> reciprocals,
            std::span<BernsteinCoefficient> b);

/// Least and greatest value that the coefficients may have (so that the polynomial lies between), and the
/// greatest uncertainty among them. Coefficients that vanish identically at the start (a root at the open end) are
/// left out.
struct Range {
    double low, high, uncertainty;
};
Range range(std::span<const BernsteinCoefficient> b, double scale, double floor);

/// The most sign variations that the coefficients may have given what they are uncertain by, or 2 if more: by
/// Descartes' rule there are no more roots than that inside.
int root_variations(std::span<const BernsteinCoefficient> b, double scale, double floor);

/// The same for the derivative: no more extrema than that inside.
int extremum_variations(std::span<const BernsteinCoefficient> b, double scale);

} // namespace graze::bernstein
