#include "branch/crossing.hpp"

#include "base/signs.hpp"
#include "base/special_numbers.hpp"
#include "orbit/eigen_index.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
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

/// Returns half the second derivative of the parabola through three points.
double curvature_of(const TestValue& before, const TestValue& low, const TestValue& high) {
    const double first = (low.value - before.value) / (low.fraction - before.fraction),
                 second = (high.value - low.value) / (high.fraction - low.fraction);
    return (second - first) / (high.fraction - before.fraction);
}

/// Returns the vertex of the parabola through three points, with its value.
TestValue vertex_of(const TestValue& before, const TestValue& low, const TestValue& high) {
    const double second = (high.value - low.value) / (high.fraction - low.fraction),
                 curvature = curvature_of(before, low, high);
    // p(s) = low + second (s - low) + curvature (s - low) (s - high)
    const double vertex = 0.5 * (low.fraction + high.fraction) - 0.5 * second / curvature;
    return {vertex, low.value + second * (vertex - low.fraction) +
                        curvature * (vertex - low.fraction) * (vertex - high.fraction)};
}

/// Returns a point between a distant `end` and a point near the vertex of a parabola that has the sign of `end` but
/// lies near the zero; `end` itself if none is found.
TestValue nearer(const TestValue& end, const TestValue& within, const std::function<double(double)>& value_at) {
    constexpr double behind = 2, far = 0.5; // factors of the distance of the zero, and of the distance of the end
    double share = behind * std::sqrt(within.value / (within.value - end.value));
    for (; share < far; share *= behind) {
        const double fraction = within.fraction + share * (end.fraction - within.fraction), value = value_at(fraction);
        if (have_same_sign(value, end.value))
            return {fraction, value};
    }
    return end;
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

std::optional<double> possible_dip(const TestValue& oldest, const TestValue& before, const TestValue& low,
                                   const TestValue& high) {
    constexpr double near = 0.25;                  // share of the values at the ends
    constexpr double outside = 0.3, inside = 0.05; // shares of the interval
    constexpr double uncertain = 0.1;              // share of the change over the interval
    constexpr int places = 16;
    const double length = high.fraction - low.fraction, sign = low.value < 0 ? -1 : 1;
    const double curvature = curvature_of(before, low, high), change = std::abs(curvature) * length * length;
    // The next coefficient in Newton's form of the cubic through all four.
    const double next = (curvature - curvature_of(oldest, before, low)) / (high.fraction - oldest.fraction),
                 third = std::isfinite(next) ? next : 0;
    const double size = std::min(sign * low.value, sign * high.value);
    if (!(size < change + std::abs(third) * length * length * (high.fraction - before.fraction)))
        return std::nullopt;
    const TestValue vertex = vertex_of(before, low, high);
    const double slope = (high.value - low.value) / length;
    std::optional<double> best;
    double least = std::numeric_limits<double>::infinity();
    for (int i = 0; i <= places; ++i) {
        const double s = low.fraction + length * i / places, both = (s - low.fraction) * (s - high.fraction);
        const double parabola = sign * (low.value + slope * (s - low.fraction) + curvature * both),
                     difference = std::abs(third * both * (s - before.fraction));
        // At an end the extremum may lie on the other side of it, since the parabola is inexact.
        const bool at_end = i == 0 || i == places;
        const double beyond = std::abs(vertex.fraction - s) / length;
        if (parabola - difference < least && (!at_end || beyond < outside)) {
            least = parabola - difference;
            best = s;
        }
    }
    if (!best || !(least < std::max(near * size, uncertain * change)))
        return std::nullopt;
    return std::clamp(*best, low.fraction + inside * length, high.fraction - inside * length);
}

namespace {

/// Searches for two zeros of a test between two values of the same sign.
class DipSearch {
public:
    /// @param sign of the values at the ends
    DipSearch(const TestValue& low, const TestValue& high, double sign, double floor,
              const std::function<double(double)>& value_at)
        : low_(low), high_(high), sign_(sign), floor_(floor), value_at_(value_at) {}

    std::optional<Dip> find(double within) {
        constexpr int most = 12;
        middle_ = {within, value_at_(within)};
        for (int i = 0; i < most; ++i) {
            if (is_beyond())
                return Dip{nearer(low_, middle_, value_at_), middle_, nearer(high_, middle_, value_at_)};
            if (!(sign_ * middle_.value > floor_) || !(narrow() || approach()))
                return std::nullopt;
        }
        return std::nullopt;
    }

private:
    bool is_beyond() const { return sign_ * middle_.value < -floor_; }
    /// Puts a sample in order: the smallest value is the middle one.
    void add(const TestValue& sample) {
        const bool before = sample.fraction < middle_.fraction;
        if (sign_ * sample.value < sign_ * middle_.value) {
            (before ? high_ : low_) = middle_;
            middle_ = sample;
        } else {
            (before ? low_ : high_) = sample;
        }
    }
    /// Where the ends are far, compared with the distance in which the test could reach zero, replaces them by nearer
    /// ones: a parabola through distant values tells nothing of so small a dip. @return true if it has done so
    bool narrow() {
        constexpr double wide = 4, beside = 2; // factors of that distance
        const double curvature = curvature_of(low_, middle_, high_);
        const double reach = std::sqrt(middle_.value / curvature);
        bool narrowed = false;
        for (const double side : {-beside, beside}) {
            const double distance = side < 0 ? middle_.fraction - low_.fraction : high_.fraction - middle_.fraction;
            if (!(wide * reach < distance) || is_beyond())
                continue;
            const double fraction = middle_.fraction + side * reach;
            if (fraction == middle_.fraction)
                continue;
            add({fraction, value_at_(fraction)});
            narrowed = true;
        }
        return narrowed;
    }
    /// Goes to the vertex of the parabola. @return false where no value of the other sign is to be expected
    bool approach() {
        constexpr double smaller = 0.5;
        const auto [vertex, least] = vertex_of(low_, middle_, high_);
        const bool inside = vertex > low_.fraction && vertex < high_.fraction && vertex != middle_.fraction;
        if (!inside || !(sign_ * least < smaller * sign_ * middle_.value))
            return false;
        add({vertex, value_at_(vertex)});
        return true;
    }

    TestValue low_, middle_, high_;
    double sign_, floor_;
    const std::function<double(double)>& value_at_;
};

} // namespace

std::optional<Dip> dip_between(const TestValue& low, const TestValue& high, double within, double noise,
                               const std::function<double(double)>& value_at) {
    DipSearch search(low, high, low.value < 0 ? -1 : 1, noise, value_at);
    return search.find(within);
}

} // namespace graze
