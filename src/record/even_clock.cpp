#include "record/even_clock.hpp"

#include "base/special_numbers.hpp"
#include "graze/base/input_error.hpp"
#include "graze/record/spectrum.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace graze {

double deviation_from_even(std::span<const double> times, double spacing) {
    double least = 0, most = 0;
    for (std::size_t i = 0; i < times.size(); ++i) {
        const double off = times[i] - times[0] - static_cast<double>(i) * spacing;
        least = std::min(least, off);
        most = std::max(most, off);
    }
    return (most - least) / 2;
}

double rounding_of(std::span<const double> times, double spacing) {
    const double digits = 8 * epsilon * std::max(std::abs(times.front()), std::abs(times.back()));
    constexpr int places = 8; // decimal places below the spacing
    const int first = static_cast<int>(std::ceil(std::log10(spacing)));
    for (int place = first; place > first - places; --place) {
        const double unit = std::pow(10.0, place);
        const bool fits = std::all_of(times.begin(), times.end(), [&](double t) {
            return std::abs(t / unit - std::round(t / unit)) <= 1e-4 + 4 * epsilon * std::abs(t / unit);
        });
        if (fits)
            return unit + digits;
    }
    return digits + 1e-6 * spacing;
}

bool is_even_clock(std::span<const double> times) {
    const double spacing = 1 / sampling_frequency(times);
    return deviation_from_even(times, spacing) <= rounding_of(times, spacing);
}

void require_even(std::span<const double> times, double spacing, double allowed) {
    if (const double deviation = deviation_from_even(times, spacing); deviation > allowed)
        throw InputError(fmt::format("the samples are not equidistant in time: from {} to {} they are up to "
                                     "{:.3g} off times that are {:.6g} apart",
                                     times.front(), times.back(), deviation, spacing),
                         "give a part of the record whose clock is even, or one that has been resampled");
}

double even_sampling_frequency(std::span<const double> times) {
    constexpr double share = 0.05;
    const double frequency = sampling_frequency(times), spacing = 1 / frequency;
    require_even(times, spacing, std::max(share * spacing, rounding_of(times, spacing)));
    return frequency;
}

} // namespace graze
