#pragma once

#include <complex>
#include <functional>
#include <span>
#include <vector>

namespace graze {

/// Returns the discrete Fourier transform of any length: sums of x_j exp(-2 pi i j k/N), k = 0 ... N/2. Time O(N log N)
/// (Bluestein's algorithm over powers of two).
/// @param interrupted called now and then; returns true to stop
/// @return empty when it was interrupted
std::vector<std::complex<double>> half_transform(std::span<const double> samples,
                                                 const std::function<bool()>& interrupted = {});

} // namespace graze
