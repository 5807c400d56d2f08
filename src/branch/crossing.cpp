#include "branch/crossing.hpp"

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

/// Returns the zero of the polynomial through the samples, which lies between the first and the last.
double zero_of(const std::vector<Sample>& samples) {
    double low = samples.front().fraction, high = samples.back().fraction;
    const bool negative = samples.front().value < 0;
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

/// Returns the vertex of the parabola through three points, with its value.
TestValue vertex_of(const TestValue& before, const TestValue& low, const TestValue& high) {
    const double first = (low.value - before.value) / (low.fraction - before.fraction),
                 second = (high.value - low.value) / (high.fraction - low.fraction),
                 curvature = (second - first) / (high.fraction - before.fraction);
    // p(s) = low + second (s - low) + curvature (s - low) (s - high)
    const double vertex = 0.5 * (low.fraction + high.fraction) - 0.5 * second / curvature;
    return {vertex, low.value + second * (vertex - low.fraction) +
                        curvature * (vertex - low.fraction) * (vertex - high.fraction)};
}

/// Returns a point between a distant `end` and the vertex of a parabola that has the sign of `end` but lies near the
/// zero; `end` itself if none is found.
TestValue nearer(const TestValue& end, const TestValue& vertex, const std::function<double(double)>& value_at) {
    constexpr double behind = 2, far = 0.5; // factors of the distance of the zero, and of the distance of the end
    const double share = behind * std::sqrt(vertex.value / (vertex.value - end.value));
    if (!(share < far))
        return end;
    TestValue result{vertex.fraction + share * (end.fraction - vertex.fraction), 0};
    result.value = value_at(result.fraction);
    return result.value * end.value > 0 ? result : end;
}

} // namespace

std::optional<ContinuationPoint> locate_crossing(Continuation& continuation, const PointTest& test,
                                                 const TestValue& begin, const TestValue& end, double reach,
                                                 std::span<const double> offsets) {
    double low = begin.fraction, high = end.fraction;
    double guess = low + (high - low) * begin.value / (begin.value - end.value);
    if (!std::isfinite(guess)) // a test may be infinite, as multipliers near a touch
        return std::nullopt;
    for (int round = 0; round < most_rounds; ++round) {
        std::vector<Sample> samples;
        for (const double offset : offsets) {
            Sample sample{guess + reach * offset, {}};
            if (!continuation.between(sample.fraction, sample.point))
                continue;
            sample.value = test(sample.point);
            if (std::isfinite(sample.value))
                samples.push_back(std::move(sample));
        }
        if (samples.size() < fewest_samples)
            return std::nullopt;
        if (samples.front().value * samples.back().value < 0) {
            const double zero = zero_of(samples);
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

std::optional<double> possible_dip(const TestValue& before, const TestValue& low, const TestValue& high) {
    const auto [vertex, least] = vertex_of(before, low, high);
    if (!(vertex > low.fraction && vertex < high.fraction))
        return std::nullopt;
    constexpr double near = 0.25;
    const double sign = low.value < 0 ? -1 : 1;
    const bool close = sign * least < near * std::min(std::abs(low.value), std::abs(high.value));
    return close ? std::optional(vertex) : std::nullopt;
}

std::optional<Dip> dip_between(TestValue low, TestValue high, double within,
                               const std::function<double(double)>& value_at) {
    constexpr int most = 8;
    // Share of the values at the ends: smaller values are round-off, as where a test only touches zero.
    constexpr double deep = 1e-10;
    const double sign = low.value < 0 ? -1 : 1, size = std::min(std::abs(low.value), std::abs(high.value));
    TestValue middle{within, value_at(within)};
    for (int i = 0; i < most; ++i) {
        if (sign * middle.value < -deep * size)
            return Dip{nearer(low, middle, value_at), middle, nearer(high, middle, value_at)};
        const auto [vertex, least] = vertex_of(low, middle, high);
        const bool inside = vertex > low.fraction && vertex < high.fraction && vertex != middle.fraction;
        if (!inside || !(sign * middle.value < size) || !(sign * least < 0.5 * sign * middle.value))
            return std::nullopt;
        const TestValue next{vertex, value_at(vertex)};
        const bool before = next.fraction < middle.fraction;
        if (sign * next.value < sign * middle.value) {
            (before ? high : low) = middle;
            middle = next;
        } else {
            (before ? low : high) = next;
        }
    }
    return std::nullopt;
}

} // namespace graze
