#include "branch/point_kind.hpp"

#include "branch/branch_state.hpp"
#include "branch/grazing_switch.hpp"
#include "branch/normal_form.hpp"
#include "branch/orbit_quantity.hpp"
#include "branch/other_branch.hpp"
#include "branch/reordering.hpp"
#include "branch/singular_condition.hpp"
#include "branch/touch_sensitivity.hpp"
#include "graze/symbolic/input_error.hpp"
#include "graze/symbolic/require.hpp"
#include "orbit/certify.hpp"
#include "orbit/eigen_index.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace graze {

namespace {

constexpr double nothing = std::numeric_limits<double>::quiet_NaN();

using Tests = std::vector<BranchTest>;

std::unique_ptr<OrbitCondition> held(OrbitQuantity quantity) {
    return std::make_unique<OrbitQuantity>(std::move(quantity));
}

/// The event that ends a segment; the first one for sections, where it is of no interest.
std::size_t own_event(const TestedPoint& point, std::size_t segment) {
    const Segment& one = point.equations.signature()[segment];
    return one.end == SegmentEnd::event ? point.equations.model().transitions[one.index].event : 0;
}

/// Whether points of this type are what the branch is a curve of: then the test is zero all along it.
bool is_kept(const TestedPoint& point, PointType type) {
    return point.settings.kept && point.settings.kept->type == type;
}
bool is_kept(const TestedPoint& point, PointType type, std::size_t segment, std::size_t event) {
    return is_kept(point, type) && point.settings.kept->segment == segment && point.settings.kept->event == event;
}

// Folds: where monitors are held, the parameter may turn although no multiplier is 1.

void test_fold(const TestedPoint& point, Tests& tests) {
    constexpr double least_rise = 1e-8; // of the parameter's share in the direction of the branch: less is round-off
    BranchTest test{.type = PointType::fold};
    if (point.settings.free.empty()) {
        const std::size_t place = point.equations.layout().parameter(0);
        test.value = point.tangent[place];
        test.noise = least_rise * point.at.scales[index(place)];
    } else {
        test.value = is_kept(point, PointType::fold) ? nothing : point.at.system.periodic_determinant();
        test.noise = point.at.system.periodic_noise();
    }
    tests.push_back(test);
}

std::unique_ptr<OrbitCondition> condition_of_fold(const OrbitEquations& equations, const OrbitEvaluation& at,
                                                  const SpecialPoint&) {
    return SingularCondition::of_multiplier(equations, at, 1);
}

// Flips: the half of a symmetric orbit that changes into its image loses the symmetry instead of doubling its period.

void test_flip(const TestedPoint& point, Tests& tests) {
    const bool tested = !point.equations.symmetry() && !is_kept(point, PointType::flip);
    tests.push_back({.type = PointType::flip, .value = tested ? point.at.system.antiperiodic_determinant() : nothing});
}

void test_asymmetry(const TestedPoint& point, Tests& tests) {
    const bool tested = point.equations.symmetry() && !is_kept(point, PointType::asymmetry);
    tests.push_back(
        {.type = PointType::asymmetry, .value = tested ? point.at.system.antiperiodic_determinant() : nothing});
}

bool confirm_flip(BranchState& state, SpecialPoint& special, const BranchTest&) {
    if (const auto coefficient = flip_coefficient(state.problem().equations(), state.problem().evaluation()))
        special.detail = fmt::format("{}critical, c = {:.6g}", *coefficient > 0 ? "super" : "sub", *coefficient);
    return special.located;
}

std::unique_ptr<OrbitCondition> condition_of_flip(const OrbitEquations& equations, const OrbitEvaluation& at,
                                                  const SpecialPoint&) {
    return SingularCondition::of_multiplier(equations, at, -1);
}

std::vector<BranchStart> leave_flip(const System& system, const SpecialPoint& point, const BranchSettings& settings) {
    return along_null_vector(system, twice(point.solution.orbit), settings, {}, "doubled", false);
}

std::vector<BranchStart> leave_asymmetry(const System& system, const SpecialPoint& point,
                                         const BranchSettings& settings) {
    return along_null_vector(system, whole_orbit(system, point.solution.orbit), settings, {}, "without the symmetry",
                             true);
}

void test_branch_point(const TestedPoint& point, Tests& tests) {
    tests.push_back({.type = PointType::branch_point, .value = point.determinant, .singular = true});
}

std::vector<BranchStart> leave_branch_point(const System& system, const SpecialPoint& point,
                                            const BranchSettings& settings) {
    return along_null_vector(system, point.solution.orbit, settings, point.tangent, "other branch", true);
}

/// Multipliers of the shortest orbit that is followed.
const std::vector<std::complex<double>>& own_multipliers(const OrbitSolution& solution) {
    return solution.half_multipliers.empty() ? solution.multipliers : solution.half_multipliers;
}

/// Product over pairs of multipliers of mu_i mu_j - 1, which vanishes where two of them are inverse to one another: on
/// whole branches of conservative models.
void test_torus(const TestedPoint& point, Tests& tests) {
    constexpr double least_growth = 1e-9; // of the product of a pair less one: less is round-off
    const auto& multipliers = own_multipliers(point.solution);
    BranchTest test{.type = PointType::torus, .value = nothing};
    std::complex<double> product = 1;
    double smallest = 1, others = 1;
    for (std::size_t i = 0; i < multipliers.size(); ++i)
        for (std::size_t j = i + 1; j < multipliers.size(); ++j) {
            const std::complex<double> both = multipliers[i] * multipliers[j],
                                       factor = (both - 1.0) / (1 + std::abs(both));
            product *= factor;
            others *= std::max(std::abs(factor), smallest);
            smallest = std::min(std::abs(factor), smallest);
        }
    if (multipliers.size() >= 2 && std::isfinite(product.real()) && !is_kept(point, PointType::torus))
        test.value = product.real();
    test.noise = least_growth * others;
    tests.push_back(test);
}

bool confirm_torus(BranchState& state, SpecialPoint& special, const BranchTest&) {
    if (const auto coefficient = torus_coefficient(state.problem().equations(), state.problem().evaluation()))
        special.detail = fmt::format("{}critical, d = {:.6g}", *coefficient < 0 ? "super" : "sub", *coefficient);
    const auto& multipliers = own_multipliers(special.solution);
    return special.located && std::any_of(multipliers.begin(), multipliers.end(), [](auto one) {
               return std::abs(one.imag()) > 1e-6 && std::abs(std::abs(one) - 1) < 1e-5;
           });
}

std::unique_ptr<OrbitCondition> condition_of_torus(const OrbitEquations& equations, const OrbitEvaluation& at,
                                                   const SpecialPoint&) {
    return TorusCondition::of_pair(equations, at);
}

// Grazing: an event is met without speed at the end of its arc, or another touched inside of one.

void test_grazing(const TestedPoint& point, Tests& tests) {
    const Certificate& certificate = point.solution.certificate;
    for (std::size_t s = 0; s < point.equations.signature().size(); ++s) {
        const bool event = point.equations.signature()[s].end == SegmentEnd::event;
        const bool kept = is_kept(point, PointType::grazing, s, own_event(point, s)) && point.settings.kept->at_end;
        tests.push_back({.type = PointType::grazing,
                         .segment = s,
                         .event = own_event(point, s),
                         .value = event && !kept ? certificate.approach_speeds[s] : nothing,
                         .noise = least_rate * point.equations.usual_rate(point.at, s),
                         .time = point.solution.orbit.durations[s],
                         .at_end = true,
                         .appears = true});
    }
    for (std::size_t s = 0; s < point.equations.signature().size(); ++s)
        for (const std::size_t event : point.equations.system().mode(point.equations.signature()[s].mode).watched) {
            BranchTest test{
                .type = PointType::grazing, .segment = s, .event = event, .value = nothing, .appears = true};
            const bool kept = is_kept(point, PointType::grazing, s, event);
            for (const OrbitMinimum& minimum : certificate.minima)
                if (minimum.segment == s && minimum.event == event && !(minimum.value >= test.value) &&
                    !(kept && (point.settings.kept->at_end || minimum.time == point.settings.kept->time))) {
                    test.value = minimum.value;
                    test.noise = smallest_clearance * minimum.size;
                    test.time = minimum.time;
                }
            tests.push_back(test);
        }
}

bool confirm_grazing(BranchState& state, SpecialPoint& special, const BranchTest&) {
    if (special.at_end) // their limits are infinite
        special.solution.multipliers.clear();
    special.detail =
        fmt::format("{}{}", state.model().events[special.event].name, special.at_end ? ", no approach speed" : "");
    return true;
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

// Events that change their order.

void test_vanishing(const TestedPoint& point, Tests& tests) {
    for (std::size_t s = 0; s < point.equations.signature().size(); ++s)
        tests.push_back({.type = PointType::vanishing,
                         .segment = s,
                         .event = own_event(point, s),
                         .value = point.solution.orbit.durations[s]});
}

bool confirm_vanishing(BranchState&, SpecialPoint& special, const BranchTest&) {
    special.detail = fmt::format("segment {}", special.segment + 1);
    return true;
}

std::unique_ptr<OrbitCondition> condition_of_vanishing(const OrbitEquations& equations, const OrbitEvaluation&,
                                                       const SpecialPoint& point) {
    return held(OrbitQuantity::of_vanishing(equations, point.segment));
}

void test_two_events(const TestedPoint& point, Tests& tests) {
    for (const EndValue& end : point.solution.certificate.end_values) {
        const bool barrier = point.equations.model().events[end.event].kind == EventKind::barrier;
        tests.push_back(
            {.type = PointType::two_events,
             .segment = end.segment,
             .event = end.event,
             .value = barrier && !is_kept(point, PointType::two_events, end.segment, end.event) ? end.value : nothing,
             .rate = end.rate});
    }
}

/// Two events of which the other one does not fall is a touch at the very end of an arc.
bool confirm_two_events(BranchState& state, SpecialPoint& special, const BranchTest& test) {
    constexpr double without_speed = 1e-6; // of rates of the same function
    const OrbitEquations& equations = state.problem().equations();
    const OrbitEvaluation& at = state.problem().evaluation();
    if (std::abs(test.rate) < without_speed * equations.usual_rate(at, special.segment, special.event)) {
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

void test_guard(const TestedPoint& point, Tests& tests) {
    for (std::size_t s = 0; s < point.equations.signature().size(); ++s) {
        const double margin = point.solution.certificate.guard_margins[s];
        tests.push_back({.type = PointType::guard,
                         .segment = s,
                         .event = own_event(point, s),
                         .value = std::isfinite(margin) ? margin : nothing});
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

// What is more special still on a curve of special points, of which their own condition knows.

template <PointType Type>
void test_degeneracy(const TestedPoint& point, Tests& tests) {
    for (const Degeneracy& one : point.degeneracies)
        if (one.type == Type)
            tests.push_back({.type = Type, .value = one.value});
}

bool confirm_generalised(BranchState& state, SpecialPoint& special, const BranchTest&) {
    special.detail = state.settings().kept->type == PointType::asymmetry ? "of a loss of symmetry" : "";
    return special.located;
}

/// Where fold and flip curves of the impacting orbits end on that of the touches.
void test_sensitivity(const TestedPoint& point, Tests& tests) {
    const auto& kept = point.settings.kept;
    if (!kept || kept->type != PointType::grazing || kept->at_end)
        return;
    const auto value =
        touch_sensitivity(point.equations.simulation(), point.solution.orbit, kept->segment, kept->event, kept->time);
    tests.push_back({.type = PointType::sensitivity, .value = value.value_or(nothing)});
}

bool confirm_sensitivity(BranchState& state, SpecialPoint& special, const BranchTest&) {
    special.detail = fmt::format("of an impact at {}", state.model().events[state.settings().kept->event].name);
    return special.located;
}

// Extrema of the period. Where a parameter fixes it, as the frequency of a force, it turns with the parameter at each
// fold, which says nothing more. A parameter that stands still, as the damping of a conservative model, fixes nothing.

void test_extremum(const TestedPoint& point, Tests& tests) {
    constexpr double least_change = 1e-8; // in units of the period: less is round-off
    const OrbitLayout& layout = point.equations.layout();
    BranchTest test{.type = PointType::extremum, .noise = least_change * point.at.scales[index(layout.duration_of(0))]};
    for (std::size_t k = 0; k < layout.pieces(); ++k)
        test.value += point.tangent[layout.duration_of(k)];
    tests.push_back(test);
    constexpr double least_rise = 1e-8; // of a parameter's share in the direction of a curve
    for (std::size_t f = 0; point.settings.kept && f < layout.free(); ++f)
        tests.push_back({.type = PointType::extremum,
                         .value = point.tangent[layout.parameter(f)],
                         .noise = least_rise * point.at.scales[index(layout.parameter(f))],
                         .parameter = f});
}

/// A parameter is greatest or least on a curve, where not all are at once, as in a cusp.
bool confirm_turn(BranchState& state, SpecialPoint& special, std::size_t parameter) {
    constexpr double standing = 1e-5; // share of the parameters in the direction of the curve
    const OrbitProblem& problem = state.problem();
    const std::vector<double>& rises = special.tangent.parameters;
    const OrbitLayout& layout = problem.equations().layout();
    double greatest = 0;
    for (std::size_t f = 0; f < rises.size(); ++f)
        greatest = std::max(greatest, std::abs(rises[f]) / problem.scales()[layout.parameter(f)]);
    const std::size_t place = problem.equations().free()[parameter].place();
    special.detail = fmt::format("{} = {:.10g}", state.model().independent_parameters()[place],
                                 special.solution.orbit.parameters[place]);
    return special.located && greatest > standing;
}

/// Whether a parameter turns at a point of the last step.
bool turns(BranchState& state, const SpecialPoint& special, std::size_t parameter) {
    constexpr double turning = 1e-5;  // share of the parameter where it turns, of what it is beside that
    constexpr double standing = 1e-8; // in units of the scales: what moves less is round-off
    const OrbitLayout& layout = state.problem().equations().layout();
    const std::size_t place = layout.parameter(parameter);
    const double beside = std::max(std::abs(state.continuation().previous().tangent[place]),
                                   std::abs(state.continuation().point().tangent[place]));
    return beside > standing * state.problem().scales()[place] &&
           std::abs(special.tangent.parameters[parameter]) < turning * beside;
}

bool confirm_extremum(BranchState& state, SpecialPoint& special, const BranchTest& test) {
    if (test.parameter)
        return confirm_turn(state, special, *test.parameter);
    const std::size_t varied = state.settings().kept ? special.tangent.parameters.size() : 1;
    for (std::size_t parameter = 0; parameter < varied; ++parameter)
        if (turns(state, special, parameter))
            return false;
    special.detail = fmt::format("period = {:.10g}", special.solution.orbit.period());
    return special.located;
}

// Bounds and values of parameters and of monitors.

void test_bounds(const TestedPoint& point, Tests& tests) {
    const auto add = [&](std::optional<double> least, std::optional<double> greatest, double value, BranchTest test) {
        const bool always = !test.monitor && !test.free;
        test.type = PointType::bound;
        if (test.value = least ? value - *least : nothing; least || always)
            tests.push_back(test);
        if (test.value = greatest ? *greatest - value : nothing; greatest || always)
            tests.push_back(test);
    };
    const BranchSettings& settings = point.settings;
    const std::vector<double>& parameters = point.at.parameters;
    add(settings.least, settings.greatest, parameters[settings.parameter.place()], {});
    for (std::size_t f = 0; f < settings.free_bounds.size(); ++f) {
        const FreeBounds& bounds = settings.free_bounds[f];
        add(bounds.least, bounds.greatest, parameters[bounds.parameter.place()], {.free = f});
    }
    for (std::size_t m = 0; m < settings.monitors.size(); ++m)
        add(settings.monitors[m].least, settings.monitors[m].greatest, point.monitors[m], {.monitor = m});
}

void test_crossings(const TestedPoint& point, Tests& tests) {
    for (std::size_t m = 0; m < point.settings.monitors.size(); ++m) {
        const std::vector<double>& wanted = point.settings.monitors[m].crossings;
        for (std::size_t c = 0; c < wanted.size(); ++c)
            tests.push_back(
                {.type = PointType::crossing, .value = point.monitors[m] - wanted[c], .monitor = m, .crossing = c});
    }
}

/// By how much a parameter that varies changes over the last step.
double length_of_step(BranchState& state, ParameterId parameter) {
    const std::vector<ParameterId>& free = state.problem().equations().free();
    const auto which = static_cast<std::size_t>(std::find(free.begin(), free.end(), parameter) - free.begin());
    const std::size_t place = state.problem().equations().layout().parameter(which);
    return std::abs(state.continuation().point().u[place] - state.continuation().previous().u[place]);
}

bool confirm_bound(BranchState& state, SpecialPoint& special, const BranchTest& test) {
    const BranchSettings& settings = state.settings();
    if (test.monitor) {
        special.detail =
            fmt::format("{} = {:.10g}", settings.monitors[*test.monitor].name, special.monitors[*test.monitor]);
        return special.located;
    }
    const FreeBounds bounds = test.free ? settings.free_bounds[*test.free]
                                        : FreeBounds{settings.parameter, settings.least, settings.greatest};
    double& value = special.solution.orbit.parameters[bounds.parameter.place()];
    // Round-off would leave the bound on the one side or the other.
    for (const auto& bound : {bounds.least, bounds.greatest})
        if (bound && std::abs(value - *bound) < 1e-9 * length_of_step(state, bounds.parameter))
            value = *bound;
    special.parameter = special.solution.orbit.parameters[settings.parameter.place()];
    special.detail =
        fmt::format("{} = {:.10g}", state.model().independent_parameters()[bounds.parameter.place()], value);
    return special.located;
}

bool confirm_crossing(BranchState& state, SpecialPoint& special, const BranchTest& test) {
    const Monitor& monitor = state.settings().monitors[*test.monitor];
    special.detail = fmt::format("{} = {:.10g}", monitor.name, monitor.crossings[test.crossing]);
    return special.located;
}

template <int Rank>
int always(const SpecialPoint&) {
    return Rank;
}

/// Entries that have no function are written without one.
constexpr std::array table{
    PointRule{.kind = {.type = PointType::fold,
                       .short_name = "SN",
                       .name = "fold",
                       .changes = true,
                       .may_stop = true,
                       .may_be_kept = true,
                       .mark = 7},
              .test = test_fold,
              .condition = condition_of_fold},
    PointRule{.kind = {.type = PointType::flip,
                       .short_name = "PD",
                       .name = "flip",
                       .changes = true,
                       .leads_on = true,
                       .may_stop = true,
                       .may_be_kept = true,
                       .mark = 9},
              .test = test_flip,
              .confirm = confirm_flip,
              .condition = condition_of_flip,
              .leave = leave_flip},
    PointRule{.kind = {.type = PointType::torus,
                       .short_name = "NS",
                       .name = "torus",
                       .changes = true,
                       .may_stop = true,
                       .may_be_kept = true,
                       .mark = 13},
              .test = test_torus,
              .confirm = confirm_torus,
              .condition = condition_of_torus},
    PointRule{.kind = {.type = PointType::branch_point,
                       .short_name = "BP",
                       .name = "branch point",
                       .changes = true,
                       .leads_on = true,
                       .may_stop = true,
                       .mark = 5},
              .test = test_branch_point,
              .leave = leave_branch_point},
    PointRule{.kind = {.type = PointType::asymmetry,
                       .short_name = "SB",
                       .name = "loss of symmetry",
                       .changes = true,
                       .leads_on = true,
                       .may_stop = true,
                       .may_be_kept = true,
                       .mark = 5},
              .test = test_asymmetry,
              .confirm = confirm_flip,
              .condition = condition_of_flip,
              .leave = leave_asymmetry},
    PointRule{.kind = {.type = PointType::grazing,
                       .short_name = "GR",
                       .name = "grazing",
                       .changes = true,
                       .limits = true,
                       .leads_on = true,
                       .may_stop = true,
                       .may_be_kept = true,
                       .mark = 12},
              .test = test_grazing,
              .confirm = confirm_grazing,
              .rank = rank_of_grazing,
              .condition = condition_of_grazing,
              .leave = leave_grazing},
    PointRule{.kind = {.type = PointType::vanishing,
                       .short_name = "DZ",
                       .name = "vanishing segment",
                       .changes = true,
                       .limits = true,
                       .may_stop = true,
                       .mark = 8},
              .test = test_vanishing,
              .confirm = confirm_vanishing,
              .rank = always<3>,
              .condition = condition_of_vanishing,
              .leave = leave_order},
    PointRule{.kind = {.type = PointType::two_events,
                       .short_name = "EE",
                       .name = "two events at once",
                       .changes = true,
                       .limits = true,
                       .may_stop = true,
                       .mark = 4},
              .test = test_two_events,
              .confirm = confirm_two_events,
              .rank = always<4>,
              .condition = condition_of_two_events,
              .leave = leave_order},
    PointRule{.kind = {.type = PointType::guard,
                       .short_name = "GU",
                       .name = "guard",
                       .changes = true,
                       .limits = true,
                       .may_stop = true,
                       .mark = 10},
              .test = test_guard,
              .confirm = confirm_guard,
              .rank = always<5>,
              .condition = condition_of_guard,
              .leave = leave_order},
    PointRule{.kind = {.type = PointType::cusp, .short_name = "CP", .name = "cusp", .may_stop = true, .mark = 3},
              .test = test_degeneracy<PointType::cusp>},
    PointRule{.kind = {.type = PointType::generalised,
                       .short_name = "GF",
                       .name = "generalised flip",
                       .may_stop = true,
                       .mark = 11},
              .test = test_degeneracy<PointType::generalised>,
              .confirm = confirm_generalised},
    PointRule{
        .kind =
            {.type = PointType::resonance_1, .short_name = "R1", .name = "1:1 resonance", .may_stop = true, .mark = 6},
        .test = test_degeneracy<PointType::resonance_1>},
    PointRule{
        .kind =
            {.type = PointType::resonance_2, .short_name = "R2", .name = "1:2 resonance", .may_stop = true, .mark = 6},
        .test = test_degeneracy<PointType::resonance_2>},
    PointRule{
        .kind =
            {.type = PointType::resonance_3, .short_name = "R3", .name = "1:3 resonance", .may_stop = true, .mark = 6},
        .test = test_degeneracy<PointType::resonance_3>},
    PointRule{
        .kind =
            {.type = PointType::resonance_4, .short_name = "R4", .name = "1:4 resonance", .may_stop = true, .mark = 6},
        .test = test_degeneracy<PointType::resonance_4>},
    PointRule{.kind = {.type = PointType::sensitivity,
                       .short_name = "VS",
                       .name = "vanishing sensitivity",
                       .may_stop = true,
                       .mark = 14},
              .test = test_sensitivity,
              .confirm = confirm_sensitivity},
    PointRule{
        .kind = {.type = PointType::extremum, .short_name = "EX", .name = "extremum", .may_stop = true, .mark = 1},
        .test = test_extremum,
        .confirm = confirm_extremum},
    PointRule{.kind = {.type = PointType::bound, .short_name = "BD", .name = "bound"},
              .test = test_bounds,
              .confirm = confirm_bound},
    PointRule{
        .kind = {.type = PointType::crossing, .short_name = "UZ", .name = "crossing", .may_stop = true, .mark = 2},
        .test = test_crossings,
        .confirm = confirm_crossing},
    PointRule{.kind = {.type = PointType::end, .short_name = "EP", .name = "end"}},
    PointRule{.kind = {.type = PointType::regular, .short_name = "RG", .name = "regular"}},
};

constexpr auto kinds = [] {
    std::array<PointKind, table.size()> result;
    for (std::size_t i = 0; i < table.size(); ++i)
        result[i] = table[i].kind;
    return result;
}();

} // namespace

std::span<const PointRule> point_rules() {
    return table;
}

const PointRule& rule_of(PointType type) {
    require_index(static_cast<std::size_t>(type), table.size(), "type of points");
    return table[static_cast<std::size_t>(type)];
}

std::span<const PointKind> point_kinds() {
    return kinds;
}

const PointKind& kind_of(PointType type) {
    return rule_of(type).kind;
}

std::optional<PointType> point_type(std::string_view name) {
    for (const PointRule& rule : table)
        if (name == rule.kind.short_name)
            return rule.kind.type;
    return std::nullopt;
}

std::vector<BranchTest> branch_tests(const TestedPoint& point) {
    Tests tests;
    for (const PointRule& rule : table)
        if (rule.test)
            rule.test(point, tests);
    return tests;
}

} // namespace graze
