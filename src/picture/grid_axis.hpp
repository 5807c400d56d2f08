#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

namespace graze {

/// A range in whose middle a single value is shown.
inline std::pair<double, double> range_about(double value) {
    const double half = value == 0 ? 1 : 0.1 * std::abs(value);
    return {value - half, value + half};
}

/// The values of one axis of a grid, and the edges between their cells.
class GridAxis {
public:
    GridAxis(std::vector<double> values, bool logarithmic) : values_(std::move(values)) {
        std::sort(values_.begin(), values_.end());
        values_.erase(std::unique(values_.begin(), values_.end()), values_.end());
        logarithmic_ = logarithmic && !values_.empty() && values_.front() > 0;
    }
    std::size_t size() const { return values_.size(); }
    std::size_t index(double value) const {
        return static_cast<std::size_t>(std::lower_bound(values_.begin(), values_.end(), value) - values_.begin());
    }
    double middle(double one, double other) const { return logarithmic_ ? std::sqrt(one * other) : (one + other) / 2; }
    /// Edges of the cell of value i; those at the ends lie as far beyond the value as the other edge lies before it.
    double edge_before(std::size_t i) const { return i == 0 ? beyond(0, 1) : middle(values_[i - 1], values_[i]); }
    double edge_behind(std::size_t i) const {
        return i + 1 == size() ? beyond(i, i - 1) : middle(values_[i], values_[i + 1]);
    }
    /// Both edges, but not beyond the values at the ends, unless there is a single one.
    std::pair<double, double> clipped(std::size_t i) const {
        if (size() == 1)
            return range_about(values_[0]);
        return {std::max(edge_before(i), values_.front()), std::min(edge_behind(i), values_.back())};
    }

private:
    double beyond(std::size_t i, std::size_t adjacent) const {
        return logarithmic_ ? values_[i] * std::sqrt(values_[i] / values_[adjacent])
                            : values_[i] + (values_[i] - values_[adjacent]) / 2;
    }
    std::vector<double> values_;
    bool logarithmic_ = false;
};

} // namespace graze
