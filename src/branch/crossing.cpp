#include "branch/crossing.hpp"

#include "base/signs.hpp"
#include "base/special_numbers.hpp"
#include "orbit/eigen_index.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

namespace graze {

namespace {

constexpr std::size_t fewest_samples = 6;
constexpr int most_rounds = 8;
constexpr double settled = 0.015;
/// Tolerance by which the zero may lie outside its bracket.
constexpr double uncertain_share = 1e-3;

struct Sample {
    double fraction;
    ContinuationPoint point;
    double value = 0;
};

/// Returns the Lagrange weights of the samples at a fraction.
std::vector<double> weights_at(const std::vector<Sample>& samples, double fraction) {
    std::vector<double> weights(samples.size(), 1.0);
    for (std::size_t i = 0; i < samples.size(); ++i)
        for (std::size_t j = 0; j < samples.size(); ++j)
            if (i != j)
                weights[i] *= (fraction - samples[j].fraction) / (samples[i].fraction - samples[j].fraction);
    return weights;
}

double value_at(const std::vector<Sample>& samples, double fraction) {
    const std::vector<double> weights = weights_at(samples, fraction);
    double sum = 0;
    for (std::size_t i = 0; i < samples.size(); ++i)
        sum += weights[i] * samples[i].value;
    return sum;
}

/// Returns the zero of the polynomial through the samples between two fractions. @param negative its sign at the first
double zero_of(const std::vector<Sample>& samples, double low, double high, bool negative) {
    constexpr int halvings = 60;
    for (int i = 0; i < halvings; ++i) {
        const double middle = 0.5 * (low + high);
        ((value_at(samples, middle) < 0) == negative ? low : high) = middle;
    }
    return 0.5 * (low + high);
}

ContinuationPoint point_between(const std::vector<Sample>& samples, double fraction) {
    const std::vector<double> weights = weights_at(samples, fraction);
    ContinuationPoint result;
    result.u.assign(samples[0].point.u.size(), 0.0);
    result.tangent.assign(result.u.size(), 0.0);
    for (std::size_t i = 0; i < samples.size(); ++i) {
        entries_of(result.u) += weights[i] * vector_of(samples[i].point.u);
        entries_of(result.tangent) += weights[i] * vector_of(samples[i].point.tangent);
        result.arclength += weights[i] * samples[i].point.arclength;
    }
    return result;
}

/// Returns the solutions, with values of the test, at offsets from a fraction of the step.
std::vector<Sample> samples_around(Continuation& continuation, const PointTest& test, double centre, double reach,
                                   std::span<const double> offsets) {
    std::vector<Sample> samples;
    for (const double offset : offsets) {
        Sample sample{centre + reach * offset, {}};
        if (!continuation.between(sample.fraction, sample.point))
            continue;
        sample.value = test(sample.point);
        if (std::isfinite(sample.value))
            samples.push_back(std::move(sample));
    }
    return samples;
}

/// Returns the two zeros of the polynomial through samples of one sign, on both sides of a value of the other sign.
std::optional<std::pair<double, double>> zeros_around(const std::vector<Sample>& samples, double within) {
    const double low = samples.front().fraction, high = samples.back().fraction;
    const bool negative = samples.front().value < 0;
    if (have_opposite_signs(samples.front().value, samples.back().value) || (value_at(samples, within) < 0) == negative)
        return std::nullopt;
    return std::pair(zero_of(samples, low, within, negative), zero_of(samples, within, high, !negative));
}

} // namespace

std::optional<std::pair<ContinuationPoint, ContinuationPoint>> locate_pair(Continuation& continuation,
                                                                           const PointTest& test, const Dip& dip) {
    constexpr double clear = 2, same = 0.05; // distance of samples, and of zeros that agree, in distances of the zeros
    constexpr double nearest = usual_offsets[4], least = 1e-7;
    const double centre = dip.within.fraction;
    double first = not_a_number, second = not_a_number; // of the last round
    for (double reach = 1; reach * nearest > least; reach *= 0.5) {
        const std::vector<Sample> samples = samples_around(continuation, test, centre, reach, usual_offsets);
        if (samples.size() < fewest_samples)
            return std::nullopt;
        const auto zeros = zeros_around(samples, centre);
        const double apart = zeros ? zeros->second - zeros->first : 0;
        if (zeros && std::abs(zeros->first - first) < same * apart && std::abs(zeros->second - second) < same * apart)
            return std::pair(point_between(samples, zeros->first), point_between(samples, zeros->second));
        if (reach * nearest < clear * apart)
            return std::nullopt;
        first = zeros ? zeros->first : not_a_number;
        second = zeros ? zeros->second : not_a_number;
    }
    return std::nullopt;
}

std::optional<ContinuationPoint> locate_crossing(Continuation& continuation, const PointTest& test,
                                                 const TestValue& begin, const TestValue& end, double reach,
                                                 std::span<const double> offsets) {
    double low = begin.fraction, high = end.fraction;
    double guess = low + (high - low) * begin.value / (begin.value - end.value);
    if (!std::isfinite(guess)) // a test may be infinite, as multipliers near a touch
        return std::nullopt;
    for (int round = 0; round < most_rounds; ++round) {
        const std::vector<Sample> samples = samples_around(continuation, test, guess, reach, offsets);
        if (samples.size() < fewest_samples)
            return std::nullopt;
        if (have_opposite_signs(samples.front().value, samples.back().value)) {
            const double zero =
                zero_of(samples, samples.front().fraction, samples.back().fraction, samples.front().value < 0);
            if (std::abs(zero - guess) < reach * settled) {
                const bool inside =
                    zero > begin.fraction - reach * uncertain_share && zero < end.fraction + reach * uncertain_share;
                return inside ? std::optional(point_between(samples, zero)) : std::nullopt;
            }
            guess = zero;
            continue;
        }
        // The samples do not bracket the zero: bisect.
        const bool before = (samples.front().value < 0) == (begin.value < 0);
        (before ? low : high) = std::clamp(guess, low, high);
        guess = 0.5 * (low + high);
    }
    return std::nullopt;
}

} // namespace graze
