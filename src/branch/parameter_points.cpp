#include "branch/parameter_points.hpp"

#include "branch/branch_state.hpp"
#include "orbit/eigen_index.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace graze {

namespace {

constexpr double nothing = std::numeric_limits<double>::quiet_NaN();

} // namespace

// Extrema of the period. Where a parameter fixes it, as the frequency of a force, it turns with the parameter at each
// fold, which says nothing more. A parameter that stands still, as the damping of a conservative model, fixes nothing.

void test_extremum(const TestedPoint& point, std::vector<BranchTest>& tests) {
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

namespace {

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

} // namespace

namespace {

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

} // namespace

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

void test_bounds(const TestedPoint& point, std::vector<BranchTest>& tests) {
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

void test_crossings(const TestedPoint& point, std::vector<BranchTest>& tests) {
    for (std::size_t m = 0; m < point.settings.monitors.size(); ++m) {
        const std::vector<double>& wanted = point.settings.monitors[m].crossings;
        for (std::size_t c = 0; c < wanted.size(); ++c)
            tests.push_back(
                {.type = PointType::crossing, .value = point.monitors[m] - wanted[c], .monitor = m, .crossing = c});
    }
}

namespace {

/// By how much a parameter that varies changes over the last step.
double length_of_step(BranchState& state, ParameterId parameter) {
    const std::vector<ParameterId>& free = state.problem().equations().free();
    const auto which = static_cast<std::size_t>(std::find(free.begin(), free.end(), parameter) - free.begin());
    const std::size_t place = state.problem().equations().layout().parameter(which);
    return std::abs(state.continuation().point().u[place] - state.continuation().previous().u[place]);
}

} // namespace

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

} // namespace graze
