#include "graze/record/low_pass.hpp"

#include "graze/base/input_error.hpp"
#include "graze/base/require.hpp"
#include "graze/record/spectrum.hpp"
#include "record/even_clock.hpp"
#include "record/sliding_samples.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <optional>
#include <span>
#include <vector>

namespace graze {

namespace {

constexpr std::size_t longest_filter = 1'000'000;

/// Weights of the middle sample and of those on one side; frequencies in units of the sampling frequency.
std::vector<double> filter_of(double pass, double stop, double attenuation) {
    // Kaiser's formulas for the shape and length of the window.
    double shape = 0;
    if (attenuation > 50)
        shape = 0.1102 * (attenuation - 8.7);
    else if (attenuation > 21)
        shape = 0.5842 * std::pow(attenuation - 21, 0.4) + 0.07886 * (attenuation - 21);
    const double order = (attenuation - 7.95) / (2.285 * 2 * std::numbers::pi * (stop - pass));
    if (!(order < static_cast<double>(2 * longest_filter)))
        throw InputError("the filter is too steep", "widen the band between pass and stop");
    const auto half = std::max<std::size_t>(1, static_cast<std::size_t>(std::ceil(order / 2)));
    const double cutoff = pass + stop; // twice the middle of the transition band, in units of the sampling frequency
    std::vector<double> factors(half + 1);
    for (std::size_t i = 0; i <= half; ++i) {
        const double x = static_cast<double>(i) / static_cast<double>(half);
        const double angle = std::numbers::pi * cutoff * static_cast<double>(i);
        factors[i] = cutoff * (i == 0 ? 1 : std::sin(angle) / angle) *
                     std::cyl_bessel_i(0.0, shape * std::sqrt(std::max(0.0, 1 - x * x))) /
                     std::cyl_bessel_i(0.0, shape);
    }
    const double sum = factors[0] + 2 * std::accumulate(factors.begin() + 1, factors.end(), 0.0);
    for (double& factor : factors)
        factor /= sum; // unit gain for constants
    return factors;
}

/// Bands are relative to the sampling frequency: within the filter's length the spacing must be the one for which it
/// was designed, but for rounding of times.
void require_spacing(std::span<const double> times, double spacing, std::size_t length) {
    const double rounding = rounding_of(times, spacing);
    constexpr double share = 0.05, drift = 0.0025; // of a step; half the allowed relative error of frequencies
    for (std::size_t first = 0; first + 1 < times.size(); first += std::max<std::size_t>(1, length / 2)) {
        const auto part = times.subspan(first, std::min(length, times.size() - first));
        require_even(part, spacing,
                     std::max(share * spacing, rounding) + drift * static_cast<double>(part.size()) * spacing);
    }
}

} // namespace

struct LowPass::State {
    std::shared_ptr<SampleSource> source;
    LowPassSettings settings;
    double spacing = 0; ///< spacing of the first samples, for which the weights were computed
    std::vector<double> factors{};
    std::optional<SlidingSamples> window{};
    std::size_t next = 0; ///< next row of the source to keep
    bool any = false;
};

LowPass::LowPass(std::shared_ptr<SampleSource> source, const LowPassSettings& settings)
    : state_(std::make_unique<State>(State{required(std::move(source), "a source"), settings})) {
    if (settings.every < 1)
        throw InputError("decimation cannot keep one of 0 samples", "keep one of 2 or more");
    constexpr double least = 21, most = 300;
    if (!(settings.attenuation >= least && settings.attenuation <= most))
        throw InputError(fmt::format("an attenuation of {} dB is not possible", settings.attenuation),
                         "choose one from 21 to 300");
    if (!(settings.pass >= 0) || !(settings.stop >= 0) || !std::isfinite(settings.pass + settings.stop) ||
        (settings.stop > 0 && !(settings.stop > settings.pass)) || (settings.stop > 0 && settings.pass == 0))
        throw InputError(fmt::format("no filter passes all up to {} and nothing from {}", settings.pass, settings.stop),
                         "give two positive frequencies, the second above the first");
    if (settings.pass == 0 && settings.every == 1)
        throw InputError("the filter has no frequency to pass", "give a frequency");
}

LowPass::~LowPass() = default;

const RecordHeader& LowPass::header() const {
    return state_->source->header();
}

bool LowPass::read(Samples& samples) {
    State& state = *state_;
    samples.clear(header().channels.size());
    if (!state.window) {
        Samples begun;
        if (!state.source->read(begun))
            return false;
        const double frequency = sampling_frequency(begun.times);
        state.spacing = 1 / frequency;
        const auto every = static_cast<double>(state.settings.every);
        constexpr double usual_pass = 0.35, usual_stop = 0.5, wider = 1.5;
        const double highest = usual_stop * frequency / every;
        const double pass = state.settings.pass > 0 ? state.settings.pass : usual_pass * frequency / every;
        const double stop = state.settings.stop > 0    ? state.settings.stop
                            : state.settings.every > 1 ? highest
                                                       : std::min(highest, wider * pass);
        if (!(pass < stop) || stop > highest * (1 + 1e-9))
            throw InputError(fmt::format("frequencies above {} cannot be resolved by a sampling frequency of {} by "
                                         "unit of time",
                                         highest, frequency / every),
                             "choose lower frequencies, or keep more samples");
        state.factors = filter_of(pass / frequency, stop / frequency, state.settings.attenuation);
        state.window.emplace(state.source, state.factors.size() - 1, std::move(begun));
        state.next = state.factors.size() - 1;
    }
    const std::size_t half = state.factors.size() - 1;
    while (samples.rows() == 0 && state.window->next()) {
        const Samples& rows = state.window->samples();
        sampling_frequency(rows.times);
        require_spacing(rows.times, state.spacing, 2 * half + 1);
        for (; state.next < state.window->dropped() + state.window->last(); state.next += state.settings.every) {
            const std::size_t i = state.next - state.window->dropped();
            samples.times.push_back(rows.times[i]);
            for (std::size_t c = 0; c < rows.values.size(); ++c) {
                const double* const centre = rows.values[c].data() + i;
                double sum = state.factors[0] * *centre;
                for (std::size_t k = 1; k <= half; ++k)
                    sum += state.factors[k] * (*(centre - k) + *(centre + k));
                samples.values[c].push_back(sum);
            }
        }
    }
    if (samples.rows() == 0 && !state.any)
        throw InputError(fmt::format("the record is shorter than the filter, which needs {} samples", 2 * half + 1),
                         "record longer, or widen the band between pass and stop");
    state.any = true;
    return samples.rows() > 0;
}

} // namespace graze
