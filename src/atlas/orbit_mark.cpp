#include "atlas/orbit_mark.hpp"

#include <algorithm>
#include <cmath>

namespace graze {

namespace {

/// Of the state to which an extent belongs: its greatest magnitude.
double size_of(const OrbitMark& mark, std::size_t index) {
    const std::size_t other = index ^ 1U;
    const double size = std::abs(mark.extents[index]);
    return other < mark.extents.size() ? std::max(size, std::abs(mark.extents[other])) : size;
}

bool is_same_period(double one, double other, bool multiples) {
    const double ratio = std::max(one, other) / std::min(one, other);
    const double nearest = multiples ? std::min(2.0, std::round(ratio)) : 1.0;
    return std::abs(ratio - nearest) < same_extent;
}

} // namespace

void MarkScales::fit(const std::vector<const OrbitMark*>& marks) {
    extents.assign(marks.empty() ? 0 : marks.front()->extents.size(), 0);
    for (std::size_t i = 0; i < extents.size(); ++i) {
        std::vector<double> sizes;
        for (const OrbitMark* const mark : marks)
            if (const double size = size_of(*mark, i); std::isfinite(size))
                sizes.push_back(size);
        if (sizes.empty())
            continue;
        const auto middle = sizes.begin() + static_cast<std::ptrdiff_t>(sizes.size() / 2);
        std::ranges::nth_element(sizes, middle);
        extents[i] = *middle;
    }
}

double MarkScales::extent(std::size_t index, const OrbitMark& one, const OrbitMark& other) const {
    constexpr double idle = 1e-6; // of a state that hardly moves on either orbit
    double scale = idle * extents[index];
    for (const double size : {size_of(one, index), size_of(other, index)})
        if (std::isfinite(size))
            scale = std::max(scale, size);
    return scale;
}

bool is_same_place(const OrbitMark& one, const OrbitMark& other, const MarkScales& scales) {
    for (std::size_t i = 0; i < scales.at.size(); ++i) {
        // A box may be much wider than the values at which something happens.
        const double size = std::max(std::abs(one.at[i]), std::abs(other.at[i])) + 1e-6 * scales.at[i];
        if (!(std::abs(one.at[i] - other.at[i]) <= same_place * std::min(size, scales.at[i])))
            return false;
    }
    return true;
}

bool has_same_extents(const OrbitMark& one, const OrbitMark& other, const MarkScales& scales, double tolerance) {
    for (std::size_t i = 0; i < scales.extents.size(); ++i)
        if (!(std::abs(one.extents[i] - other.extents[i]) <= tolerance * scales.extent(i, one, other)))
            return false;
    return true;
}

bool is_same_orbit(const OrbitMark& one, const OrbitMark& other, const MarkScales& scales, bool multiples) {
    return is_same_place(one, other, scales) && is_same_period(one.period, other.period, multiples) &&
           has_same_extents(one, other, scales);
}

} // namespace graze
