#include "graze/results/spectrum.hpp"
#include "graze/symbolic/input_error.hpp"
#include "graze/symbolic/require.hpp"

#include <fmt/format.h>

#include <cmath>
#include <complex>
#include <numbers>
#include <numeric>

namespace graze {

Spectrum spectrum(std::span<const double> samples, double frequency) {
    require_finite(samples, "a sample");
    if (!(frequency > 0))
        throw InputError(fmt::format("the frequency {} of samples is not positive", frequency),
                         "give samples in a unit of time");
    require_finite(frequency, "the frequency of samples");
    Spectrum result;
    const std::size_t count = samples.size();
    if (count < 2)
        return result;
    const auto size = static_cast<double>(count);
    result.mean = std::accumulate(samples.begin(), samples.end(), 0.0) / size;
    for (std::size_t k = 1; 2 * k <= count; ++k) {
        std::complex<double> sum = 0;
        for (std::size_t i = 0; i < count; ++i) {
            // The product of the indices modulo N keeps the angle exact.
            const double turn = static_cast<double>((k * i) % count) / size;
            sum += (samples[i] - result.mean) * std::polar(1.0, -2 * std::numbers::pi * turn);
        }
        result.frequencies.push_back(static_cast<double>(k) * frequency / size);
        result.amplitudes.push_back((2 * k == count ? 1 : 2) * std::abs(sum) / size);
    }
    return result;
}

} // namespace graze
