#include "branch/contact_points.hpp"

#include "base/concatenated.hpp"
#include "base/special_numbers.hpp"
#include "branch/branch_state.hpp"
#include "branch/grazing_switch.hpp"
#include "branch/orbit_quantity.hpp"
#include "branch/reordering.hpp"
#include "branch/sliding_name.hpp"
#include "flow/lie_derivative.hpp"
#include "graze/base/input_error.hpp"
#include "graze/grazing/cycle_map.hpp"
#include "grazing/return_map.hpp"
#include "orbit/certify.hpp"

#include <fmt/format.h>

#include <cmath>
#include <complex>

namespace graze {

namespace {

std::unique_ptr<OrbitCondition> held(OrbitQuantity quantity) {
    return std::make_unique<OrbitQuantity>(std::move(quantity));
}

/// Returns the event that ends a segment, or whose contacts accumulate there; 0 for sections, where it is unused.
std::size_t own_event(const TestedPoint& point, std::size_t segment) {
    const Segment& one = point.equations.signature()[segment];
    const Transition* const transition = transition_of(point.equations.model(), one);
    return transition ? transition->event : 0;
}

/// True when a curve keeps the duration of a segment at zero; then no other events are tested in it.
bool has_zero_duration(const TestedPoint& point, std::size_t segment) {
    const auto held = held_limit_of(point.settings);
    return held && held->has_zero_duration(segment, point.equations.signature().size());
}

/// True when a minimum belongs to a contact of zero speed, as on curves of touches: it lies at the end of its arc,
/// where the approach speed is tested instead, or at the very start of the next segment.
bool belongs_to_contact(const TestedPoint& point, const OrbitMinimum& minimum) {
    constexpr double at_start = 1e-3, at_end = 1e-6; // shares of the segment
    if (!is_kept(point, PointType::grazing))
        return false;
    const SpecialPoint& kept = *point.settings.kept;
    const auto& signature = point.equations.signature();
    const double duration = std::abs(point.solution.orbit.durations[minimum.segment]);
    const std::size_t after = kept.at_end ? 1 + held_limit_of(kept)->zero_durations : 1;
    const bool own =
        signature[minimum.segment].end == SegmentEnd::event && own_event(point, minimum.segment) == minimum.event;
    return (own && minimum.time > (1 - at_end) * duration) ||
           (kept.at_end && minimum.segment == (kept.segment + after) % signature.size() &&
            minimum.time < at_start * duration);
}

/// True when the value at the end of a segment is zero because the curve keeps the duration of this or the next segment
/// at zero.
bool belongs_to_vanishing(const TestedPoint& point, const EndValue& end) {
    const std::size_t next = (end.segment + 1) % point.equations.signature().size();
    return has_zero_duration(point, end.segment) ||
           (has_zero_duration(point, next) && own_event(point, next) == end.event &&
            point.equations.signature()[next].end == SegmentEnd::event);
}

/// True when a segment ends with a kept contact of zero speed that is followed by segments of zero duration: the guard
/// depends on their vanishing motion, so its margin is undefined.
bool guard_is_undetermined(const TestedPoint& point, std::size_t segment) {
    const auto held = held_limit_of(point.settings);
    return held && held->kind == HeldLimit::Kind::stop && held->segment == segment && held->zero_durations > 0;
}

void add_sliding_name(const BranchState& state, SpecialPoint& special) {
    if (const std::string name = sliding_name(state.system(), special); !name.empty())
        special.detail += "; " + name;
}

} // namespace

// Grazing: the approach speed at the end of an arc vanishes, or an event function has a minimum of zero inside an arc.

void test_grazing(const TestedPoint& point, std::vector<BranchTest>& tests) {
    const Certificate& certificate = point.solution.certificate;
    const PointType type = is_kept(point, PointType::grazing) ? PointType::double_grazing : PointType::grazing;
    // On curves of touches an orbit may be several rounds of a simpler one, whose contacts all have zero speed, known
    // only to the square root of round-off.
    const double noise = type == PointType::double_grazing ? 1e-7 : least_rate;
    for (std::size_t s = 0; s < point.equations.signature().size(); ++s) {
        const bool event = point.equations.signature()[s].end == SegmentEnd::event;
        const bool kept = is_kept(point, PointType::grazing, s, own_event(point, s)) && point.settings.kept->at_end;
        tests.push_back({.type = type,
                         .segment = s,
                         .event = own_event(point, s),
                         .value = event && !kept ? certificate.approach_speeds[s] : not_a_number,
                         .noise = noise * point.equations.typical_rate(point.at, s),
                         .time = point.solution.orbit.durations[s],
                         .at_end = true,
                         .appears = true});
    }
    for (std::size_t s = 0; s < point.equations.signature().size(); ++s)
        for (const std::size_t event : point.equations.system().mode(point.equations.signature()[s].mode).watched) {
            BranchTest test{.type = type, .segment = s, .event = event, .value = not_a_number, .appears = true};
            const bool kept = is_kept(point, PointType::grazing, s, event);
            for (const OrbitMinimum& minimum : certificate.minima)
                if (minimum.segment == s && minimum.event == event && !(minimum.value >= test.value) &&
                    !has_zero_duration(point, s) &&
                    !(kept && (point.settings.kept->at_end || minimum.time == point.settings.kept->time)) &&
                    !belongs_to_contact(point, minimum)) {
                    test.value = minimum.value;
                    test.noise = smallest_clearance * minimum.size;
                    test.time = minimum.time;
                }
            tests.push_back(test);
        }
}

bool confirm_grazing(BranchState& state, SpecialPoint& special, const BranchTest&) {
    // A touch of the event that ends an arc, at the very end of it, is the contact itself at zero speed.
    constexpr double very_end = 1e-5; // share of the arc
    const Segment& arc = special.solution.orbit.signature[special.segment];
    const double duration = std::abs(special.solution.orbit.durations[special.segment]);
    if (arc.end == SegmentEnd::event && state.model().transitions[arc.index].event == special.event &&
        special.type == PointType::grazing && special.time > (1 - very_end) * duration)
        special.at_end = true;
    if (special.at_end) { // the multipliers diverge there
        special.solution.multipliers.clear();
        special.solution.other_multipliers = 0;
    }
    special.detail =
        fmt::format("{}{}", state.model().events[special.event].name, special.at_end ? ", no approach speed" : "");
    add_sliding_name(state, special);
    return true;
}

/// The kept touch may reach the end of its segment: this is not a second touch.
bool confirm_double_grazing(BranchState& state, SpecialPoint& special, const BranchTest& test) {
    // Share of the segment: the distance of the touch from the end vanishes with a square root.
    constexpr double at_end = 1e-3;
    const SpecialPoint& kept = *state.settings().kept;
    confirm_grazing(state, special, test);
    const double duration = special.solution.orbit.durations[special.segment];
    if (special.segment == kept.segment && special.event == kept.event && !kept.at_end &&
        std::abs(duration - kept.time) < at_end * std::abs(duration)) {
        special.type = PointType::grazing;
        special.detail += "; the touch has come to the end of its segment";
    }
    return special.located;
}

int rank_of_grazing(const SpecialPoint& point) {
    const Orbit& orbit = point.solution.orbit;
    const double duration = std::abs(orbit.durations[point.segment]);
    // A vanishing arc is a consequence of the contact before it.
    constexpr double almost_nothing = 1e-4;
    if (point.at_end)
        return duration > almost_nothing * orbit.period() ? 1 : 2;
    // A minimum that enters or leaves an arc through its end is a consequence of a contact at zero speed.
    constexpr double at_edge = 1e-6;
    return point.time > at_edge * duration && point.time < (1 - at_edge) * duration ? 0 : 2;
}

std::unique_ptr<OrbitCondition> condition_of_grazing(const OrbitEquations& equations, const OrbitEvaluation&,
                                                     const SpecialPoint& point) {
    if (point.at_end)
        return held(OrbitQuantity::of_speed(equations, point.segment, 0));
    const double duration = point.solution.orbit.durations[point.segment];
    return held(OrbitQuantity::of_touch(equations, point.segment, point.event, point.time / duration));
}

std::vector<BranchStart> leave_grazing(const System& system, const SpecialPoint& point,
                                       const BranchSettings& settings) {
    if (is_adding_sliding(system, point))
        return leave_order(system, point, settings);
    return {point.at_end ? with_one_contact_fewer(system, point, settings)
                         : with_one_more_contact(system, point, settings)};
}

/// Returns for each touch the orbits with one contact more or fewer, where they exist near the other touch.
std::vector<BranchStart> leave_double_grazing(const System& system, const SpecialPoint& point,
                                              const BranchSettings& settings) {
    std::vector<BranchStart> starts;
    std::string why = "the orbit touches nothing";
    for (const OrbitTouch& touch : touches_of(system, point.solution.orbit)) {
        try {
            for (BranchStart& start : leave_grazing(system, grazing_at(point, touch), settings))
                starts.push_back(std::move(start));
        } catch (const InputError& error) {
            why = error.problem();
        }
    }
    if (starts.empty())
        throw InputError(why, "vary another parameter, or start from a grazing beside it");
    return starts;
}

// Points at which events change their order.

void test_vanishing(const TestedPoint& point, std::vector<BranchTest>& tests) {
    for (std::size_t s = 0; s < point.equations.signature().size(); ++s)
        tests.push_back({.type = PointType::vanishing,
                         .segment = s,
                         .event = own_event(point, s),
                         .value = has_zero_duration(point, s) ? not_a_number : point.solution.orbit.durations[s]});
}

bool confirm_vanishing(BranchState& state, SpecialPoint& special, const BranchTest&) {
    special.detail = fmt::format("segment {}", special.segment + 1);
    add_sliding_name(state, special);
    return true;
}

std::unique_ptr<OrbitCondition> condition_of_vanishing(const OrbitEquations& equations, const OrbitEvaluation&,
                                                       const SpecialPoint& point) {
    return held(OrbitQuantity::of_vanishing(equations, point.segment));
}

void test_two_events(const TestedPoint& point, std::vector<BranchTest>& tests) {
    for (const EndValue& end : point.solution.certificate.end_values) {
        const bool barrier = point.equations.model().events[end.event].kind == EventKind::barrier;
        tests.push_back({.type = PointType::two_events,
                         .segment = end.segment,
                         .event = end.event,
                         .value = barrier && !is_kept(point, PointType::two_events, end.segment, end.event) &&
                                          !belongs_to_vanishing(point, end)
                                      ? end.value
                                      : not_a_number,
                         .rate = end.rate});
    }
}

/// If the other event function is not falling, the point is a touch at the very end of an arc.
bool confirm_two_events(BranchState& state, SpecialPoint& special, const BranchTest& test) {
    constexpr double without_speed = 1e-6; // relative to the typical rate of the same function
    const OrbitEquations& equations = state.problem().equations();
    const OrbitEvaluation& at = state.problem().evaluation();
    if (std::abs(test.rate) < without_speed * equations.typical_rate(at, special.segment, special.event)) {
        special.type = PointType::grazing;
        special.time = special.solution.orbit.durations[special.segment];
    }
    special.detail = state.model().events[special.event].name;
    return true;
}

std::unique_ptr<OrbitCondition> condition_of_two_events(const OrbitEquations& equations, const OrbitEvaluation&,
                                                        const SpecialPoint& point) {
    return held(OrbitQuantity::of_two_events(equations, point.segment, point.event));
}

void test_guard(const TestedPoint& point, std::vector<BranchTest>& tests) {
    for (std::size_t s = 0; s < point.equations.signature().size(); ++s) {
        const double margin = point.solution.certificate.guard_margins[s];
        const bool held = is_kept(point, PointType::guard, s, own_event(point, s)) || guard_is_undetermined(point, s);
        tests.push_back({.type = PointType::guard,
                         .segment = s,
                         .event = own_event(point, s),
                         .value = std::isfinite(margin) && !held ? margin : not_a_number});
    }
}

bool confirm_guard(BranchState& state, SpecialPoint& special, const BranchTest&) {
    special.detail =
        fmt::format("after {}", end_name(state.model(), special.solution.orbit.signature[special.segment]));
    add_sliding_name(state, special);
    return true;
}

std::unique_ptr<OrbitCondition> condition_of_guard(const OrbitEquations& equations, const OrbitEvaluation& at,
                                                   const SpecialPoint& point) {
    auto condition = OrbitQuantity::of_guard(equations, at, point.segment);
    return condition ? held(std::move(*condition)) : nullptr;
}

std::vector<BranchStart> leave_order(const System& system, const SpecialPoint& point, const BranchSettings& settings) {
    return {with_events_reordered(system, point, settings)};
}

/// Tests on curves of touches: the first projection (the effect of an impact on the next pass; positive: the next pass
/// is free, negative: it impacts harder), and the sums of projections with equal and alternating signs, at whose zeros
/// curves of folds and flips of impacting orbits end. With two multipliers all three vanish together (P. Thota, X. Zhao
/// and H. Dankowicz, "Co-dimension-two grazing bifurcations in single-degree-of-freedom impact oscillators", J. Comput.
/// Nonlinear Dynam. 1, 2006).
void test_sensitivity(const TestedPoint& point, std::vector<BranchTest>& tests) {
    // Share of the period: smaller values are round-off, as where impacts do not affect the next pass.
    constexpr double least = 1e-9;
    if (!keeps_touch(point.settings))
        return;
    const auto& kept = point.settings.kept;
    double next = not_a_number, same = not_a_number, alternating = not_a_number, size = 1;
    if (!point.settings.kept_too) {
        const CycleMap map = cycle_map_of(point.equations, point.at, {kept->segment, kept->event, kept->time, false},
                                          std::nullopt, AskedContacts::rigid);
        if (map.exists() && map.contact.order == MapOrder::square_root) {
            next = map.projections(1).front();
            same = map.sum_of_projections(1);
            alternating = map.sum_of_projections(-1);
            for (const std::complex<double> one : map.multipliers)
                size *= 1 + std::abs(one);
        }
    }
    const double noise = least * point.solution.orbit.return_time();
    tests.push_back({.type = PointType::sensitivity, .value = next, .noise = noise});
    tests.push_back({.type = PointType::fold_degenerate, .value = same, .noise = noise * size});
    tests.push_back({.type = PointType::flip_degenerate, .value = alternating, .noise = noise * size});
}

/// Tests the acceleration of the event function at a kept contact of zero speed: where it is zero, the touch meets an
/// earlier crossing of the same surface.
void test_acceleration(const TestedPoint& point, std::vector<BranchTest>& tests) {
    constexpr double least = 1e-9; // share of the typical rate per period: smaller values are round-off
    const auto& kept = point.settings.kept;
    if (!kept || kept->type != PointType::grazing || !kept->at_end)
        return;
    const OrbitEquations& equations = point.equations;
    const std::size_t mode = equations.signature()[kept->segment].mode;
    const Expression acceleration = rates_of(equations.system(), mode, kept->event, 2).back();
    const auto& last = point.at.pieces[equations.layout().last_piece(kept->segment)];
    const std::vector<double> inputs = concatenated(last.end, point.at.parameters);
    tests.push_back(
        {.type = PointType::zero_acceleration,
         .segment = kept->segment,
         .event = kept->event,
         .value = equations.system().function_of({&acceleration, 1})(inputs).front(),
         .noise = least * equations.typical_rate(point.at, kept->segment) / point.solution.orbit.return_time(),
         .time = point.solution.orbit.durations[kept->segment],
         .at_end = true});
}

bool confirm_acceleration(BranchState& state, SpecialPoint& special, const BranchTest&) {
    special.detail = fmt::format("{}: touched without acceleration", state.model().events[special.event].name);
    return special.located;
}

bool confirm_sensitivity(BranchState& state, SpecialPoint& special, const BranchTest&) {
    special.detail = fmt::format("of an impact at {}", state.model().events[state.settings().kept->event].name);
    return special.located;
}

bool confirm_degenerate_grazing(BranchState& state, SpecialPoint& special, const BranchTest& test) {
    const char* const ending = test.type == PointType::fold_degenerate  ? "folds"
                               : state.problem().equations().symmetry() ? "losses of symmetry"
                                                                        : "flips";
    special.detail = fmt::format("{} of orbits with an impact at {} end", ending,
                                 state.model().events[state.settings().kept->event].name);
    return special.located;
}

} // namespace graze
