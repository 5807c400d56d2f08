#include "graze/design/wishes.hpp"

#include "design/scaled_wishes.hpp"
#include "design/wish_maker.hpp"
#include "design/yield_score.hpp"
#include "graze/base/require.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

namespace graze {

namespace {

/// Returns the dimensions of a result.
std::vector<double> values_of(const FoundDesign& found) {
    std::vector<double> values;
    for (const FoundDimension& one : found.dimensions)
        values.push_back(one.value);
    return values;
}

/// Searches for a device with a trip time, which is discontinuous (it jumps from cycle to cycle), so gradients do not
/// help. From anchors all over the ranges it finds the nearest devices that meet the other requirements, and computes
/// their trip times; then it bisects between the first device and the best of these.
class TimeSearch {
public:
    /// @param list requirements, of which the trip time is the last; the dimensions start at the first device
    TimeSearch(const WishList& list, const WishOptions& options)
        : time_(list.wants.back()), others_(list), options_(options), left_(options.evaluations) {
        others_.wants.pop_back();
        options_.starts = 1;
        for (const Dimension& one : list.dimensions)
            first_.push_back(one.start);
    }

    /// @param nearest the device nearest to the first that meets the other requirements
    FoundDesign run(const FoundDesign& nearest) {
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

private:
    static constexpr std::size_t most_of_one = 200; ///< evaluations for one anchor

    bool is_met(const FoundDesign& one) const {
        return one.wants.size() > others_.wants.size() && one.wants.back().met;
    }

    /// Returns point `number` of the Halton sequence within the ranges.
    std::vector<double> scattered(std::size_t number) const {
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
    FoundDesign anchored(const std::vector<double>& anchor) {
        WishList list = others_;
        for (std::size_t d = 0; d < anchor.size(); ++d)
            list.dimensions[d].start = std::clamp(anchor[d], list.dimensions[d].lowest, list.dimensions[d].highest);
        options_.evaluations = std::min(left_, most_of_one);
        FoundDesign found = design_for(list, options_);
        left_ -= std::min(left_, found.evaluations);
        spent_ += found.evaluations;
        return timed(std::move(found));
    }

    FoundDesign timed(FoundDesign found) {
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
    void consider(FoundDesign& best, const FoundDesign& one) const {
        if (one.outcome != WishOutcome::met)
            return;
        const bool here = is_met(one), there = is_met(best);
        if (here != there ? here : here ? one.distance < best.distance : one.violation < best.violation)
            best = one;
    }

    FoundDesign finished(FoundDesign best, bool met) const {
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

    Want time_;
    WishList others_;
    WishOptions options_;
    std::vector<double> first_;
    std::size_t left_ = 0, spent_ = 0;
};

MetWishes met_with(WishMaker& maker, const Design& design, const WishesOptions& options, double score) {
    WishOptions solver;
    solver.evaluations = options.evaluations;
    solver.interrupted = options.interrupted;
    MetWishes result;
    result.list = maker.make(false, score);
    result.found = design_for(result.list, solver);
    if (design.wanted.longest_time && result.found.outcome != WishOutcome::interrupted &&
        result.found.outcome != WishOutcome::nowhere) {
        WishList whole = maker.make(true, score);
        const FoundWant time = found_want(whole.wants.back(), whole.wants.back().value(result.values()).value);
        // The time is searched for only if it is all that is missing.
        if (!time.met && result.found.outcome == WishOutcome::met)
            result.found = TimeSearch(whole, solver).run(result.found);
        else
            result.found.wants.push_back(time);
        result.list = std::move(whole);
    }
    return result;
}

/// Clamps a share so that it is neither none nor all of the devices.
double countable(double share, std::size_t devices) {
    const double least = 0.5 / static_cast<double>(devices);
    return std::clamp(share, least, 1 - least);
}

/// Draws devices with the tolerances, and replaces the yield by derivatives by the counted one.
/// @return the share; nothing if no design was found or the work was interrupted
std::optional<double> make_devices(MetWishes& result, WishMaker& maker, const Design& design,
                                   const WishesOptions& options) {
    const auto want = std::ranges::find_if(result.list.wants, [](const Want& one) { return one.name == "yield"; });
    want->least = *design.wanted.least_yield;
    want->scale = 0;
    want->limits.clear();
    FoundWant& found = result.found.wants[static_cast<std::size_t>(want - result.list.wants.begin())];
    const TripPoint* device = result.found.outcome == WishOutcome::nowhere ? nullptr : maker.device_of(result.values());
    if (!device)
        return std::nullopt;
    YieldSettings settings = yield_settings_of(design, device->point.solution.orbit);
    settings.jobs = options.jobs;
    settings.elsewhere = options.elsewhere;
    settings.interrupted = options.interrupted;
    const Yield yield = yield_of(device->system, device->point, device->control, settings);
    if (yield.interrupted)
        result.found.outcome = WishOutcome::interrupted;
    if (yield.interrupted || !yield.within)
        return std::nullopt;
    const FoundWant made = found_want(*want, yield.within->value, 0);
    found.value = made.value;
    found.met = made.met;
    found.violation = made.violation;
    return yield.within->value;
}

/// Sets the outcome to met if only the yield by derivatives was missed, and the counted one is sufficient.
void tell_met(MetWishes& result) {
    const std::vector<FoundWant>& wants = result.found.wants;
    if (!std::ranges::all_of(wants, [](const FoundWant& one) { return one.met; }))
        return;
    result.found.outcome = WishOutcome::met;
    result.found.reason.clear();
    result.found.violation = 0;
    for (const FoundWant& one : wants)
        result.found.violation = std::max(result.found.violation, one.violation);
}

/// Meets requirements with a yield. The yield by derivatives is only approximate, as trip values are neither linear nor
/// normal: the required score is raised by what the counted devices lack, and the search repeated.
MetWishes met_with_yield(WishMaker& maker, const Design& design, const WishesOptions& options) {
    constexpr int most_rounds = 5;
    const double wanted = *design.wanted.least_yield;
    const std::size_t devices = design.yield.devices;
    double score = score_of_share(countable(wanted, devices));
    for (int round = 1;; ++round) {
        MetWishes result = met_with(maker, design, options, score);
        const bool met = result.found.outcome == WishOutcome::met;
        const std::optional<double> made = make_devices(result, maker, design, options);
        if (made && !met && result.found.outcome != WishOutcome::interrupted)
            tell_met(result);
        if (!made || !met || *made >= wanted)
            return result;
        if (round == most_rounds) {
            result.found.outcome = WishOutcome::unmet;
            result.found.reason = fmt::format(
                "of {} devices made with the tolerances a share of {:.6g} is usable, and at least {:.6g} is wanted",
                devices, *made, wanted);
            return result;
        }
        constexpr double beyond = 0.02; // standard deviations: margin for the statistical error of the counted share
        score += score_of_share(countable(wanted, devices)) - score_of_share(countable(*made, devices)) + beyond;
    }
}

/// Adds to the reason that the approach's range limits the result.
void tell_range(MetWishes& result, const Approach& approach) {
    constexpr double beside = 1e-3; // relative to the range: the search stops before designs that leave it
    if (!result.trip_value || result.found.outcome == WishOutcome::met || !(approach.least < approach.greatest))
        return;
    const double value = *result.trip_value, near = beside * (approach.greatest - approach.least);
    if (value > approach.greatest - near || value < approach.least + near)
        result.found.reason += fmt::format("; it trips at the end of approach.range, {:.6g} to {:.6g}, which is "
                                           "in the way: widen it",
                                           approach.least, approach.greatest);
}

} // namespace

std::vector<double> MetWishes::values() const {
    return values_of(found);
}

MetWishes meet_wishes(const Design& design, const TripPoint& trip, const WishesOptions& options) {
    WishMaker maker(design, trip, options);
    MetWishes result =
        design.wanted.least_yield ? met_with_yield(maker, design, options) : met_with(maker, design, options, 0);
    if (result.found.outcome != WishOutcome::nowhere)
        result.trip_value = maker.value_of(result.values());
    tell_range(result, design.approach);
    for (Want& one : result.list.wants)
        one.value = nullptr; // they refer to local objects
    return result;
}

MetWishes wishes_at(const Design& design, const TripPoint& trip, const WishesOptions& options) {
    WishMaker maker(design, trip, options);
    MetWishes result;
    const double score =
        design.wanted.least_yield ? score_of_share(countable(*design.wanted.least_yield, design.yield.devices)) : 0;
    result.list = maker.make(true, score);
    result.found.outcome = WishOutcome::met;
    for (const Dimension& one : result.list.dimensions)
        result.found.dimensions.push_back({one.start, false, false, false, 0});
    const std::vector<double> values = result.values();
    for (const Want& one : result.list.wants)
        result.found.wants.push_back(found_want(one, one.value(values).value));
    if (design.wanted.least_yield)
        make_devices(result, maker, design, options);
    for (const FoundWant& one : result.found.wants) {
        result.found.violation = std::max(result.found.violation, one.violation);
        if (!one.met)
            result.found.outcome = WishOutcome::unmet;
    }
    result.trip_value = trip.value();
    for (Want& one : result.list.wants)
        one.value = nullptr;
    return result;
}

Design with_values(const Design& design, const std::vector<double>& values) {
    require_size(values.size(), design.dimensions.size(), "values of dimensions");
    require_finite(values, "value of a dimension");
    Design result = design;
    for (std::size_t i = 0; i < values.size(); ++i) {
        const std::string& name = result.dimensions[i].name;
        result.model.set_parameter(name, values[i]);
        std::erase_if(result.set, [&](const auto& one) { return one.first == name; });
        result.set.emplace_back(name, values[i]);
    }
    return result;
}

} // namespace graze
