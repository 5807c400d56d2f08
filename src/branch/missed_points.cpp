#include "branch/missed_points.hpp"

#include "base/signs.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <utility>

namespace graze {

namespace {

using MultiplierList = std::vector<std::complex<double>>;

/// Number of unstable multipliers as an interval: multipliers on the unit circle may count as either.
struct Count {
    int least = 0, most = 0;
    bool is_certain() const { return least == most; }
};

Count unstable(const MultiplierList& multipliers, double margin) {
    Count count;
    for (const std::complex<double> one : multipliers) {
        count.least += std::abs(one) > 1 + margin ? 1 : 0;
        count.most += std::abs(one) > 1 - margin ? 1 : 0;
    }
    return count;
}

/// Returns by how many a point of this type changes the number of unstable multipliers; 0 for other types.
int crossing_at(PointType type) {
    const bool single = type == PointType::fold || type == PointType::branch_point || type == PointType::flip ||
                        type == PointType::asymmetry;
    return single ? 1 : type == PointType::torus ? 2 : 0;
}

/// True when crossings of `singles` single multipliers and `pairs` pairs may change one number into the other.
bool may_explain(const Count& before, const Count& after, int singles, int pairs) {
    const int least = after.least - before.most, most = after.most - before.least;
    for (int change = least; change <= most; ++change)
        if (std::abs(change) <= singles + 2 * pairs && (change - singles) % 2 == 0)
            return true;
    return false;
}

class Search {
public:
    /// @param size number of multipliers of the orbits at both ends, which those in between must have too
    Search(BranchState& state, const TestLocator& locate, const std::vector<SpecialPoint>& known, std::size_t size)
        : state_(state), locate_(locate), known_(known), size_(size) {}

    /// Bisects a part of the step until the change of the number of unstable multipliers is explained.
    void search(const StepSample& low, const StepSample& high) {
        constexpr double narrow = 1e-9; // as a fraction of the step
        const Count before = unstable(low.multipliers(), margin), after = unstable(high.multipliers(), margin);
        if (may_explain(before, after, 0, 0))
            return;
        std::vector<SpecialPoint> located;
        if (is_explained_by_tests(low, high, located)) {
            std::move(located.begin(), located.end(), std::back_inserter(result));
            return;
        }
        StepSample middle;
        if (high.fraction - low.fraction < narrow || !sample_between(low, high, middle))
            return note_coincident(low, high);
        search(low, middle);
        search(middle, high);
    }

    /// Searches where both ends have the same number and a known point lies between: another point must lie before or
    /// after it.
    void search_beside_known(const StepSample& low, const StepSample& high) {
        constexpr double beside = 1e-4; // fraction of the step
        StepSample from = low, here;
        for (const SpecialPoint& one : known_) {
            const double at = state_.last_step().fraction(one.arclength);
            if (crossing_at(one.type) == 0)
                continue;
            if (at - beside > from.fraction && sample(at - beside, here))
                search(from, here);
            if (!(at + beside < high.fraction) || !sample(at + beside, from))
                return;
        }
        search(from, high);
    }

    std::vector<SpecialPoint> result;

private:
    static constexpr double margin = 1e-9; // tolerance of the modulus of a multiplier

    bool sample(double fraction, StepSample& here) {
        auto there = state_.describe_between(fraction);
        if (there)
            here = {fraction, std::move(*there)};
        return there && here.number_of_multipliers() == size_;
    }
    /// Samples a point inside the interval whose number of unstable multipliers is certain.
    bool sample_between(const StepSample& low, const StepSample& high, StepSample& middle) {
        constexpr double shares[] = {0.5, 0.4, 0.6, 0.25, 0.75, 0.1, 0.9};
        return std::any_of(std::begin(shares), std::end(shares), [&](double share) {
            return sample(low.fraction + share * (high.fraction - low.fraction), middle) &&
                   unstable(middle.multipliers(), margin).is_certain();
        });
    }

    /// Returns the indices of tests of crossing multipliers that change their sign.
    static std::vector<std::size_t> changed_tests(const StepSample& low, const StepSample& high) {
        const std::vector<BranchTest>&first = low.here.tests, &last = high.here.tests;
        std::vector<std::size_t> changed;
        for (std::size_t i = 0; i < first.size() && first.size() == last.size(); ++i)
            if (crossing_at(first[i].type) > 0 && have_opposite_signs(first[i].value, last[i].value))
                changed.push_back(i);
        return changed;
    }
    bool is_explained_by_tests(const StepSample& low, const StepSample& high, std::vector<SpecialPoint>& located) {
        int singles = 0, pairs = 0;
        const std::vector<std::size_t> changed = changed_tests(low, high);
        for (const std::size_t i : changed)
            (crossing_at(low.here.tests[i].type) == 1 ? singles : pairs) += 1;
        if (changed.empty() ||
            !may_explain(unstable(low.multipliers(), margin), unstable(high.multipliers(), margin), singles, pairs))
            return false;
        for (const std::size_t i : changed) {
            auto special =
                locate_(i, {low.fraction, low.here.tests[i].value}, {high.fraction, high.here.tests[i].value});
            if (!special)
                return false;
            located.push_back(std::move(*special));
        }
        return true;
    }

