#include "flow/single_crossing.hpp"

#include "base/special_numbers.hpp"
#include "flow/kept_sign.hpp"
#include "graze/flow/roots.hpp"

namespace graze::roots {

double guess_of_monotone(std::span<const double> c, double length, const PointValue& end) {
    const double change = end.value - c[0], t = -c[0] / change, rest = 1 - t;
    return t * t * (3 - 2 * t) * length + change * t * rest * (rest / c[1] - t / end.slope);
}

std::optional<SingleCrossing> single_crossing(std::span<const double> c, double length) {
    if (c.empty() || c[0] == 0 || !(length > 0) || !(length < infinity))
        return std::nullopt;
    const int at_start = c[0] > 0 ? 1 : -1;
    const PointValue end = evaluate(c, length);
    const int at_end = end.sign();
    if (at_end == at_start && kept_sign(c, length) == at_start)
        return SingleCrossing{false, at_start, end};
    if (at_end == 0 || RootFinder::trend(c, length) == 0)
        return std::nullopt;
    return SingleCrossing{at_end != at_start, at_start, end};
}

double SingleCrossing::place(std::span<const double> c, double length) const {
    return refine(c, 0, length, at_start, guess_of_monotone(c, length, end));
}

} // namespace graze::roots
