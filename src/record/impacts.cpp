#include "graze/record/impacts.hpp"

#include "base/median.hpp"
#include "graze/base/input_error.hpp"
#include "graze/base/require.hpp"
#include "graze/record/spectrum.hpp"
#include "record/local_polynomial.hpp"
#include "record/sliding_samples.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace graze {

namespace {

constexpr std::size_t nearest_samples = 4; ///< impacts closer than this are one
constexpr std::size_t parabola = 2;

/// Estimates the standard deviation of white noise on a smooth channel.
double noise_of(const std::vector<double>& values) {
    std::vector<double> differences;
    for (std::size_t i = 3; i < values.size(); ++i)
        differences.push_back(std::abs(values[i] - 3 * values[i - 1] + 3 * values[i - 2] - values[i - 3]));
    if (differences.empty())
        return 0;
    constexpr double median_of_normal = 0.6744897501960817, third_differences = 20; // 1 + 9 + 9 + 1
    double largest = 0, step = std::numeric_limits<double>::infinity();
    std::size_t still = 0;
    for (std::size_t i = 1; i < values.size(); ++i) {
        largest = std::max(largest, std::abs(values[i]));
        const double difference = std::abs(values[i] - values[i - 1]);
        still += difference == 0 ? 1 : 0;
        step = difference > 0 ? std::min(step, difference) : step;
    }
    constexpr std::size_t often = 10; // one of so many samples
    // Numbers with few digits repeat and then jump by one step: that is rounding noise.
    const double digits = often * still > values.size() && std::isfinite(step) ? step / std::sqrt(12.0) : 0;
    return std::max({median(std::move(differences)) / (median_of_normal * std::sqrt(third_differences)), digits,
                     4 * std::numeric_limits<double>::epsilon() * largest});
}

/// Distances of samples on one side from the impact, nearest first, scaled to 0 ... 1.
std::vector<double> side(std::size_t count, std::size_t transition, double offset, double scale) {
    std::vector<double> places;
    for (std::size_t i = 0; i < count; ++i)
        places.push_back((static_cast<double>(i + transition) + offset) / scale);
    return places;
}

/// A channel extrapolated to the impact from one side.
struct Continued {
    double value = 0, slope = 0; ///< slope per sample, in the direction away from the impact
    double error = 0;            ///< standard error of the value
};

/// Extrapolates by a parabola, or by a polynomial of higher degree if its next term is significant.
/// @param samples of one side, nearest first. @param offset distance of the nearest one from the impact, in samples
Continued continued(const std::vector<double>& samples, std::size_t transition, double offset, double noise) {
    constexpr std::size_t most = 5;
    const std::size_t known = std::min(most, samples.size() / 2), least = std::min(parabola, samples.size() / 3);
    const auto scale = static_cast<double>(samples.size() + transition);
    const LocalPolynomial fit(side(samples.size(), transition, offset, scale), std::max(known, least));
    Continued result;
    double variance = 0;
    for (std::size_t k = 0; k <= fit.degree(); ++k) {
        const double factor = fit.coefficient(k, samples.data());
        constexpr double chance = 3;
        if (k > least && std::abs(factor) < chance * noise)
            break;
        result.value += factor * fit.at_zero(k);
        result.slope += factor * fit.slope_at_zero(k) / scale;
        variance += std::pow(noise * fit.at_zero(k), 2);
    }
    result.error = std::sqrt(variance);
    return result;
}

} // namespace

struct ImpactFinder::State {
    ImpactSettings settings;
    SlidingSamples window;
    LocalPolynomial fit; ///< for the samples of one side
    std::vector<double> left{}, right{};
    double value_noise = 0; ///< standard error of an extrapolated value, for noise of 1

    State(std::shared_ptr<SampleSource> source, const ImpactSettings& given)
        : settings(given), window(std::move(source), 3 * (given.window + given.transition) + 1),
          fit(side(given.window, given.transition, 0.5, static_cast<double>(given.window + given.transition)),
              parabola) {
        for (std::size_t k = 0; k <= parabola; ++k)
            value_noise = std::hypot(value_noise, fit.at_zero(k));
    }

