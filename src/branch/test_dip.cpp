#include "branch/test_dip.hpp"

#include "base/signs.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace graze {

namespace {

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

std::optional<Dip> dip_between(const TestValue& low, const TestValue& high, double within, double noise,
                               const std::function<double(double)>& value_at) {
    DipSearch search(low, high, low.value < 0 ? -1 : 1, noise, value_at);
    return search.find(within);
}

} // namespace graze
