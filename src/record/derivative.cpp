#include "graze/record/derivative.hpp"

#include "base/median.hpp"
#include "graze/base/input_error.hpp"
#include "graze/base/require.hpp"
#include "graze/record/spectrum.hpp"
#include "record/even_clock.hpp"
#include "record/local_polynomial.hpp"
#include "record/sliding_samples.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>
#include <vector>

namespace graze {

namespace {

constexpr std::size_t least_half_width = 4, most_half_width = 100'000;
// degrees of the polynomial of the derivative, and of the one that estimates its error
constexpr std::size_t fourth = 4, sixth = 6;

/// The derivative in the middle of a window.
struct Slope {
    double value = 0;
    double truncation = 0; ///< contribution of the terms of fifth and sixth degree
    double squares = 0;    ///< sum of the squared residuals of the sixth-degree polynomial
    double noise = 0,
           truncation_noise = 0; ///< standard errors of value and truncation, for samples with a standard error of 1

    /// Estimate of the squared truncation error, with the contribution of noise subtracted; it may be negative for a
    /// single window. @param variance of a sample
    double beyond(double variance) const {
        return truncation * truncation - variance * truncation_noise * truncation_noise;
    }
    /// @param usual typical squared truncation error: the estimate of one window is as noisy as the derivative itself,
    /// so it is used only if it is much larger
    double error(double variance, double usual) const {
        constexpr double significant = 9;
        const double own = truncation * truncation, own_noise = variance * truncation_noise * truncation_noise;
        return std::sqrt(variance * noise * noise +
                         (own > significant * own_noise ? std::max(usual, own - own_noise) : usual));
    }
};

/// Differentiates in windows that have the same times relative to their middle.
class SlopeFilter {
public:
    /// @param places times of the samples relative to the middle one @param reach scale of these times
    SlopeFilter(std::vector<double> places, double reach)
        : places_(std::move(places)), reach_(reach), fit_(divided(places_, reach), sixth), rest_(places_.size()) {}
    const std::vector<double>& places() const { return places_; }
    /// @param middle the middle sample, with equally many others on each side
    Slope at(const double* middle) {
        // Subtract the middle sample, so that a large constant costs no digits.
        for (std::size_t i = 0; i < rest_.size(); ++i)
            rest_[i] = *(middle - rest_.size() / 2 + i) - *middle;
        double factors[sixth + 1];
        for (std::size_t k = 0; k <= sixth; ++k)
            factors[k] = fit_.coefficient(k, rest_.data());
        Slope slope;
        slope.squares = fit_.squares_left(rest_.data(), factors);
        for (std::size_t k = 1; k <= sixth; ++k) {
            const double one = fit_.slope_at_zero(k) / reach_;
            (k <= fourth ? slope.value : slope.truncation) += factors[k] * one;
            double& noise = k <= fourth ? slope.noise : slope.truncation_noise;
            noise = std::hypot(noise, one);
        }
        return slope;
    }

private:
    static std::vector<double> divided(std::vector<double> places, double by) {
        for (double& place : places)
            place /= by;
        return places;
    }
    std::vector<double> places_;
    double reach_;
    LocalPolynomial fit_;
    std::vector<double> rest_;
};

/// Times of some rows, with their spacing and whether it is even: computed once for windows of many lengths.
struct Clock {
    explicit Clock(const std::vector<double>& given)
        : times(&given), spacing(1 / sampling_frequency(given)), is_even(is_even_clock(given)) {}
    const std::vector<double>* times;
    double spacing;
    bool is_even;
};

/// Derivatives in windows of a given half width: of equidistant samples if the clock is even but for rounding,
/// otherwise at the times as given.
class SlopeWindows {
public:
    /// @param clock, values must have `half` more rows on both sides of the requested ones, and outlive this object
    SlopeWindows(const Clock& clock, const std::vector<double>& values, std::size_t half)
        : clock_(&clock), values_(&values), half_(half) {}
    Slope at(std::size_t row) {
        set_filter(row);
        return filter_->at(values_->data() + row);
    }

private:
    void set_filter(std::size_t row) {
        if (filter_ && clock_->is_even)
            return;
        const std::vector<double>& times = *clock_->times;
        std::vector<double> places(2 * half_ + 1);
        for (std::size_t i = 0; i < places.size(); ++i)
            places[i] = clock_->is_even ? clock_->spacing * (static_cast<double>(i) - static_cast<double>(half_))
                                        : times[row - half_ + i] - times[row];
        const double reach = clock_->spacing * static_cast<double>(half_);
        const auto is_same = [&](double one, double other) { return std::abs(one - other) <= 1e-12 * reach; };
        if (!filter_ || !std::equal(places.begin(), places.end(), filter_->places().begin(), is_same))
            filter_.emplace(std::move(places), reach);
    }

