#include "symbolic/linear_contraction.hpp"

#include <vector>

namespace graze {

bool contract(IntervalBox& box, std::span<const double> middle, std::span<const Interval> slopes,
              const Interval& constant) {
    const std::size_t n = box.size();
    std::vector<Interval> terms(n), after(n + 1); // `after` has the sums of the terms from an unknown to the last
    for (std::size_t j = n; j-- > 0;) {
        terms[j] = slopes[j] * (box[j] - Interval::point(middle[j]));
        after[j] = after[j + 1] + terms[j];
    }
    // Derivatives that are nowhere defined say nothing.
    if (after[0].empty() || constant.empty())
        return true;
    Interval before = constant;
    if (!(before + after[0]).contains(0))
        return false;
    for (std::size_t j = 0; j < n; ++j) {
        if (!slopes[j].is_point(0)) {
            const Interval place = Interval::point(middle[j]);
            const Interval offset = intersect_quotient(box[j] - place, -(before + after[j + 1]), slopes[j]);
            const Interval shrunk = intersection(box[j], place + offset);
            if (shrunk.empty())
                return false;
            box[j] = {shrunk.lower, shrunk.upper};
        }
        before = before + terms[j];
    }
    return true;
}

} // namespace graze