    /// Significance of a jump between rows i and i + 1: its size relative to what noise and misfit can explain; 0: not
    /// significant.
    double significance(const std::vector<double>& values, std::size_t i, double noise) {
        const std::size_t count = settings.window;
        left.resize(count);
        right.resize(count);
        for (std::size_t k = 0; k < count; ++k) {
            left[k] = values[i - settings.transition - k] - values[i];
            right[k] = values[i + 1 + settings.transition + k] - values[i];
        }
        double jump = 0, before[parabola + 1], after[parabola + 1];
        for (std::size_t k = 0; k <= parabola; ++k) {
            before[k] = fit.coefficient(k, left.data());
            after[k] = fit.coefficient(k, right.data());
            jump += (after[k] - before[k]) * fit.at_zero(k);
        }
        const double squares = fit.squares_left(left.data(), before) + fit.squares_left(right.data(), after);
        const auto freedom = static_cast<double>(2 * count - 2 * (parabola + 1));
        const double misfit = std::max(0.0, squares / freedom - noise * noise);
        // If a term of third degree causes the misfit, its extrapolation to the end is sqrt(7) times that on either
        // side.
        const double by_misfit = 2 * std::sqrt(7 * misfit);
        const double by_noise = settings.significance * noise * value_noise * std::numbers::sqrt2;
        const double size = std::abs(jump);
        if (!(size > by_noise + 2 * by_misfit) || size < settings.least_jump)
            return 0;
        return size / (noise * value_noise + by_misfit + 1e-300);
    }

    RecordedImpact impact_at(std::size_t i, std::size_t from, std::size_t to, double spacing, double noise,
                             double place_noise) const;
};

/// @param from,to rows between which there is no other impact, the last not among them
RecordedImpact ImpactFinder::State::impact_at(std::size_t i, std::size_t from, std::size_t to, double spacing,
                                              double noise, double place_noise) const {
    const Samples& rows = window.samples();
    const std::vector<double>& values = rows.values[settings.velocity];
    const std::size_t before = std::min(settings.window, i + 1 - std::min(i + 1, from + settings.transition)),
                      after = std::min(settings.window, to - std::min(to, i + 1 + settings.transition));
    const auto rows_before = [&](const std::vector<double>& column) {
        const auto nearest = column.rend() - static_cast<std::ptrdiff_t>(i - settings.transition + 1);
        return std::vector<double>(nearest, nearest + static_cast<std::ptrdiff_t>(std::max<std::size_t>(before, 1)));
    };
    const auto rows_after = [&](const std::vector<double>& column) {
        const auto nearest = column.begin() + static_cast<std::ptrdiff_t>(i + 1 + settings.transition);
        return std::vector<double>(nearest, nearest + static_cast<std::ptrdiff_t>(std::max<std::size_t>(after, 1)));
    };
    double offset = 0.5, time_error = spacing / std::sqrt(12.0); // offset: time of the impact after row i, in samples
    if (settings.displacement) {
        const std::vector<double>& places = rows.values[*settings.displacement];
        const std::vector<double> first = rows_before(places), second = rows_after(places);
        // Newton's method for the time at which both extrapolations are equal.
        constexpr int steps = 20;
        for (int step = 0; step < steps; ++step) {
            const Continued a = continued(first, settings.transition, offset, place_noise),
                            b = continued(second, settings.transition, 1 - offset, place_noise);
            const double difference = b.value - a.value, slope = b.slope + a.slope;
            if (!(std::abs(slope) > 0))
                break;
            const double limit = static_cast<double>(settings.transition) + 1;
            const double moved = std::clamp(offset - difference / slope, -limit, limit + 1);
            time_error = spacing * std::hypot(a.error, b.error) / std::abs(slope);
            const bool stands = std::abs(moved - offset) < 1e-12;
            offset = moved;
            if (stands)
                break;
        }
    }
    const Continued a = continued(rows_before(values), settings.transition, offset, noise),
                    b = continued(rows_after(values), settings.transition, 1 - offset, noise);
    // The error of the time adds to those of the velocities. Slopes are in the direction away from the impact.
    const double late = time_error / spacing, off_before = a.slope * late, off_after = b.slope * late;
    return {rows.times[i] + offset * spacing, time_error, a.value,
            std::hypot(a.error, off_before),  b.value,    std::hypot(b.error, off_after),
            -off_before * off_after};
}