    /// Reports several multipliers that cross at the same point, as those of identical devices; no test function
    /// changes its sign there.
    void note_coincident(const StepSample& low, const StepSample& high) {
        const Count before = unstable(low.multipliers(), margin), after = unstable(high.multipliers(), margin);
        const auto rank = static_cast<std::size_t>(std::min(before.most, after.most));
        const auto count = static_cast<std::size_t>(std::abs(after.most - before.most));
        // At one end they may be among those that are not computed.
        const bool fewer = low.multipliers().size() < high.multipliers().size();
        const MultiplierList sorted = by_modulus((fewer ? high : low).multipliers());
        if (count == 0 || rank + count > sorted.size())
            return;
        std::size_t ones = 0, minus_ones = 0;
        for (std::size_t i = rank; i < rank + count; ++i) {
            ones += is_near(sorted[i], 1) ? 1 : 0;
            minus_ones += is_near(sorted[i], -1) ? 1 : 0;
        }
        const std::size_t others = count - ones - minus_ones;
        const PointType flip = state_.problem().equations().symmetry() ? PointType::asymmetry : PointType::flip;
        const auto in_words = [](std::size_t number, const char* where) {
            return number == 1 ? fmt::format("a multiplier crosses {}", where)
                               : fmt::format("{} multipliers cross {} at once", number, where);
        };
        // A single multiplier 1 means a fold or a branch point, which have tests of their own. If neither test changes
        // its sign, the step has jumped to another branch and nothing is reported.
        const std::optional<PointType> alone = ones == 1 ? singular_type(low, high) : PointType::branch_point;
        if (ones > 0 && alone)
            note(low, high, rank, *alone, in_words(ones, "1"));
        if (minus_ones > 0)
            note(low, high, rank, flip, in_words(minus_ones, "-1"));
        if (others > 0)
            note(low, high, rank, PointType::torus, in_words(others, "the unit circle"));
    }
    static std::optional<PointType> singular_type(const StepSample& low, const StepSample& high) {
        for (const std::size_t i : changed_tests(low, high))
            if (const PointType type = low.here.tests[i].type;
                type == PointType::fold || type == PointType::branch_point)
                return type;
        return std::nullopt;
    }
    static bool is_near(std::complex<double> multiplier, double number) {
        constexpr double near = 1e-3;
        return std::abs(multiplier / std::abs(multiplier) - number) < near;
    }
    static MultiplierList by_modulus(MultiplierList multipliers) {
        std::sort(multipliers.begin(), multipliers.end(), [](auto a, auto b) { return std::abs(a) > std::abs(b); });
        return multipliers;
    }

    /// @param rank index of the multiplier that crosses, by decreasing modulus
    void note(const StepSample& low, const StepSample& high, std::size_t rank, PointType type, std::string detail) {
        constexpr double close = 1e-6, not_there = 1e-3;
        constexpr int most = 60;
        const auto growth = [&](const StepSample& here) {
            const MultiplierList sorted = by_modulus(here.multipliers());
            return (rank < sorted.size() ? std::abs(sorted[rank]) : here.here.point.solution.others_within) - 1;
        };
        StepSample here, best, begin = low, end = high;
        double distance = std::min(std::abs(growth(low)), std::abs(growth(high))), at = low.fraction;
        bool any = false;
        for (int i = 0; i < most; ++i) {
            const double first = growth(begin), last = growth(end);
            const double fraction = i % 2 == 0
                                        ? begin.fraction - first * (end.fraction - begin.fraction) / (last - first)
                                        : 0.5 * (begin.fraction + end.fraction);
            if (!(fraction > begin.fraction && fraction < end.fraction) || !sample(fraction, here))
                break;
            const double value = growth(here);
            if (!any || std::abs(value) < distance) {
                distance = std::abs(value);
                best = here;
                at = fraction;
                any = true;
            }
            if (value == 0)
                break;
            (value * first > 0 ? begin : end) = here;
        }
        if (!any && !sample(at, best))
            return;
        if (!(distance < not_there)) // the step has jumped to another branch
            return;
        SpecialPoint special = special_of_type(type, best.here.point);
        special.located = distance < close;
        special.detail = std::move(detail);
        if (!is_known(special, low, high))
            result.push_back(std::move(special));
    }
    /// True when a single crossing was already found by its test. Several crossings replace such a point because they
    /// tell more.
    bool is_known(const SpecialPoint& special, const StepSample& low, const StepSample& high) const {
        const LastStep step = state_.last_step();
        return special.detail.starts_with("a multiplier") &&
               std::any_of(known_.begin(), known_.end(), [&](const SpecialPoint& one) {
                   const double at = step.fraction(one.arclength);
                   return crossing_at(one.type) > 0 && at >= low.fraction && at <= high.fraction;
               });
    }

    BranchState& state_;
    const TestLocator& locate_;
    const std::vector<SpecialPoint>& known_;
    std::size_t size_;
};

} // namespace

std::vector<SpecialPoint> missed_points(BranchState& state, const StepSample& low, const StepSample& high,
                                        const std::vector<SpecialPoint>& found, const TestLocator& locate) {
    constexpr double certain = 1e-6; // of the modulus of a multiplier
    int singles = 0, pairs = 0;
    for (const SpecialPoint& one : found) {
        singles += crossing_at(one.type) == 1 ? 1 : 0;
        pairs += crossing_at(one.type) == 2 ? 1 : 0;
    }
    if (low.number_of_multipliers() == 0 || low.number_of_multipliers() != high.number_of_multipliers() ||
        may_explain(unstable(low.multipliers(), certain), unstable(high.multipliers(), certain), singles, pairs))
        return {};
    Search search(state, locate, found, low.number_of_multipliers());
    if (may_explain(unstable(low.multipliers(), certain), unstable(high.multipliers(), certain), 0, 0))
        search.search_beside_known(low, high);
    else
        search.search(low, high);
    return std::move(search.result);
}

} // namespace graze
