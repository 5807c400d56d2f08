#include "branch/point_locator.hpp"

#include "base/signs.hpp"
#include "base/special_numbers.hpp"
#include "branch/bounds.hpp"
#include "branch/missed_points.hpp"
#include "branch/point_kind.hpp"
#include "branch/point_rules.hpp"

#include <algorithm>
#include <cmath>

namespace graze {

namespace {

constexpr int most_locating_steps = 60;
/// Accuracy of located points, as a fraction of the step.
constexpr double located_within = 1e-13;
/// Tolerance of points located on a bound, as a fraction of the step.
constexpr double on_bound = 1e-8;

/// True when a minimum that appears in an arc or disappears from it does so at a nonzero value, as where an event
/// function starts to rise beyond its surface: this is not a touch.
bool is_jump(const BranchTest& touch) {
    constexpr double zero = 1e-5; // share of the function's size along the arc
    return is_grazing(touch.type) && !touch.at_end && std::abs(touch.value) * smallest_clearance > zero * touch.noise;
}

} // namespace

std::vector<SpecialPoint> PointLocator::locate_all(const DescribedPoint& before) {
    const std::vector<BranchTest>& tests = before.tests;
    std::vector<SpecialPoint> found;
    if (tests.size() != here_->tests.size()) {
        history_.forget();
        return found;
    }
    const double from = before.point.arclength, length = here_->point.arclength - from;
    if (history_.is_empty())
        sample_first_step();
    for (std::size_t i = 0; i < tests.size(); ++i) {
        const std::vector<Bracket> brackets = brackets_of(i, tests[i].value);
        std::vector<SpecialPoint> zeros;
        for (const auto& [low, high] : brackets)
            if (std::optional<SpecialPoint> special = locate(i, low, high))
                zeros.push_back(std::move(*special));
        if (brackets.size() == 2 && zeros.size() < 2 && tests[i].singular)
            if (std::vector<SpecialPoint> pair = locate_pair_of_crossings(i, brackets); !pair.empty())
                zeros = std::move(pair);
        for (SpecialPoint& special : zeros) {
            note(special, before.point, tests[i].singular);
            found.push_back(std::move(special));
        }
    }
    add_bounds_before(found, before);
    if (state_->settings().kept)
        if (std::optional<SpecialPoint> simpler = locate_simpler()) {
            // The curve runs back over itself behind, so that its parameters have extrema there.
            constexpr double near = 0.05; // share of the step: both points are ill-conditioned
            std::erase_if(found, [&](const SpecialPoint& one) {
                return (one.type == PointType::cusp || one.type == PointType::extremum ||
                        one.type == PointType::branch_point) &&
                       std::abs(one.arclength - simpler->arclength) < near * length;
            });
            note(*simpler, before.point, true);
            found.push_back(std::move(*simpler));
        }
    history_.add(from, tests);
    sort_by_place(found);
    for (SpecialPoint& special : found) {
        if (special.type == PointType::bound)
            break;
        if (!is_beyond(special, tests)) {
            put_on_bounds(state_->settings(), special.solution.orbit);
            special.parameter = special.solution.orbit.parameters[state_->settings().parameter.place()];
        }
    }
    drop_consequences(*state_, found, length);
    state_->problem().evaluate(state_->continuation().point().u);
    return found;
}

/// Sorts points by arclength; a point on a bound comes before the bound, which ends the branch.
void PointLocator::sort_by_place(std::vector<SpecialPoint>& found) const {
    const double length = state_->last_step().length;
    const auto place = [&](const SpecialPoint& special) {
        return special.arclength + (special.type == PointType::bound ? on_bound * length : 0);
    };
    std::stable_sort(found.begin(), found.end(),
                     [&](const SpecialPoint& a, const SpecialPoint& b) { return place(a) < place(b); });
}

void PointLocator::add_missed(std::vector<SpecialPoint>& found, const DescribedPoint& before) {
    constexpr double beside = 1e-4; // fraction of the step: determinants vanish where a contact disappears
    constexpr double same_place = 1e-7;
    const BranchSettings& settings = state_->settings();
    if (settings.kept || !settings.free.empty() || before.tests.size() != here_->tests.size())
        return; // on curves and with fixed monitors, folds need no multiplier 1
    const double from = before.point.arclength, length = here_->point.arclength - from;
    if (!(length > 0))
        return;
    StepSample high{1, *here_};
    std::vector<SpecialPoint> known;
    for (const SpecialPoint& one : found) {
        if (kind_of(one.type).limits || is_degenerate(*state_, one)) {
            const double fraction = (one.arclength - from) / length - beside;
            auto there = fraction > 0 ? state_->describe_between(fraction) : std::nullopt;
            if (!there)
                return;
            high = {fraction, std::move(*there)};
            break;
        }
        known.push_back(one);
    }
    const auto locate_test = [&](std::size_t test, const TestValue& first, const TestValue& last) {
        return locate(test, first, last);
    };
    for (SpecialPoint& one : missed_points(*state_, {0, before}, high, known, locate_test)) {
        // A report of several crossings replaces the single point that a test has found there.
        std::erase_if(found, [&](const SpecialPoint& other) {
            return other.type == one.type && std::abs(other.arclength - one.arclength) < same_place * length;
        });
        note(one, before.point, one.type == PointType::branch_point);
        found.push_back(std::move(one));
    }
    sort_by_place(found);
    state_->problem().evaluate(state_->continuation().point().u);
}

void PointLocator::note(SpecialPoint& special, const BranchPoint& before, bool singular) {
    special.bracket = std::minmax(before.parameter, here_->point.parameter);
    special.step = here_->point.step;
    // A limit point is admissible if orbits on one side are: at the limit round-off would decide.
    Certificate& certificate = special.solution.certificate;
    if (rank(special) >= 0 && !certificate.admissible &&
        (before.solution.certificate.admissible || here_->point.solution.certificate.admissible)) {
        certificate.admissible = true;
        certificate.reason.clear();
    }
    if (!singular)
        special.solution.error = state_->error_of(special.solution.orbit, special.tangent);
}

/// Adds bounds that the branch crosses before a found point and crosses back within the same step.
void PointLocator::add_bounds_before(std::vector<SpecialPoint>& found, const DescribedPoint& before) {
    const std::vector<BranchTest>& tests = before.tests;
    const LastStep step = state_->last_step();
    const std::vector<SpecialPoint> all = found;
    for (const SpecialPoint& one : all) {
        const bool known = std::any_of(found.begin(), found.end(), [&](const SpecialPoint& other) {
            return other.type == PointType::bound && other.arclength <= one.arclength;
        });
        if (known || !is_beyond(one, tests))
            continue;
        const std::vector<BranchTest> there =
            tests_of_bounds(state_->settings(), one.solution.orbit.parameters, one.monitors);
        std::size_t bound = 0;
        for (std::size_t i = 0; i < tests.size(); ++i) {
            if (tests[i].type != PointType::bound)
                continue;
            const double value = there[bound++].value;
            if (tests[i].value > 0 && value < 0)
                if (auto special = locate(i, {0, tests[i].value}, {step.fraction(one.arclength), value})) {
                    note(*special, before.point, false);
                    found.push_back(std::move(*special));
                }
        }
    }
}

/// True when a point lies beyond a bound by more than the accuracy of its location.
bool PointLocator::is_beyond(const SpecialPoint& special, const std::vector<BranchTest>& tests) const {
    if (special.type == PointType::bound)
        return false;
    const std::vector<BranchTest> there =
        tests_of_bounds(state_->settings(), special.solution.orbit.parameters, special.monitors);
    std::size_t bound = 0;
    for (std::size_t i = 0; i < tests.size(); ++i) {
        if (tests[i].type != PointType::bound)
            continue;
        const double change = std::abs(here_->tests[i].value - tests[i].value), value = there[bound++].value;
        if (value < -std::max(tests[i].noise, on_bound * change))
            return true;
    }
    return false;
}

bool PointLocator::misses_bound(const std::vector<SpecialPoint>& found, const DescribedPoint& before) const {
    for (const SpecialPoint& special : found) {
        if (special.type == PointType::bound)
            return false;
        if (is_beyond(special, before.tests))
            return true;
    }
    return is_beyond_bounds(here_->tests);
}

/// Returns the parts of the last step in which a test changes its sign.
std::vector<PointLocator::Bracket> PointLocator::brackets_of(std::size_t test, double before) {
    const BranchTest& now = here_->tests[test];
    const TestValue low{0, before}, high{1, now.value};
    const double noise = now.noise;
    const bool appeared = now.appears && std::isnan(low.value) && high.value < -noise;
    const bool vanished = now.appears && std::isnan(high.value) && low.value < -noise;
    if (std::abs(low.value) <= noise && std::abs(high.value) <= noise && noise > 0)
        return {};
    // Orbits with several touches are often simpler ones traversed repeatedly. A test that reaches zero is then the
    // same touch, which becomes a contact only beyond.
    const bool is_zero = std::abs(low.value) <= noise || std::abs(high.value) <= noise;
    if (now.type == PointType::double_grazing && is_zero && noise > 0)
        return {};
    // A branch that begins on a bound may lie beyond it by round-off.
    if (now.type == PointType::bound && !(low.value > 0))
        return {};
    if (have_opposite_signs(low.value, high.value) || appeared || vanished || (high.value == 0 && low.value != 0))
        return {{low, high}};
    if (!have_same_sign(low.value, high.value))
        return {};
    const LastStep step = state_->last_step();
    const auto value_at = [&](double fraction) {
        const auto there = state_->describe_between(fraction, now.type);
        return there ? there->tests[test].value : not_a_number;
    };
    const auto dip =
        history_.find_dip(test, step.from, step.length, low, high, unknown_values(now, low, high), value_at);
    return dip ? std::vector<Bracket>{{dip->before, dip->within}, {dip->within, dip->behind}} : std::vector<Bracket>();
}

/// Before the first step no point is known: a point within the step takes its place.
void PointLocator::sample_first_step() {
    const LastStep step = state_->last_step();
    constexpr double middle = 0.5;
    const auto there = state_->describe_between(middle);
    if (there && there->tests.size() == here_->tests.size())
        history_.add(step.from + middle * step.length, there->tests);
}

/// Returns the magnitude up to which values of a test may be round-off where it is far from zero on both sides.
double PointLocator::unknown_values(const BranchTest& test, const TestValue& low, const TestValue& high) const {
    // A test's noise allows for inaccurate orbits, and for tests that vanish on whole branches; in between, values
    // change by some tolerances.
    constexpr double tolerances = 10, relative_noise = 1e-9, least = 1e-3;
    // Of tests without noise, shares of the values at the ends: some only touch zero.
    constexpr double of_determinant = 1e-13, of_others = 1e-10;
    if (test.noise > 0)
        return std::clamp(tolerances * state_->settings().orbit.tolerance / relative_noise, least, 1.0) * test.noise;
    return (test.singular ? of_determinant : of_others) * std::min(std::abs(low.value), std::abs(high.value));
}

std::optional<SpecialPoint> PointLocator::locate(std::size_t test, const TestValue& low, const TestValue& high) {
    if (here_->tests[test].singular)
        return locate_by_crossing(test, low, high);
    bool complete = true;
    std::optional<SpecialPoint> special = locate_zero(test, low, high, complete);
    const Continuation& continuation = state_->continuation();
    const bool crossed = have_opposite_signs(continuation.previous().determinant, continuation.point().determinant);
    if (!crossed || complete)
        return special;
    if (std::optional<SpecialPoint> beside = locate_by_crossing(test, low, high))
        return beside;
    if (special && special->type == PointType::bound)
        return std::nullopt; // the caller repeats the step with a shorter one
    if (special)
        special->located = false;
    return special;
}

/// The zero of a test within the last step, by the secant method kept within a bracket (M. Dowell and P. Jarratt's
/// Illinois variant of regula falsi, 1971). An undefined value, as where a minimum does not exist yet, counts as
/// positive but of unknown size.
std::optional<SpecialPoint> PointLocator::locate_zero(std::size_t test, const TestValue& begin, const TestValue& end,
                                                      bool& complete) {
    double low = begin.fraction, low_value = begin.value, high = end.fraction, high_value = end.value;
    double fraction = 0;
    const double size = std::fmax(std::abs(low_value), std::abs(high_value));
    std::optional<DescribedPoint> there; // at the last fraction
    std::optional<BranchTest> last;      // last test with a defined value
    std::vector<ContinuationPoint> known;
    int side = 0;
    for (int i = 0; i < most_locating_steps && high - low > located_within; ++i) {
        fraction = low - low_value * (high - low) / (high_value - low_value); // NaN if one value is NaN
        if (!(fraction > low && fraction < high) || i % 8 == 7)
            fraction = 0.5 * (low + high);
        auto next = state_->describe_between(fraction, here_->tests[test].type, &known);
        if (!next) {
            complete = false;
            break;
        }
        there = std::move(next);
        const double value = there->tests[test].value;
        if (std::isfinite(value))
            last = there->tests[test];
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
    if (!there || (last && is_jump(*last)))
        return std::nullopt;
    if (!complete && !state_->problem().evaluate(known.back().u)) // the last attempt has left the branch
        return std::nullopt;
    if (last && std::isnan(there->tests[test].value)) // use the last defined time
        there->tests[test].time = last->time;
    return special_at(there->point, there->tests[test], size);
}

/// Locates where a curve within the last step meets a curve of simpler orbits, as curves of folds of doubled orbits do
/// at degenerate flips. Determinants have multiple zeros there, but the difference of the halves of the orbit a simple
/// one.
std::optional<SpecialPoint> PointLocator::locate_simpler() {
    Continuation& continuation = state_->continuation();
    const auto differences = [&](const ContinuationPoint& at) {
        return differences_of_halves(*state_, state_->problem().orbit_of(at.u));
    };
    const auto is_more = [](const std::vector<double>& all) { // than round-off
        return std::ranges::any_of(all, [](double one) { return std::abs(one) > same_orbit; });
    };
    const auto before = differences(continuation.previous()), behind = differences(continuation.point());
    for (std::size_t i = 0; i < before.size() && before.size() == behind.size(); ++i) {
        const Eigen::VectorXd change = vector_of(behind[i]) - vector_of(before[i]);
        const double low = change.dot(vector_of(before[i])), high = change.dot(vector_of(behind[i]));
        if (!(low < 0 && high > 0) || !is_more(before[i]) || !is_more(behind[i]))
            continue;
        const PointTest along = [&](const ContinuationPoint& sample) {
            return change.dot(vector_of(differences(sample)[i]));
        };
        // Near the crossing Newton's method is inaccurate.
        for (const double reach : {4.0, 8.0, 16.0, 32.0}) {
            const auto at = locate_crossing(continuation, along, {0, low}, {1, high}, reach);
            if (!at || !is_degenerate(*state_, state_->problem().orbit_of(at->u), same_orbit))
                continue;
            if (const auto there = state_->describe(*at))
                return special_of_type(PointType::branch_point, there->point);
        }
    }
    return std::nullopt;
}

/// Locates a zero at or near the crossing with another branch, where determinants vanish.
std::optional<SpecialPoint> PointLocator::locate_by_crossing(std::size_t test, const TestValue& low,
                                                             const TestValue& high) {
    constexpr double reduction = 0.25, shortest = 1e-3;
    const bool singular = here_->tests[test].singular;
    const PointTest value = [&](const ContinuationPoint& sample) {
        if (singular)
            return sample.determinant;
        const auto there = state_->describe(sample, here_->tests[test].type);
        return there ? there->tests[test].value : not_a_number;
    };
    std::optional<ContinuationPoint> at = locate_crossing(state_->continuation(), value, low, high);
    // Another crossing may be near, outside this part of the step.
    const bool is_part = high.fraction - low.fraction < 1;
    for (double reach = reduction; is_part && !at && reach > shortest; reach *= reduction)
        at = locate_crossing(state_->continuation(), value, low, high, reach);
    return at ? crossing_at(*at, test, low.value, high.value) : std::nullopt;
}

/// Locates two crossings with other branches between which no solution can be relied upon.
std::vector<SpecialPoint> PointLocator::locate_pair_of_crossings(std::size_t test,
                                                                 const std::vector<Bracket>& brackets) {
    const Dip dip{brackets[0].first, brackets[0].second, brackets[1].second};
    const PointTest value = [](const ContinuationPoint& sample) { return sample.determinant; };
    const auto pair = locate_pair(state_->continuation(), value, dip);
    if (!pair)
        return {};
    std::vector<SpecialPoint> result;
    for (const ContinuationPoint& at : {pair->first, pair->second})
        if (auto special = crossing_at(at, test, dip.before.value, dip.behind.value))
            result.push_back(std::move(*special));
    return result;
}

/// Returns the special point of an interpolated zero, if it is confirmed. @param first, last the test at both ends
std::optional<SpecialPoint> PointLocator::crossing_at(const ContinuationPoint& at, std::size_t test, double first,
                                                      double last) {
    constexpr double solved = 1e-8; // scaled residual
    const auto there = state_->describe(at);
    // If two nearby branches do not cross, the interpolated point does not satisfy the equations.
    if (!there || (here_->tests[test].singular && !(state_->problem().evaluation().residual < solved)))
        return std::nullopt;
    return special_at(there->point, there->tests[test], std::max(std::abs(first), std::abs(last)));
}

/// Returns the special point of a zero, if it is confirmed. @param size of the test at the ends of the bracket
std::optional<SpecialPoint> PointLocator::special_at(const BranchPoint& there, const BranchTest& here, double size) {
    SpecialPoint special = special_of_type(here.type, there);
    special.segment = here.segment;
    special.event = here.event;
    special.time = here.time;
    special.at_end = here.at_end;
    // A zero, not a discontinuity: the value must be small against those at the ends.
    special.located = std::abs(here.value) <= 1e-3 * size;
    const auto confirm = rule_of(here.type).confirm;
    const bool confirmed = confirm ? confirm(*state_, special, here) : special.located;
    return confirmed ? std::optional(special) : std::nullopt;
}

} // namespace graze
