#include "graze/flow/tangent_reach.hpp"

#include "graze/flow/step_check.hpp"
#include "graze/symbolic/require.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace graze {

namespace {

/// What is so small against anything a double can hold that nothing may be said of its relative accuracy.
constexpr double nothing = 1e-200;
constexpr std::size_t most_lanes = 32;

/// Size of a series whose first three terms are zero.
double size_of_all(const double* c, std::size_t width, std::size_t order, double step) {
    double sum = 0;
    for (std::size_t k = order + 1; k-- > 0;)
        sum = sum * step + std::abs(c[k * width]);
    return sum;
}

/// The largest difference between slopes of derivatives and what the variational equations say, in units of what is
/// allowed.
double misfit_at(const Jet& jet, Jet& next, std::size_t states, std::size_t count, double tolerance, double step,
                 std::span<double> times, std::span<double> sums, std::span<double> slopes) {
    constexpr double roundoff = 1e4 * 0x1p-53;
    const auto order = static_cast<std::size_t>(jet.order()), width = static_cast<std::size_t>(jet.width());
    std::fill(times.begin(), times.end(), step);
    jet.evaluate_states(times, sums, slopes);
    next.begin(sums);
    const double length = std::abs(step);
    double most = 0;
    for (std::size_t i = 0; i < states; ++i) {
        const double* c = jet.state(i) + 1;
        const double* rates = next.state(i) + width + 1;
        for (std::size_t l = 0; l < count; ++l) {
            const double difference = length * std::abs(slopes[i * width + l + 1] - rates[l]);
            double size = StepCheck::size_over(c[l], c[width + l], sums[i * width + l + 1], rates[l], length);
            if (difference <= StepCheck::allowance * tolerance * size)
                continue;
            size = std::max(size, size_of_all(c + l, width, order, length));
            const double ratio = difference / ((StepCheck::allowance * tolerance + roundoff) * size);
            most = std::isnan(ratio) ? std::numeric_limits<double>::infinity() : std::max(most, ratio);
        }
    }
    return most;
}

} // namespace

double tangent_reach(const Jet& jet, std::size_t states, std::size_t count, double tolerance, double step) {
    const auto order = static_cast<std::size_t>(jet.order()), width = static_cast<std::size_t>(jet.width());
    require_index(count, std::min(width, most_lanes + 1), "number of derivatives");
    const double root = 1.0 / static_cast<double>(order - 1);
    double reach = step;
    // Sizes shrink with the step: a few rounds.
    for (int round = 0; round < 6; ++round) {
        double power = 1, worst = 0;
        for (std::size_t k = 1; k < order; ++k)
            power *= reach;
        for (std::size_t i = 0; i < states; ++i) {
            const double* c = jet.state(i) + 1;
            std::array<double, most_lanes> sizes, lasts;
            for (std::size_t l = 0; l < count; ++l) {
                sizes[l] = std::abs(c[l]) + reach * (std::abs(c[width + l]) + reach * std::abs(c[2 * width + l]));
                lasts[l] =
                    power * std::max(std::abs(c[(order - 1) * width + l]), reach * std::abs(c[order * width + l]));
            }
            for (std::size_t l = 0; l < count; ++l) {
                const double size = sizes[l] > 0 || lasts[l] == 0 ? sizes[l] : size_of_all(c + l, width, order, reach);
                if (lasts[l] > worst * size && size > nothing)
                    worst = lasts[l] / size;
            }
        }
        if (!(worst > tolerance))
            break;
        reach *= std::pow(tolerance / worst, root);
    }
    return std::isfinite(reach) && reach > 0 ? reach : step;
}

double follow_tangents(const Jet& jet, Jet& next, std::size_t states, std::size_t count, double tolerance, double step,
                       std::span<double> times, std::span<double> sums, std::span<double> slopes) {
    require_index(count, static_cast<std::size_t>(jet.width()), "number of derivatives");
    require_room(times.size(), static_cast<std::size_t>(jet.width()), "times");
    // What is left out falls with a high power of the step. What does not is the round-off of rates that cancel, or
    // belongs to derivatives that have only begun to differ from zero: no shorter step would be better.
    constexpr int most_halvings = 8;
    constexpr double least_gain = 0.1;
    double part = step, first = 0;
    for (int halving = 0; halving <= most_halvings; ++halving, part *= 0.5) {
        const double misfit = misfit_at(jet, next, states, count, tolerance, part, times, sums, slopes);
        if (misfit <= 1)
            return part;
        if (halving == 0)
            first = misfit;
        else if (halving == most_halvings && std::isfinite(misfit) && misfit > least_gain * first)
            break;
        else if (halving == most_halvings)
            return part;
    }
    misfit_at(jet, next, states, count, tolerance, step, times, sums, slopes);
    return step;
}

} // namespace graze
