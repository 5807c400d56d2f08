#include "symbolic/merged_boxes.hpp"

#include <algorithm>
#include <cstddef>
#include <span>
#include <utility>

namespace graze {

namespace {

bool is_before(const IntervalBox& one, const IntervalBox& other) {
    return std::ranges::lexicographical_compare(one, other, {}, &Interval::lower, &Interval::lower);
}

bool touch(const IntervalBox& one, const IntervalBox& other, std::span<const double> gaps, double part) {
    for (std::size_t i = 0; i < one.size(); ++i) {
        const double most = std::max(gaps[i], part * std::max(one[i].width(), other[i].width()));
        if (one[i].lower - other[i].upper > most || other[i].lower - one[i].upper > most)
            return false;
    }
    return true;
}

} // namespace

std::vector<IntervalBox> merged_boxes(std::vector<IntervalBox> boxes, std::span<const double> gaps, double part) {
    std::ranges::sort(boxes, is_before);
    std::vector<IntervalBox> result;
    for (IntervalBox& box : boxes) {
        // A box that grows may touch those that it has passed.
        for (std::size_t k = 0; k < result.size();) {
            if (!touch(box, result[k], gaps, part)) {
                ++k;
                continue;
            }
            for (std::size_t i = 0; i < box.size(); ++i)
                box[i] = hull(box[i], result[k][i]);
            std::swap(result[k], result.back());
            result.pop_back();
            k = 0;
        }
        result.push_back(std::move(box));
    }
    std::ranges::sort(result, is_before);
    return result;
}

} // namespace graze
