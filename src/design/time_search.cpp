#include "design/time_search.hpp"

#include "design/scaled_wishes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

namespace graze {

namespace {

constexpr std::size_t most_of_one = 200; ///< evaluations for one anchor

} // namespace

std::vector<double> values_of(const FoundDesign& found) {
    std::vector<double> values;
    for (const FoundDimension& one : found.dimensions)
        values.push_back(one.value);
    return values;
}

TimeSearch::TimeSearch(const WishList& list, const WishOptions& options)
    : time_(list.wants.back()), others_(list), options_(options), left_(options.evaluations) {
    others_.wants.pop_back();
    options_.starts = 1;
    for (const Dimension& one : list.dimensions)
        first_.push_back(one.start);
}

FoundDesign TimeSearch::run(const FoundDesign& nearest) {
    constexpr std::size_t anchors = 24;
    constexpr int halvings = 12;
    FoundDesign best = timed(nearest);
    for (std::size_t k = 1; k <= anchors && left_ > 0; ++k)
        consider(best, anchored(scattered(k)));
    if (!is_met(best))
        return finished(std::move(best), false);
    const std::vector<double> end = values_of(best);
    double low = 0, high = 1;
    for (int i = 0; i < halvings && left_ > 0; ++i) {
        const double middle = (low + high) / 2;
        std::vector<double> anchor = first_;
        for (std::size_t d = 0; d < anchor.size(); ++d)
            anchor[d] += middle * (end[d] - anchor[d]);
        const FoundDesign one = anchored(anchor);
        (one.outcome == WishOutcome::met && is_met(one) ? high : low) = middle;
        consider(best, one);
    }
    return finished(std::move(best), true);
}

bool TimeSearch::is_met(const FoundDesign& one) const {
    return one.wants.size() > others_.wants.size() && one.wants.back().met;
}

/// Returns point `number` of the Halton sequence within the ranges.
std::vector<double> TimeSearch::scattered(std::size_t number) const {
    constexpr std::size_t primes[] = {2, 3, 5, 7, 11, 13, 17, 19, 23, 29, 31, 37};
    std::vector<double> result;
    for (std::size_t d = 0; d < first_.size(); ++d) {
        const double share = scattered_share(number, primes[d % std::size(primes)]);
        const Dimension& one = others_.dimensions[d];
        result.push_back(one.lowest + share * (one.highest - one.lowest));
    }
    return result;
}

/// Finds the device nearest to an anchor that meets the other requirements, with its trip time.
FoundDesign TimeSearch::anchored(const std::vector<double>& anchor) {
    WishList list = others_;
    for (std::size_t d = 0; d < anchor.size(); ++d)
        list.dimensions[d].start = std::clamp(anchor[d], list.dimensions[d].lowest, list.dimensions[d].highest);
    options_.evaluations = std::min(left_, most_of_one);
    FoundDesign found = design_for(list, options_);
    left_ -= std::min(left_, found.evaluations);
    spent_ += found.evaluations;
    return timed(std::move(found));
}

FoundDesign TimeSearch::timed(FoundDesign found) {
    if (found.outcome != WishOutcome::met)
        return found;
    FoundWant time = found_want(time_, time_.value(values_of(found)).value);
    time.binds = true;
    found.wants.push_back(time);
    found.violation = std::max(found.violation, time.violation);
    found.distance = 0;
    for (std::size_t d = 0; d < first_.size(); ++d) {
        const Dimension& one = others_.dimensions[d];
        const double width = one.highest - one.lowest, way = found.dimensions[d].value - first_[d];
        found.distance = std::hypot(found.distance, width > 0 ? way / width : 0);
    }
    return found;
}

/// A device that meets all is better than one that does not; then the nearer, or the faster.
void TimeSearch::consider(FoundDesign& best, const FoundDesign& one) const {
    if (one.outcome != WishOutcome::met)
        return;
    const bool here = is_met(one), there = is_met(best);
    if (here != there ? here : here ? one.distance < best.distance : one.violation < best.violation)
        best = one;
}

FoundDesign TimeSearch::finished(FoundDesign best, bool met) const {
    best.evaluations = spent_;
    best.stationary = false;
    best.outcome = met ? WishOutcome::met : WishOutcome::unmet;
    if (!met)
        best.reason = fmt::format(
            "the other wishes are met, but no device that meets them was found whose trip "
            "time is at most {:.6g}; the shortest was {}",
            time_.most, best.wants.back().value ? fmt::format("{:.6g}", *best.wants.back().value) : "not known");
    return best;
}

} // namespace graze
