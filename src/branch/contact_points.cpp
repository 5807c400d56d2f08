#include "branch/contact_points.hpp"

#include "branch/branch_state.hpp"
#include "branch/grazing_switch.hpp"
#include "branch/orbit_quantity.hpp"
#include "branch/reordering.hpp"
#include "flow/lie_derivative.hpp"
#include "graze/base/input_error.hpp"
#include "graze/grazing/cycle_map.hpp"
#include "grazing/return_map.hpp"
#include "orbit/certify.hpp"

#include <fmt/format.h>

#include <cmath>
#include <complex>
#include <limits>

namespace graze {

namespace {

constexpr double nothing = std::numeric_limits<double>::quiet_NaN();

std::unique_ptr<OrbitCondition> held(OrbitQuantity quantity) {
    return std::make_unique<OrbitQuantity>(std::move(quantity));
}

/// The event that ends a segment; the first one for sections, where it is of no interest.
std::size_t own_event(const TestedPoint& point, std::size_t segment) {
    const Segment& one = point.equations.signature()[segment];
    return one.end == SegmentEnd::event ? point.equations.model().transitions[one.index].event : 0;
}

/// Whether a segment is held to take no time all along a curve: then nothing happens within it, or at its ends, but
/// what is held.
bool has_zero_duration(const TestedPoint& point, std::size_t segment) {
    const auto& kept = point.settings.kept;
    const auto held = kept ? held_limit_of(*kept) : std::nullopt;
    return held && held->has_zero_duration(segment, point.equations.signature().size());
}

/// Where contacts are without speed, as on curves of touches, the ends of arcs have least values too: of the next
/// segment at its very start, and of a segment's own event at its end, which the speed tells of.
bool is_of_contact(const TestedPoint& point, const OrbitMinimum& minimum) {
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

} // namespace

// Grazing: an event is met without speed at the end of its arc, or another touched inside of one.

void test_grazing(const TestedPoint& point, std::vector<BranchTest>& tests) {
    const Certificate& certificate = point.solution.certificate;
    const PointType type = is_kept(point, PointType::grazing) ? PointType::double_grazing : PointType::grazing;
    // On curves of touches orbits may be simpler ones gone round several times, whose contacts are all without speed:
    // a speed is known to the root of round-off there.
    const double noise = type == PointType::double_grazing ? 1e-7 : least_rate;
    for (std::size_t s = 0; s < point.equations.signature().size(); ++s) {
        const bool event = point.equations.signature()[s].end == SegmentEnd::event;
        const bool kept = is_kept(point, PointType::grazing, s, own_event(point, s)) && point.settings.kept->at_end;
        tests.push_back({.type = type,
                         .segment = s,
                         .event = own_event(point, s),
                         .value = event && !kept ? certificate.approach_speeds[s] : nothing,
                         .noise = noise * point.equations.typical_rate(point.at, s),
                         .time = point.solution.orbit.durations[s],
                         .at_end = true,
                         .appears = true});
    }
    for (std::size_t s = 0; s < point.equations.signature().size(); ++s)
        for (const std::size_t event : point.equations.system().mode(point.equations.signature()[s].mode).watched) {
            BranchTest test{.type = type, .segment = s, .event = event, .value = nothing, .appears = true};
            const bool kept = is_kept(point, PointType::grazing, s, event);
            for (const OrbitMinimum& minimum : certificate.minima)
                if (minimum.segment == s && minimum.event == event && !(minimum.value >= test.value) &&
                    !has_zero_duration(point, s) &&
                    !(kept && (point.settings.kept->at_end || minimum.time == point.settings.kept->time)) &&
                    !is_of_contact(point, minimum)) {
                    test.value = minimum.value;
                    test.noise = smallest_clearance * minimum.size;
                    test.time = minimum.time;
                }
            tests.push_back(test);
        }
}

bool confirm_grazing(BranchState& state, SpecialPoint& special, const BranchTest&) {
    // The event that ends an arc, touched at its very end, is that contact without speed.
    constexpr double very_end = 1e-5; // share of the arc
    const Segment& arc = special.solution.orbit.signature[special.segment];
    const double duration = std::abs(special.solution.orbit.durations[special.segment]);
    if (arc.end == SegmentEnd::event && state.model().transitions[arc.index].event == special.event &&
        special.type == PointType::grazing && special.time > (1 - very_end) * duration)
        special.at_end = true;
    if (special.at_end) // their limits are infinite
        special.solution.multipliers.clear();
    special.detail =
        fmt::format("{}{}", state.model().events[special.event].name, special.at_end ? ", no approach speed" : "");
    return true;
}

/// The touch that is kept may come to the end of its segment, which is no second one.
bool confirm_double_grazing(BranchState& state, SpecialPoint& special, const BranchTest& test) {
    constexpr double at_end = 1e-3; // share of the segment: the touch meets its end with the root of what is left
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
    // An arc that vanishes has the contact before it to thank for that.
    constexpr double almost_nothing = 1e-4;
    if (point.at_end)
        return duration > almost_nothing * orbit.period() ? 1 : 2;
    // A minimum that comes or goes through an end of its arc does so because a contact has lost its speed.
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
    return {point.at_end ? with_one_contact_fewer(system, point, settings)
                         : with_one_more_contact(system, point, settings)};
}

/// Of each of its touches the orbits with one contact more or fewer, as far as there are some beside the other one.
std::vector<BranchStart> leave_double_grazing(const System& system, const SpecialPoint& point,
                                              const BranchSettings& settings) {
    std::vector<BranchStart> starts;
    std::string why = "the orbit touches nothing";
    for (const OrbitTouch& touch : touches_of(system, point.solution.orbit)) {
        SpecialPoint one = point;
        one.type = PointType::grazing;
        one.segment = touch.segment;
        one.event = touch.event;
        one.time = touch.time;
        one.at_end = touch.at_end;
        try {
            for (BranchStart& start : leave_grazing(system, one, settings))
                starts.push_back(std::move(start));
        } catch (const InputError& error) {
            why = error.problem();
        }
    }
    if (starts.empty())
        throw InputError(why, "vary another parameter, or start from a grazing beside it");
    return starts;
}

// Events that change their order.

void test_vanishing(const TestedPoint& point, std::vector<BranchTest>& tests) {
    for (std::size_t s = 0; s < point.equations.signature().size(); ++s)
        tests.push_back({.type = PointType::vanishing,
                         .segment = s,
                         .event = own_event(point, s),
                         .value = has_zero_duration(point, s) ? nothing : point.solution.orbit.durations[s]});
}

bool confirm_vanishing(BranchState&, SpecialPoint& special, const BranchTest&) {
    special.detail = fmt::format("segment {}", special.segment + 1);
    return true;
}

std::unique_ptr<OrbitCondition> condition_of_vanishing(const OrbitEquations& equations, const OrbitEvaluation&,
                                                       const SpecialPoint& point) {
    return held(OrbitQuantity::of_vanishing(equations, point.segment));
}

namespace {

/// Where a segment that a curve keeps takes no time, its event happens at the end of the one before, and what happens
/// at the end of that one at its own.
bool belongs_to_vanishing(const TestedPoint& point, const EndValue& end) {
    const std::size_t next = (end.segment + 1) % point.equations.signature().size();
    return has_zero_duration(point, end.segment) ||
           (has_zero_duration(point, next) && own_event(point, next) == end.event &&
            point.equations.signature()[next].end == SegmentEnd::event);
}

} // namespace

void test_two_events(const TestedPoint& point, std::vector<BranchTest>& tests) {
    for (const EndValue& end : point.solution.certificate.end_values) {
        const bool barrier = point.equations.model().events[end.event].kind == EventKind::barrier;
        tests.push_back({.type = PointType::two_events,
                         .segment = end.segment,
                         .event = end.event,
                         .value = barrier && !is_kept(point, PointType::two_events, end.segment, end.event) &&
                                          !belongs_to_vanishing(point, end)
                                      ? end.value
                                      : nothing,
                         .rate = end.rate});
    }
}

/// Two events of which the other one does not fall is a touch at the very end of an arc.
bool confirm_two_events(BranchState& state, SpecialPoint& special, const BranchTest& test) {
    constexpr double without_speed = 1e-6; // of rates of the same function
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

namespace {

/// Whether a segment ends with a kept contact without speed after which others take no time: by what these would set
/// going its guard chooses the next mode, of which nothing is left.
bool is_stop_of_slip(const TestedPoint& point, std::size_t segment) {
    const auto& kept = point.settings.kept;
    const auto held = kept ? held_limit_of(*kept) : std::nullopt;
    return held && held->kind == HeldLimit::Kind::stop && held->segment == segment && held->zero_durations > 0;
}

} // namespace

void test_guard(const TestedPoint& point, std::vector<BranchTest>& tests) {
    for (std::size_t s = 0; s < point.equations.signature().size(); ++s) {
        const double margin = point.solution.certificate.guard_margins[s];
        const bool held = is_kept(point, PointType::guard, s, own_event(point, s)) || is_stop_of_slip(point, s);
        tests.push_back({.type = PointType::guard,
                         .segment = s,
                         .event = own_event(point, s),
                         .value = std::isfinite(margin) && !held ? margin : nothing});
    }
}

bool confirm_guard(BranchState& state, SpecialPoint& special, const BranchTest&) {
    special.detail =
        fmt::format("after {}", end_name(state.model(), special.solution.orbit.signature[special.segment]));
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

/// What an impact makes of the next pass, by its speed: where it is positive the next pass is free, where it is
/// negative it hits the harder. And what impacts in all passes make of one, of equal or of alternating effect: where
/// that is zero curves of folds and flips of the impacting orbits end on that of the touches. With two multipliers all
/// are zero at once (P. Thota, X. Zhao and H. Dankowicz, "Co-dimension-two grazing bifurcations in
/// single-degree-of-freedom impact oscillators", J. Comput. Nonlinear Dynam. 1, 2006).
void test_sensitivity(const TestedPoint& point, std::vector<BranchTest>& tests) {
    constexpr double least = 1e-9; // of a round: less is round-off, as where impacts change nothing of the next pass
    const auto& kept = point.settings.kept;
    if (!kept || kept->type != PointType::grazing || kept->at_end)
        return;
    double next = nothing, same = nothing, alternating = nothing, size = 1;
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

/// The acceleration of what a contact without speed ends its arc with: where it is zero, the touch meets an earlier
/// crossing of the same surface.
void test_acceleration(const TestedPoint& point, std::vector<BranchTest>& tests) {
    constexpr double least = 1e-9; // of what the usual rate would be gained in a round: less is round-off
    const auto& kept = point.settings.kept;
    if (!kept || kept->type != PointType::grazing || !kept->at_end)
        return;
    const OrbitEquations& equations = point.equations;
    const std::size_t mode = equations.signature()[kept->segment].mode;
    const Expression acceleration = rates_of(equations.system(), mode, kept->event, 2).back();
    const auto& last = point.at.pieces[equations.layout().last_piece(kept->segment)];
    std::vector<double> inputs = last.end;
    inputs.insert(inputs.end(), point.at.parameters.begin(), point.at.parameters.end());
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
