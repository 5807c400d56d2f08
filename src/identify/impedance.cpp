#include "graze/identify/impedance.hpp"

#include "graze/base/input_error.hpp"
#include "graze/base/require.hpp"
#include "graze/record/period.hpp"
#include "graze/record/spectrum.hpp"
#include "identify/row_gap.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <numeric>
#include <vector>

namespace graze {

namespace {

/// Angular frequency from upward crossings of the mean, for samples at any times. Noise adds false crossings.
double frequency_of_crossings(std::span<const double> times, std::span<const double> voltage) {
    Samples samples;
    samples.times.assign(times.begin(), times.end());
    samples.values.emplace_back(voltage.begin(), voltage.end());
    StoredSamples source({{"t", ""}, {{"voltage", ""}}}, std::move(samples));
    const double level = std::accumulate(voltage.begin(), voltage.end(), 0.0) /
                         static_cast<double>(std::max<std::size_t>(1, voltage.size()));
    PeriodSplitter splitter(borrowed(source), {0, level});
    std::vector<double> crossings;
    for (Period period; splitter.next(period); crossings.push_back(period.end))
        if (crossings.empty())
            crossings.push_back(period.begin);
    if (crossings.size() < 2)
        throw InputError("the voltage has less than two periods", "record more of them");
    return 2 * std::numbers::pi / fit_period(crossings).period;
}

/// The longest part without a missing row: index of its first sample, and number of samples.
std::pair<std::size_t, std::size_t> longest_part(std::span<const double> times) {
    const double most = longer_than_usual * usual_step(times);
    std::pair<std::size_t, std::size_t> longest{0, 0};
    for (std::size_t first = 0, i = 1; i <= times.size(); ++i)
        if (i == times.size() || times[i] - times[i - 1] > most) {
            if (i - first > longest.second)
                longest = {first, i - first};
            first = i;
        }
    return longest;
}

/// Angular frequency at which a sine fitted to equidistant samples has the largest amplitude, to a tenth of the
/// frequency resolution.
double frequency_of_waves(std::span<const double> times, std::span<const double> voltage) {
    constexpr int parts = 10;
    double by_time = 0;
    try {
        by_time = sampling_frequency(times);
    } catch (const InputError&) {
        return frequency_of_crossings(times, voltage);
    }
    const Spectrum waves = spectrum(voltage, by_time);
    const auto highest = std::max_element(waves.amplitudes.begin(), waves.amplitudes.end());
    if (highest == waves.amplitudes.end() || highest == waves.amplitudes.begin())
        return frequency_of_crossings(times, voltage);
    const double peak = waves.frequencies[static_cast<std::size_t>(highest - waves.amplitudes.begin())];
    const double apart = by_time / static_cast<double>(times.size());
    double best = 0, largest = -1;
    for (int part = -parts; part <= parts; ++part) {
        const double frequency = 2 * std::numbers::pi * (peak + part * apart / parts);
        if (const double size = fit_harmonic(times, voltage, frequency).amplitude(); size > largest) {
            largest = size;
            best = frequency;
        }
    }
    return best;
}

/// Initial guess of the angular frequency. If the record has gaps, in which the phase may slip, it comes from the
/// longest part without gaps.
double guessed_frequency(std::span<const double> times, std::span<const double> voltage) {
    const auto [first, count] = longest_part(times);
    constexpr std::size_t parts = 4; // parts of the record: a shorter part would tell less than the whole
    if (count == times.size() || parts * count < times.size())
        return frequency_of_waves(times, voltage);
    const std::span<const double> part = times.subspan(first, count), seen = voltage.subspan(first, count);
    return fit_frequency(part, std::array{seen}, frequency_of_waves(part, seen));
}

ResidualTest test_sine(std::span<const double> times, std::span<const double> values, const Harmonic& sine) {
    std::vector<double> left;
    for (std::size_t i = 0; i < times.size(); ++i) {
        const double angle = sine.frequency * times[i];
        left.push_back(values[i] - sine.offset - sine.sine * std::sin(angle) - sine.cosine * std::cos(angle));
    }
    return test_residuals(left, values);
}

} // namespace

Impedance impedance(std::span<const double> times, std::span<const double> voltage, std::span<const double> current,
                    double guess) {
    require_size(voltage.size(), times.size(), "values of the voltage");
    require_size(current.size(), times.size(), "values of the current");
    require_finite(guess, "the frequency");
    const std::array<std::span<const double>, 2> channels{voltage, current};
    Impedance result;
    result.frequency = fit_frequency(times, channels, guess > 0 ? guess : guessed_frequency(times, voltage));
    std::vector<double> centred(times.begin(), times.end());
    const double middle = 0.5 * (times.front() + times.back());
    for (double& t : centred)
        t -= middle;
    result.voltage = fit_harmonic(centred, voltage, result.frequency);
    result.current = fit_harmonic(centred, current, result.frequency);
    const double size = result.voltage.amplitude(), flow = result.current.amplitude();
    if (!(flow > 0) || !(size > 0))
        throw InputError("there is no voltage or no current", "give both, of a coil that carries a current");
    result.voltage_test = test_sine(centred, voltage, result.voltage);
    result.current_test = test_sine(centred, current, result.current);
    const double wider_voltage = result.voltage_test.widening, wider_current = result.current_test.widening;
    constexpr double unknowns = 3;
    const double freedom = static_cast<double>(times.size()) - unknowns;
    const double magnitude = size / flow;
    result.magnitude = {magnitude,
                        magnitude * std::hypot(wider_voltage * result.voltage.amplitude_error() / size,
                                               wider_current * result.current.amplitude_error() / flow),
                        freedom};
    result.lag = {
        std::remainder(result.voltage.phase() - result.current.phase(), 2 * std::numbers::pi),
        std::hypot(wider_voltage * result.voltage.phase_error(), wider_current * result.current.phase_error()),
        freedom};
    const double c = std::cos(result.lag.value), s = std::sin(result.lag.value);
    result.resistance = {magnitude * c, std::hypot(c * result.magnitude.error, magnitude * s * result.lag.error),
                         freedom};
    result.inductance = {magnitude * s / result.frequency,
                         std::hypot(s * result.magnitude.error, magnitude * c * result.lag.error) / result.frequency,
                         freedom};
    return result;
}

Estimate leakage_inductance(const Estimate& inductance, const Estimate& beta1, const Estimate& beta2, double gap,
                            double displacement) {
    const double space = beta2.value + gap - displacement;
    if (!(space > 0))
        throw InputError("the air gap is closed", "give gap and displacement in the unit of beta2");
    const double coupled = beta1.value / space;
    Estimate result = inductance;
    result.value -= coupled;
    result.error = std::hypot(inductance.error, beta1.error / space, beta2.error * coupled / space);
    return result;
}

} // namespace graze
