#include "branch/point_locator.hpp"

#include "branch/point_kind.hpp"
#include "branch/point_rules.hpp"

#include <algorithm>
#include <cmath>

namespace graze {

namespace {

constexpr int most_locating_steps = 60;
/// Fraction of a step to which points are located.
constexpr double located_within = 1e-13;

} // namespace

std::vector<SpecialPoint> PointLocator::locate_all(const BranchPoint& before, const std::vector<BranchTest>& tests) {
    std::vector<SpecialPoint> found;
    if (tests.size() != tests_->size())
        return found;
    const double from = before.arclength, length = point_->arclength - from;
    for (std::size_t i = 0; i < tests.size(); ++i)
        for (const auto& [low, high] : brackets_of(i, tests[i].value))
            if (std::optional<SpecialPoint> special = locate(i, low, high)) {
                special->bracket = std::minmax(before.parameter, point_->parameter);
                special->step = point_->step;
                accept_limit(*special, before.solution.certificate.admissible);
                if (!tests[i].singular)
                    special->solution.error = state_->error_of(special->solution.orbit, special->tangent);
                found.push_back(std::move(*special));
            }
    older_ = tests;
    older_arclength_ = from;
    std::stable_sort(found.begin(), found.end(),
                     [](const SpecialPoint& a, const SpecialPoint& b) { return a.arclength < b.arclength; });
    merge(found, length);
    drop_crossings_of_nothing(*state_, found, length);
    drop_multipliers_of_resonances(found, length);
    drop_parts_of_sensitivity(found, length);
    drop_folds_of_return(*state_, found, length);
    state_->problem().evaluate(state_->continuation().point().u);
    return found;
}

/// At the end of what is admissible round-off would decide: the limit of admissible orbits is one.
void PointLocator::accept_limit(SpecialPoint& special, bool was_admissible) const {
    Certificate& certificate = special.solution.certificate;
    if (rank(special) < 0 || certificate.admissible)
        return;
    certificate.admissible = was_admissible || point_->solution.certificate.admissible;
    if (certificate.admissible)
        certificate.reason.clear();
}

/// Parts of the last step in which a test changes its sign.
std::vector<std::pair<TestValue, TestValue>> PointLocator::brackets_of(std::size_t test, double before) {
    const TestValue low{0, before}, high{1, (*tests_)[test].value};
    const double noise = (*tests_)[test].noise;
    const bool appears = (*tests_)[test].appears;
    const bool appeared = appears && std::isnan(low.value) && high.value < -noise;
    const bool vanished = appears && std::isnan(high.value) && low.value < -noise;
    if (std::abs(low.value) <= noise && std::abs(high.value) <= noise && noise > 0)
        return {};
    // Orbits that touch several times are often simpler ones gone round more than once, which touch each time: what
    // comes down to zero touches too, and is met only beyond.
    const bool is_zero = std::abs(low.value) <= noise || std::abs(high.value) <= noise;
    if ((*tests_)[test].type == PointType::double_grazing && is_zero && noise > 0)
        return {};
    if (low.value * high.value < 0 || appeared || vanished || (high.value == 0 && low.value != 0))
        return {{low, high}};
    if (older_.size() != tests_->size() || !(low.value * high.value > 0))
        return {};
    const double from = state_->arclength(state_->continuation().previous().arclength);
    const double length = state_->arclength(state_->continuation().point().arclength) - from;
    const auto dip = possible_dip({(older_arclength_ - from) / length, older_[test].value}, low, high);
    ContinuationPoint at;
    if (!dip || !state_->continuation().between(*dip, at))
        return {};
    BranchPoint there;
    std::vector<BranchTest> tests;
    if (!state_->describe(at, there, tests))
        return {};
    const TestValue middle{*dip, tests[test].value};
    if (!(middle.value * low.value < 0))
        return {};
    return {{low, middle}, {middle, high}};
}

std::optional<SpecialPoint> PointLocator::locate(std::size_t test, const TestValue& low, const TestValue& high) {
    return (*tests_)[test].singular ? locate_branch_point(test, low, high) : locate_zero(test, low, high);
}

/// The zero of a test within the last step, by the secant method kept within a bracket (M. Dowell and
/// P. Jarratt's Illinois variant of regula falsi, 1971). A value without meaning, as where a minimum does not exist
/// yet, counts as positive but of unknown size.
std::optional<SpecialPoint> PointLocator::locate_zero(std::size_t test, const TestValue& begin, const TestValue& end) {
    double low = begin.fraction, low_value = begin.value, high = end.fraction, high_value = end.value;
    double fraction = 0;
    const double size = std::fmax(std::abs(low_value), std::abs(high_value));
    ContinuationPoint at;
    BranchPoint there;
    std::vector<BranchTest> tests;
    bool found_any = false;
    int side = 0;
    for (int i = 0; i < most_locating_steps && high - low > located_within; ++i) {
        fraction = low - low_value * (high - low) / (high_value - low_value); // NaN if one of them is
        if (!(fraction > low && fraction < high) || i % 8 == 7)
            fraction = 0.5 * (low + high);
        if (!state_->continuation().between(fraction, at) || !state_->describe(at, there, tests))
            break;
        found_any = true;
        const double value = tests[test].value;
        if (value == 0)
            break;
        if ((value < 0) == (low_value < 0)) {
            low = fraction;
            low_value = value;
            high_value *= side == -1 ? 0.5 : 1;
            side = -1;
        } else {
            high = fraction;
            high_value = value;
            low_value *= side == 1 ? 0.5 : 1;
            side = 1;
        }
    }
    return found_any ? special_at(there, tests[test], size) : std::nullopt;
}

/// Where another branch crosses, at which determinants are zero.
std::optional<SpecialPoint> PointLocator::locate_branch_point(std::size_t test, const TestValue& low,
                                                              const TestValue& high) {
    const std::optional<ContinuationPoint> at = locate_crossing(state_->continuation(), low, high);
    if (!at)
        return std::nullopt;
    BranchPoint there;
    std::vector<BranchTest> tests;
    if (!state_->describe(*at, there, tests))
        return std::nullopt;
    return special_at(there, tests[test], std::max(std::abs(low.value), std::abs(high.value)));
}

/// @param size of the test at the ends of the bracket
std::optional<SpecialPoint> PointLocator::special_at(const BranchPoint& there, const BranchTest& here, double size) {
    SpecialPoint special;
    special.type = here.type;
    special.solution = there.solution;
    special.parameter = there.parameter;
    special.arclength = there.arclength;
    special.tangent = there.tangent;
    special.monitors = there.monitors;
    special.segment = here.segment;
    special.event = here.event;
    special.time = here.time;
    special.at_end = here.at_end;
    // A zero, not a jump: the value there must be small against those at the ends.
    special.located = std::abs(here.value) <= 1e-3 * size;
    const auto confirm = rule_of(here.type).confirm;
    const bool confirmed = confirm ? confirm(*state_, special, here) : special.located;
    return confirmed ? std::optional(special) : std::nullopt;
}

} // namespace graze
