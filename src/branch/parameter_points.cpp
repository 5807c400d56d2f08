#include "branch/parameter_points.hpp"

#include "base/concatenated.hpp"
#include "branch/branch_state.hpp"
#include "orbit/eigen_index.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace graze {

// Extrema of the period. If a parameter such as the forcing frequency determines the period, its extrema are the folds
// and are not reported. A parameter that is constant along the branch, as the damping of a conservative model, does not
// determine it.

void test_extremum(const TestedPoint& point, std::vector<BranchTest>& tests) {
    constexpr double least_change = 1e-8; // share of the period: smaller values are round-off
    const OrbitLayout& layout = point.equations.layout();
    BranchTest test{.type = PointType::extremum, .noise = least_change * point.at.scales[index(layout.duration_of(0))]};
    for (std::size_t k = 0; k < layout.pieces(); ++k)
        test.value += point.tangent[layout.duration_of(k)];
    tests.push_back(test);
    constexpr double least_rise = 1e-8; // share of a parameter in the tangent of a curve
    for (std::size_t f = 0; point.settings.kept && f < layout.free(); ++f)
        tests.push_back({.type = PointType::extremum,
                         .value = point.tangent[layout.parameter(f)],
                         .noise = least_rise * point.at.scales[index(layout.parameter(f))],
                         .parameter = f});
}

namespace {

/// Confirms an extremum of a parameter on a curve, unless all parameters have one, as at a cusp.
bool confirm_parameter_extremum(BranchState& state, SpecialPoint& special, std::size_t parameter) {
    constexpr double constant = 1e-5; // smallest share of the parameters in the tangent
    const OrbitProblem& problem = state.problem();
    const std::vector<double>& rises = special.tangent.parameters;
    const OrbitLayout& layout = problem.equations().layout();
    double greatest = 0;
    for (std::size_t f = 0; f < rises.size(); ++f)
        greatest = std::max(greatest, std::abs(rises[f]) / problem.scales()[layout.parameter(f)]);
    const std::size_t place = problem.equations().free()[parameter].place();
    special.detail = fmt::format("{} = {:.10g}", state.model().independent_parameters()[place],
                                 special.solution.orbit.parameters[place]);
    return special.located && greatest > constant;
}

/// True when a parameter has an extremum at a point of the last step.
bool has_extremum(BranchState& state, const SpecialPoint& special, std::size_t parameter) {
    constexpr double turning = 1e-5;  // ratio of the tangent component at the extremum to that at the ends of the step
    constexpr double constant = 1e-8; // scaled tangent component below which the parameter is constant
    const OrbitLayout& layout = state.problem().equations().layout();
    const std::size_t place = layout.parameter(parameter);
    const double beside = std::max(std::abs(state.continuation().previous().tangent[place]),
                                   std::abs(state.continuation().point().tangent[place]));
    return beside > constant * state.problem().scales()[place] &&
           std::abs(special.tangent.parameters[parameter]) < turning * beside;
}

/// True when a cyclic state, such as the phase of a force, has a rate that depends on no states and on at most one
/// varying parameter: then the period has an extremum only where that parameter does.
bool follows_force(BranchState& state, const Orbit& orbit) {
    const OrbitEquations& equations = state.problem().equations();
    const System& system = state.system();
    Model model = state.model();
    const std::size_t states = model.states.size();
    const auto period = system.period_gradients()(orbit.parameters);
    const auto is_force = [&](std::size_t i) {
        const auto row = period.begin() + static_cast<std::ptrdiff_t>(i * orbit.parameters.size());
        bool forces =
            model.states[i].period && std::all_of(row, row + static_cast<std::ptrdiff_t>(orbit.parameters.size()),
                                                  [](double one) { return one == 0; });
        for (std::size_t s = 0; forces && s < orbit.segments(); ++s) {
            const Segment& segment = orbit.signature[s];
            const std::vector<double> inputs = concatenated(orbit.starts[s], orbit.parameters);
            const Expression rate = model.expand(model.modes[segment.mode].rates[i]);
            const Eigen::VectorXd by_all = equations.gradient_of(system.with_gradient(rate)(inputs));
            forces = by_all.head(index(states)).isZero(0) &&
                     (by_all.tail(by_all.size() - index(states)).array() != 0).count() <= 1;
            const auto changes = [&](std::size_t jump) {
                const auto& changed = system.jump(jump).changed;
                return std::find(changed.begin(), changed.end(), i) != changed.end();
            };
            if (const Transition* const transition = transition_of(model, segment))
                forces = forces && !changes(transition->jump) &&
                         (segment.end == SegmentEnd::event || !changes(transition->chatter->jump));
        }
        return forces;
    };
    for (std::size_t i = 0; i < states; ++i)
        if (is_force(i))
            return true;
    return false;
}

} // namespace

bool confirm_extremum(BranchState& state, SpecialPoint& special, const BranchTest& test) {
    if (test.parameter)
        return confirm_parameter_extremum(state, special, *test.parameter);
    if (follows_force(state, special.solution.orbit))
        return false;
    const std::size_t varied = state.settings().kept ? special.tangent.parameters.size() : 1;
    for (std::size_t parameter = 0; parameter < varied; ++parameter)
        if (has_extremum(state, special, parameter))
            return false;
    special.detail = fmt::format("period = {:.10g}", special.solution.orbit.period());
    return special.located;
}

// Values of monitors.

void test_crossings(const TestedPoint& point, std::vector<BranchTest>& tests) {
    for (std::size_t m = 0; m < point.settings.monitors.size(); ++m) {
        const std::vector<double>& wanted = point.settings.monitors[m].crossings;
        for (std::size_t c = 0; c < wanted.size(); ++c)
            tests.push_back(
                {.type = PointType::crossing, .value = point.monitors[m] - wanted[c], .monitor = m, .crossing = c});
    }
}

bool confirm_crossing(BranchState& state, SpecialPoint& special, const BranchTest& test) {
    const Monitor& monitor = state.settings().monitors[*test.monitor];
    special.detail = fmt::format("{} = {:.10g}", monitor.name, monitor.crossings[test.crossing]);
    return special.located;
}

} // namespace graze
