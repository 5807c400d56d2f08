#include "branch/test_zero_search.hpp"

#include "base/special_numbers.hpp"

#include <algorithm>
#include <cmath>

namespace graze {

namespace {

constexpr std::size_t most_values = 4; ///< that are interpolated

/// Returns the place of the value zero on the polynomial that gives places by values; not a number where two values are
/// equal.
double place_of_zero(std::vector<TestValue> known) {
    // Neville's scheme.
    for (std::size_t order = 1; order < known.size(); ++order)
        for (std::size_t i = 0; i + order < known.size(); ++i) {
            const double first = known[i].value, last = known[i + order].value;
            known[i].fraction = first == last
                                    ? not_a_number
                                    : (last * known[i].fraction - first * known[i + 1].fraction) / (last - first);
        }
    return known.front().fraction;
}

} // namespace

TestZeroSearch::TestZeroSearch(TestValue low, TestValue high, double within, std::optional<TestValue> outside)
    : low_(low), high_(high), within_(within), width_(high.fraction - low.fraction),
      first_size_(std::fmax(std::abs(low.value), std::abs(high.value))), size_(first_size_) {
    if (outside && std::isfinite(outside->value))
        others_.push_back(*outside);
}

/// Returns the zero by the last values, by as many of them as have it within the bracket; the last two always do.
std::optional<double> TestZeroSearch::interpolated() const {
    if (!std::isfinite(low_.value) || !std::isfinite(high_.value))
        return std::nullopt;
    const double slack = 0.25 * within_; // an end that has nearly the value zero may be the zero
    const auto inside = [&](double place) { return std::clamp(place, low_.fraction + slack, high_.fraction - slack); };
    std::vector<TestValue> known{low_, high_};
    known.insert(known.end(), others_.begin(), others_.end());
    for (; known.size() > 2; known.pop_back())
        if (const double place = place_of_zero(known); place > low_.fraction - slack && place < high_.fraction + slack)
            return inside(place);
    return inside(place_of_zero(known));
}

std::optional<double> TestZeroSearch::next() {
    constexpr double near = 1e-9, small = 1e-7; // where a value that does not decrease is round-off, and no jump
    constexpr int patience = 2;
    const double width = high_.fraction - low_.fraction, middle = low_.fraction + 0.5 * width;
    if (width <= within_ || (last_ && last_->value == 0))
        return std::nullopt;
    const std::optional<double> zero = interpolated();
    if (zero && last_) {
        const double move = std::abs(*zero - last_->fraction), value = std::abs(last_->value);
        if (move <= within_ || (move <= near && value < small * first_size_ && value > 0.25 * std::abs(before_)))
            return std::nullopt;
    }
    place_ = zero.value_or(middle);
    if (last_ && evaluations_ % patience == 0) {
        // Interpolation helps where values, or the bracket, become much smaller.
        const double size = std::abs(last_->value);
        if (!(size < 0.1 * size_) && !(width < 0.3 * width_))
            place_ = middle;
        size_ = size;
        width_ = width;
    }
    return place_;
}

void TestZeroSearch::add(double value) {
    ++evaluations_;
    before_ = last_ ? last_->value : not_a_number;
    last_ = {place_, value};
    TestValue& end = (value < 0) == (low_.value < 0) ? low_ : high_;
    if (std::isfinite(end.value))
        others_.insert(others_.begin(), end);
    others_.resize(std::min(others_.size(), most_values - 2));
    end = *last_;
}

} // namespace graze
