#include "graze/record/derivative.hpp"

#include "base/median.hpp"
#include "graze/base/input_error.hpp"
#include "graze/base/require.hpp"
#include "graze/record/spectrum.hpp"
#include "record/local_polynomial.hpp"
#include "record/resumed_source.hpp"
#include "record/sliding_samples.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

namespace graze {

namespace {

constexpr std::size_t least_half_width = 4, most_half_width = 100'000;
constexpr std::size_t sixth = 6;

/// The derivative in the middle of a window, in units of one sample's distance.
struct Slope {
    double value = 0;
    double truncation = 0; ///< what the terms of fifth and sixth degree add
    double squares = 0;    ///< that a polynomial of sixth degree leaves
};

class SlopeFilter {
public:
    explicit SlopeFilter(std::size_t half) : half_(half), fit_(places(half), sixth), rest_(2 * half + 1) {
        noise_ = std::hypot(fit_.slope_at_zero(1), fit_.slope_at_zero(3)) / static_cast<double>(half);
        truncation_noise_ = std::abs(fit_.slope_at_zero(5)) / static_cast<double>(half);
    }
    std::size_t half() const { return half_; }
    double freedom() const { return static_cast<double>(2 * half_ + 1 - (sixth + 1)); }
    /// @param middle sample with `half` others on each side
    Slope at(const double* middle) {
        // Less the middle, lest a constant cost digits.
        for (std::size_t i = 0; i < rest_.size(); ++i)
            rest_[i] = *(middle - half_ + i) - *middle;
        Slope slope;
        double factors[sixth + 1];
        for (std::size_t k = 0; k <= sixth; ++k)
            factors[k] = fit_.coefficient(k, rest_.data());
        slope.squares = fit_.squares_left(rest_.data(), factors);
        const auto width = static_cast<double>(half_);
        slope.value = (factors[1] * fit_.slope_at_zero(1) + factors[3] * fit_.slope_at_zero(3)) / width;
        slope.truncation = factors[5] * fit_.slope_at_zero(5) / width;
        return slope;
    }
    /// Square of what the terms of fifth and sixth degree add, without what noise adds to it: of one window it may be
    /// below zero. @param variance of a sample
    double beyond(const Slope& slope, double variance) const {
        return slope.truncation * slope.truncation - variance * truncation_noise_ * truncation_noise_;
    }
    /// @param usual what these terms usually add, squared: that of one window is as noisy as the slope itself, so that
    /// it
    ///        is believed only where it is much larger
    double error(const Slope& slope, double variance, double usual) const {
        constexpr double significant = 9;
        const double own = slope.truncation * slope.truncation,
                     noise = variance * truncation_noise_ * truncation_noise_;
        return std::sqrt(variance * noise_ * noise_ +
                         (own > significant * noise ? std::max(usual, own - noise) : usual));
    }

private:
    static std::vector<double> places(std::size_t half) {
        std::vector<double> result;
        for (std::size_t i = 0; i <= 2 * half; ++i)
            result.push_back((static_cast<double>(i) - static_cast<double>(half)) / static_cast<double>(half));
        return result;
    }
    std::size_t half_;
    LocalPolynomial fit_;
    double noise_ = 0, truncation_noise_ = 0;
    std::vector<double> rest_;
};

/// The variance that most windows have.
double usual_variance(const std::vector<Slope>& slopes, double freedom) {
    std::vector<double> squares;
    for (const Slope& slope : slopes)
        squares.push_back(slope.squares);
    // The median of chi squared (Wilson and Hilferty).
    const double share = std::pow(1 - 2 / (9 * freedom), 3);
    return median(std::move(squares)) / (freedom * share);
}

/// A jump beside makes the variance of a window large.
double variance_at(const Slope& slope, double usual, double freedom) {
    constexpr double far = 10;
    const double own = slope.squares / freedom;
    return own > far * usual ? own : usual;
}

/// What terms beyond the fourth degree add to the slope, squared: the mean of all windows in which nothing jumps.
double usual_beyond(const SlopeFilter& filter, const std::vector<Slope>& slopes, double usual) {
    double sum = 0, count = 0;
    for (const Slope& slope : slopes)
        if (variance_at(slope, usual, filter.freedom()) == usual) {
            sum += filter.beyond(slope, usual);
            ++count;
        }
    return count > 0 ? std::max(0.0, sum / count) : 0;
}

std::size_t best_half_width(const std::vector<double>& values) {
    std::size_t best = 0;
    double least = 0, noise = 0;
    constexpr std::size_t tried_rows = 500;
    for (std::size_t half = least_half_width; 4 * half < values.size() && half <= 512;
         half += std::max<std::size_t>(1, half / 3)) {
        SlopeFilter filter(half);
        std::vector<Slope> slopes;
        const std::size_t step = std::max<std::size_t>(1, (values.size() - 2 * half) / tried_rows);
        for (std::size_t i = half; i + half < values.size(); i += step)
            slopes.push_back(filter.at(values.data() + i));
        const double usual = usual_variance(slopes, filter.freedom());
        // Where more is left than noise, the window is too wide for any polynomial, whatever its terms say.
        constexpr double more_than_noise = 1.5;
        if (best != 0 && usual > more_than_noise * noise)
            break;
        noise = best == 0 ? usual : std::min(noise, usual);
        // Of the squares' mean: where the terms pass through nought they are as large elsewhere.
        const double error = filter.error({}, usual, usual_beyond(filter, slopes, usual));
        if (best == 0 || error < least) {
            best = half;
            least = error;
        }
    }
    return best;
}

} // namespace

struct WithDerivative::State {
    SampleSource* source;
    DerivativeSettings settings;
    RecordHeader header{};
    std::unique_ptr<SampleSource> beginning{};
    std::optional<SlidingSamples> window{};
    std::optional<SlopeFilter> filter{};
};

WithDerivative::WithDerivative(SampleSource& source, const DerivativeSettings& settings)
    : state_(std::make_unique<State>(State{&source, settings})) {
    require_index(settings.channel, source.header().channels.size(), "channel");
    if (settings.half_width != 0 && (settings.half_width < least_half_width || settings.half_width > most_half_width))
        throw InputError(fmt::format("{} samples on each side are no width for a derivative", settings.half_width),
                         "choose 4 or more, or 0 for the best");
    RecordHeader& header = state_->header = source.header();
    const Channel& channel = header.channels[settings.channel];
    const std::string name = settings.name.empty() ? channel.name + "_rate" : settings.name;
    const std::string unit =
        channel.unit.empty() || header.time.unit.empty() ? "" : fmt::format("{}/{}", channel.unit, header.time.unit);
    for (const Channel& one : header.channels)
        if (one.name == name || one.name == name + "_error")
            throw InputError(fmt::format("there is a channel '{}' already", one.name), "name the derivative otherwise");
    header.channels.push_back({name, unit});
    header.channels.push_back({name + "_error", unit});
}

WithDerivative::~WithDerivative() = default;

const RecordHeader& WithDerivative::header() const {
    return state_->header;
}

std::size_t WithDerivative::half_width() const {
    return state_->filter ? state_->filter->half() : state_->settings.half_width;
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
        const std::size_t half =
            state.settings.half_width > 0 ? state.settings.half_width : best_half_width(begun.values[channel]);
        state.filter.emplace(half);
        state.beginning = std::make_unique<ResumedSource>(*state.source, std::move(begun));
        state.window.emplace(*state.beginning, half);
    }
    samples.clear(state.header.channels.size());
    if (!state.window->next())
        return false;
    const Samples& rows = state.window->samples();
    const double frequency = sampling_frequency(rows.times);
    std::vector<Slope> slopes;
    for (std::size_t i = state.window->first(); i < state.window->last(); ++i)
        slopes.push_back(state.filter->at(rows.values[channel].data() + i));
    const double freedom = state.filter->freedom(), usual = usual_variance(slopes, freedom);
    Samples core;
    core.append(rows, state.window->first(), state.window->last());
    samples.times = std::move(core.times);
    std::move(core.values.begin(), core.values.end(), samples.values.begin());
    const double beyond = usual_beyond(*state.filter, slopes, usual);
    std::vector<double>&values = samples.values[core.values.size()], &errors = samples.values[core.values.size() + 1];
    for (const Slope& slope : slopes) {
        values.push_back(slope.value * frequency);
        errors.push_back(state.filter->error(slope, variance_at(slope, usual, freedom), beyond) * frequency);
    }
    return true;
}

} // namespace graze
