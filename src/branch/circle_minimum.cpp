#include "branch/circle_minimum.hpp"

#include "base/special_numbers.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

namespace graze {

namespace {

struct Sample {
    double turns = 0, value = 0;
};

/// Returns where the parabola through three samples is least; none where it has no least value.
std::optional<double> lowest_of_parabola(const Sample& one, const Sample& two, const Sample& three) {
    const double first = (two.value - one.value) / (two.turns - one.turns),
                 second = (three.value - two.value) / (three.turns - two.turns),
                 curvature = (second - first) / (three.turns - one.turns),
                 turns = 0.5 * (one.turns + two.turns - first / curvature);
    return curvature > 0 && std::isfinite(turns) ? std::optional(turns) : std::nullopt;
}

/// Finds the least value between two angles by parabolas through the three lowest angles so far, and by golden sections
/// where these do not serve (R. P. Brent, Algorithms for Minimization without Derivatives, 1973): the function bends
/// abruptly where the extremum of a motion passes an end of its return.
class LeastBetween {
public:
    LeastBetween(const Sample& before, const Sample& middle, const Sample& after)
        : low_(before.turns), high_(after.turns), best_(middle), second_(before), third_(after) {
        if (third_.value < second_.value)
            std::swap(second_, third_);
    }

    /// @param range of the function around the circle
    double find(const std::function<std::optional<double>(double turns)>& value, double range) {
        constexpr int evaluations = 80, enough_alike = 2;
        constexpr double enough = 1e-14; // change of the value, relative to its range
        constexpr double closest = 1e-9; // in turns: the value is flat to within its round-off
        int alike = 0;
        for (int i = 0; i < evaluations && alike < enough_alike && high_ - low_ > 4 * closest; ++i) {
            const double turns = next_place(closest);
            if (std::abs(turns - 0.5 * (low_ + high_)) + 0.5 * (high_ - low_) <= 2 * closest)
                break;
            const auto found = value(turns);
            if (!found)
                break;
            alike = std::abs(*found - best_.value) <= enough * range ? alike + 1 : 0;
            note({turns, *found});
        }
        return best_.value;
    }

private:
    double next_place(double closest) {
        constexpr double golden_share = 0.381966011250105;
        const auto lowest = lowest_of_parabola(second_, best_, third_);
        const bool inside = lowest && *lowest > low_ + closest && *lowest < high_ - closest;
        // Steps that do not halve at every other time are not about to converge.
        if (inside && std::abs(*lowest - best_.turns) < 0.5 * before_last_) {
            const double step = *lowest - best_.turns;
            before_last_ = std::exchange(last_, std::abs(step));
            return std::abs(step) >= closest ? *lowest : best_.turns + std::copysign(closest, step);
        }
        const double side = high_ - best_.turns > best_.turns - low_ ? high_ - best_.turns : low_ - best_.turns;
        before_last_ = std::abs(side);
        last_ = golden_share * std::abs(side);
        return best_.turns + golden_share * side;
    }

    void note(const Sample& next) {
        const bool is_lower = next.value <= best_.value;
        const Sample& inner = is_lower ? best_ : next; // an end of the interval that is left
        ((inner.turns < (is_lower ? next : best_).turns) ? low_ : high_) = inner.turns;
        if (is_lower) {
            third_ = second_;
            second_ = best_;
            best_ = next;
        } else if (next.value <= second_.value) {
            third_ = std::exchange(second_, next);
        } else if (next.value <= third_.value) {
            third_ = next;
        }
    }

    double low_, high_;
    Sample best_, second_, third_; ///< the lowest three
    double last_ = 1, before_last_ = 1;
};

} // namespace

double least_around(std::span<const double> samples, const std::function<std::optional<double>(double turns)>& value) {
    const std::size_t count = samples.size();
    const double spacing = 1 / static_cast<double>(count);
    double least = infinity, greatest = -infinity;
    for (const double sample : samples) {
        least = std::min(least, sample);
        if (std::isfinite(sample))
            greatest = std::max(greatest, sample);
    }
    const double range = greatest - least;
    for (std::size_t j = 0; j < count; ++j) {
        const auto at = [&](std::size_t k, double turns) { return Sample{turns, samples[k % count]}; };
        const double here = spacing * static_cast<double>(j);
        const Sample before = at(j + count - 1, here - spacing), middle = at(j, here),
                     after = at(j + 1, here + spacing);
        if (!(middle.value <= before.value && middle.value <= after.value))
            continue;
        // Between three samples of a smooth function it hardly falls below the lowest by more than they differ.
        const double fall = std::max(before.value, after.value) - middle.value;
        if (middle.value - fall <= least && fall > 0)
            least = std::min(least, LeastBetween(before, middle, after).find(value, range));
    }
    return least;
}

} // namespace graze