ImpactFinder::ImpactFinder(std::shared_ptr<SampleSource> source, const ImpactSettings& settings) {
    const std::size_t channels = required(source, "a source")->header().channels.size();
    require_index(settings.velocity, channels, "channel");
    if (settings.displacement)
        require_index(*settings.displacement, channels, "channel");
    if (settings.window < settings.least_window || settings.window > settings.most_window ||
        settings.transition > settings.most_window)
        throw InputError(fmt::format("{} samples do not determine the velocities at an impact", settings.window),
                         "take 5 or more, and up to 100000");
    if (!(settings.significance > 0) || !std::isfinite(settings.significance) || !(settings.least_jump >= 0) ||
        !std::isfinite(settings.least_jump))
        throw InputError("the least jump or its significance is not a positive number", "give positive ones");
    state_ = std::make_unique<State>(std::move(source), settings);
}

ImpactFinder::~ImpactFinder() = default;

bool ImpactFinder::next(std::vector<RecordedImpact>& impacts) {
    impacts.clear();
    State& state = *state_;
    if (!state.window.next())
        return false;
    const Samples& rows = state.window.samples();
    const std::vector<double>& values = rows.values[state.settings.velocity];
    const double spacing = 1 / sampling_frequency(rows.times), noise = noise_of(values);
    const double place_noise = state.settings.displacement ? noise_of(rows.values[*state.settings.displacement]) : 0;
    const std::size_t reach = state.settings.window + state.settings.transition;
    // Impacts outside the requested rows are also looked for, as they limit the samples of those inside.
    std::vector<double> sizes(rows.rows(), 0.0);
    for (std::size_t i = reach; i + reach + 1 < rows.rows(); ++i)
        sizes[i] = state.significance(values, i, noise);
    std::vector<std::size_t> found;
    const std::size_t near = std::max(nearest_samples, 2 * state.settings.transition + 1);
    for (std::size_t i = reach; i + reach + 1 < rows.rows(); ++i) {
        if (sizes[i] == 0)
            continue;
        const std::size_t first = i - std::min(i, near), last = std::min(rows.rows() - 1, i + near);
        bool greatest = true;
        for (std::size_t k = first; k <= last && greatest; ++k)
            greatest = k == i || sizes[k] < sizes[i] || (sizes[k] == sizes[i] && k > i);
        if (greatest)
            found.push_back(i);
    }
    for (std::size_t f = 0; f < found.size(); ++f) {
        if (found[f] < state.window.first() || found[f] >= state.window.last())
            continue;
        const std::size_t from = f > 0 ? found[f - 1] + 1 : 0,
                          to = f + 1 < found.size() ? found[f + 1] + 1 : rows.rows();
        impacts.push_back(state.impact_at(found[f], from, to, spacing, noise, place_noise));
    }
    return true;
}

ImpactSettings impact_settings(const RecordHeader& header, const std::string& velocity, const std::string& displacement,
                               const ImpactWindow& window) {
    ImpactSettings settings{window};
    settings.velocity = header.channel(velocity, "channel");
    if (!displacement.empty())
        settings.displacement = header.channel(displacement, "displacement");
    return settings;
}

std::vector<RecordedImpact> find_impacts(SampleSource& source, const ImpactSettings& settings) {
    constexpr std::size_t most = 1'000'000;
    ImpactFinder finder(borrowed(source), settings);
    std::vector<RecordedImpact> all, some;
    while (finder.next(some)) {
        all.insert(all.end(), some.begin(), some.end());
        if (all.size() > most)
            throw InputError(fmt::format("there are more than {} impacts", most), "take a shorter part of the record");
    }
    return all;
}

} // namespace graze
