#pragma once

#include <complex>
#include <span>
#include <vector>

namespace graze {

/// Returns the discrete Fourier transform of any length: sums of x_j exp(-2 pi i j k/N), k = 0 ... N/2. Time O(N log N)
/// (Bluestein's algorithm over powers of two).
std::vector<std::complex<double>> half_transform(std::span<const double> samples);

} // namespace graze