    const Clock* clock_;
    const std::vector<double>* values_;
    std::size_t half_;
    std::optional<SlopeFilter> filter_{};
};

double freedom_of(std::size_t half) {
    return static_cast<double>(2 * half + 1 - (sixth + 1));
}

/// The typical variance of the windows' residuals, by their median.
double usual_variance(const std::vector<Slope>& slopes, double freedom) {
    std::vector<double> squares;
    for (const Slope& slope : slopes)
        squares.push_back(slope.squares);
    // Median of chi square (Wilson and Hilferty).
    const double share = std::pow(1 - 2 / (9 * freedom), 3);
    return median(std::move(squares)) / (freedom * share);
}

/// Variance of a sample in a window: the typical one, unless a nearby jump makes its own far larger.
double variance_at(const Slope& slope, double usual, double freedom) {
    constexpr double far = 10;
    const double own = slope.squares / freedom;
    return own > far * usual ? own : usual;
}

/// Mean squared truncation error of all windows without a jump.
double usual_beyond(const std::vector<Slope>& slopes, double usual, double freedom) {
    double sum = 0, count = 0;
    for (const Slope& slope : slopes)
        if (variance_at(slope, usual, freedom) == usual) {
            sum += slope.beyond(usual);
            ++count;
        }
    return count > 0 ? std::max(0.0, sum / count) : 0;
}

std::size_t best_half_width(const std::vector<double>& times, const std::vector<double>& values) {
    std::size_t best = 0;
    double least = 0, noise = 0;
    constexpr std::size_t tried_rows = 500;
    const Clock clock(times);
    for (std::size_t half = least_half_width; 4 * half < values.size() && half <= 512;
         half += std::max<std::size_t>(1, half / 3)) {
        SlopeWindows windows(clock, values, half);
        std::vector<Slope> slopes;
        const std::size_t step = std::max<std::size_t>(1, (values.size() - 2 * half) / tried_rows);
        for (std::size_t i = half; i + half < values.size(); i += step)
            slopes.push_back(windows.at(i));
        const double freedom = freedom_of(half), usual = usual_variance(slopes, freedom);
        // If the residuals exceed the noise, the window is too wide for a polynomial, whatever its higher terms say.
        constexpr double more_than_noise = 1.5;
        if (best != 0 && usual > more_than_noise * noise)
            break;
        noise = best == 0 ? usual : std::min(noise, usual);
        // Use the mean squared truncation error: in this window it may happen to vanish.
        Slope typical = slopes[slopes.size() / 2];
        typical.truncation = 0;
        const double error = typical.error(usual, usual_beyond(slopes, usual, freedom));
        if (best == 0 || error < least) {
            best = half;
            least = error;
        }
    }
    return best;
}

} // namespace

struct WithDerivative::State {
    std::shared_ptr<SampleSource> source;
    DerivativeSettings settings;
    RecordHeader header{};
    std::optional<SlidingSamples> window{};
    std::size_t half = 0; ///< known once something has been read
};

WithDerivative::WithDerivative(std::shared_ptr<SampleSource> source, const DerivativeSettings& settings)
    : state_(std::make_unique<State>(State{required(std::move(source), "a source"), settings})) {
    RecordHeader& header = state_->header = state_->source->header();
    require_index(settings.channel, header.channels.size(), "channel");
    if (settings.half_width != 0 && (settings.half_width < least_half_width || settings.half_width > most_half_width))
        throw InputError(
            fmt::format("{} samples on each side are not a valid width for a derivative", settings.half_width),
            "choose 4 or more, or 0 for the best");
    const Channel& channel = header.channels[settings.channel];
    const std::string name = settings.name.empty() ? channel.name + "_rate" : settings.name;
    const std::string unit =
        channel.unit.empty() || header.time.unit.empty() ? "" : fmt::format("{}/{}", channel.unit, header.time.unit);
    for (const Channel& one : header.channels)
        if (one.name == name || one.name == name + "_error")
            throw InputError(fmt::format("there is a channel '{}' already", one.name),
                             "give the derivative another name");
    header.channels.push_back({name, unit});
    header.channels.push_back({name + "_error", unit});
}

WithDerivative::~WithDerivative() = default;

const RecordHeader& WithDerivative::header() const {
    return state_->header;
}

std::size_t WithDerivative::half_width() const {
    return state_->half > 0 ? state_->half : state_->settings.half_width;
}

bool WithDerivative::read(Samples& samples) {
    State& state = *state_;
    const std::size_t channel = state.settings.channel;
    if (!state.window) {
        Samples begun;
        state.source->read(begun);
        constexpr std::size_t least_rows = 2 * least_half_width + 2;
        const std::size_t needed = std::max(least_rows, 2 * state.settings.half_width + 1);
        Samples more;
        while (begun.rows() < needed && state.source->read(more))
            begun.append(more);
        if (begun.rows() < needed || (state.settings.half_width == 0 && begun.rows() <= 4 * least_half_width))
            throw InputError(fmt::format("the record is too short for a derivative: it has {} samples", begun.rows()),
                             "record longer");
        state.half = state.settings.half_width > 0 ? state.settings.half_width
                                                   : best_half_width(begun.times, begun.values[channel]);
        state.window.emplace(state.source, state.half, std::move(begun));
    }
    samples.clear(state.header.channels.size());
    if (!state.window->next())
        return false;
    const Samples& rows = state.window->samples();
    const Clock clock(rows.times);
    SlopeWindows windows(clock, rows.values[channel], state.half);
    std::vector<Slope> slopes;
    for (std::size_t i = state.window->first(); i < state.window->last(); ++i)
        slopes.push_back(windows.at(i));
    const double freedom = freedom_of(state.half), usual = usual_variance(slopes, freedom);
    Samples core;
    core.append(rows, state.window->first(), state.window->last());
    samples.times = std::move(core.times);
    std::move(core.values.begin(), core.values.end(), samples.values.begin());
    const double beyond = usual_beyond(slopes, usual, freedom);
    std::vector<double>&values = samples.values[core.values.size()], &errors = samples.values[core.values.size() + 1];
    for (const Slope& slope : slopes) {
        values.push_back(slope.value);
        errors.push_back(slope.error(variance_at(slope, usual, freedom), beyond));
    }
    return true;
}

} // namespace graze
