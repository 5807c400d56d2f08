#include "branch/shrinking_orbit.hpp"

#include "branch/crossing.hpp"
#include "orbit/orbit_flow.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace graze {

namespace {

/// Returns the scaled rates at the start of a segment.
std::vector<double> motion_at(BranchState& state, const Orbit& orbit, std::size_t segment) {
    std::vector<double> rates = state.rates_at(orbit, segment);
    for (std::size_t i = 0; i < rates.size(); ++i)
        rates[i] /= state.problem().scales()[i];
    return rates;
}

double product(const std::vector<double>& one, const std::vector<double>& other) {
    double sum = 0;
    for (std::size_t i = 0; i < one.size(); ++i)
        sum += one[i] * other[i];
    return sum;
}

/// Returns the largest scaled rate at the starts of all segments.
double largest_motion(BranchState& state, const Orbit& orbit) {
    double largest = 0;
    for (std::size_t s = 0; s < orbit.segments(); ++s)
        for (const double rate : motion_at(state, orbit, s))
            largest = std::max(largest, std::abs(rate));
    return largest;
}

/// Returns a description of the surface on which an orbit with contacts shrinks.
std::string surface_of(const Model& model, const Orbit& orbit) {
    for (const Segment& segment : orbit.signature)
        if (segment.end == SegmentEnd::event)
            return fmt::format(" on the surface of event '{}'",
                               model.events[model.transitions[segment.index].event].name);
    return "";
}

/// @param off error of the parameter
SpecialPoint hopf_at(BranchState& state, const BranchPoint& there, double arclength, double error) {
    SpecialPoint special = special_of_type(PointType::hopf, there);
    special.arclength = arclength;
    special.detail = fmt::format("{} +- {:.1e}: the orbit shrinks to an equilibrium{}",
                                 state.model().independent_parameters()[state.settings().parameter.place()], error,
                                 surface_of(state.model(), there.solution.orbit));
    special.solution.error = error / state.problem().scales()[state.problem().parameter_place()];
    return special;
}

} // namespace

bool has_reversed(BranchState& state, const Orbit& before, const Orbit& now) {
    return before.signature == now.signature && product(motion_at(state, before, 0), motion_at(state, now, 0)) < 0;
}

std::optional<SpecialPoint> locate_equilibrium(BranchState& state, const Orbit& before) {
    // Parameter and period change with the square of the orbit's size, so distant points are accurate too. Nearer
    // points have more round-off, farther ones a larger interpolation error: the choice with the smaller difference is
    // used.
    constexpr double nearer[] = {1, 0.5};
    constexpr double at_rest = 1e-2; // share of the rates at the start of the step
    // Both locations share errors, which in tests are up to four times their difference.
    constexpr double times = 10, round_off = 1e-13;
    const std::vector<double> first = motion_at(state, before, 0);
    const double size = product(first, first);
    const auto value = [&](const ContinuationPoint& point) {
        return product(first, motion_at(state, state.problem().orbit_of(point.u), 0));
    };
    const TestValue begin{0, size}, end{1, value(state.continuation().point())};
    const std::size_t place = state.problem().parameter_place();
    std::optional<ContinuationPoint> found;
    double differ = 0;
    for (const double scale : nearer) {
        const auto located = [&](std::array<double, 8> offsets) {
            for (double& offset : offsets)
                offset *= scale;
            return locate_crossing(state.continuation(), value, begin, end, offsets);
        };
        const auto one = located({-0.4, -0.3, -0.2, -0.1, 0.1, 0.2, 0.3, 0.4}),
                   other = located({-0.44, -0.34, -0.22, -0.12, 0.12, 0.22, 0.34, 0.44});
        if (!one || !other)
            continue;
        const double error = std::abs(one->u[place] - other->u[place]);
        if (found && !(error < differ))
            continue;
        found = one;
        differ = error;
    }
    BranchPoint there;
    std::vector<BranchTest> tests;
    if (!found || !state.describe(*found, there, tests) ||
        largest_motion(state, there.solution.orbit) > at_rest * largest_motion(state, before))
        return std::nullopt;
    const double error =
        times * differ + round_off * std::max(std::abs(found->u[place]), state.problem().scales()[place]);
    return hopf_at(state, there, there.arclength, error);
}

namespace {

bool is_without_contacts(const Orbit& orbit) {
    return std::all_of(orbit.signature.begin(), orbit.signature.end(), [&](const Segment& segment) {
        return segment.end != SegmentEnd::event && segment.mode == orbit.signature[0].mode;
    });
}

/// Returns states along an orbit without contacts, at equal time intervals; empty where it cannot be followed.
std::vector<std::vector<double>> states_along(BranchState& state, const Orbit& orbit) {
    constexpr int count = 64;
    ModeFlow flow = flow_of(state.problem().equations().simulation());
    flow.set_parameters(orbit.parameters);
    std::vector<std::vector<double>> result{orbit.starts[0]};
    for (int i = 1; i < count; ++i) {
        result.push_back(result.back());
        if (flow.run(orbit.signature[0].mode, result.back(), orbit.return_time() / count) != ModeFlow::Ending::done)
            return {};
    }
    return result;
}

} // namespace

std::optional<HopfPoint> hopf_ahead(BranchState& state, const ContinuationPoint& from, double length) {
    // An oblique cut of an ellipse may be touched at a considerable distance from its centre.
    constexpr double farthest = 4, same_period = 0.25;
    const Orbit orbit = state.problem().orbit_of(from.u);
    const std::vector<std::vector<double>> along =
        is_without_contacts(orbit) ? states_along(state, orbit) : std::vector<std::vector<double>>();
    if (along.empty())
        return std::nullopt;
    std::vector<double> mean(orbit.starts[0].size(), 0.0);
    for (const std::vector<double>& one : along)
        for (std::size_t i = 0; i < mean.size(); ++i)
            mean[i] += one[i] / static_cast<double>(along.size());
    const std::vector<double> scales(state.problem().scales().begin(), state.problem().scales().end());
    const auto hopf = hopf_near(state.system(), orbit.signature[0].mode, mean, orbit.parameters,
                                state.settings().parameter, orbit.period(), std::span(scales).first(mean.size()));
    if (!hopf || std::abs(hopf->period - orbit.period()) > same_period * orbit.period() ||
        !(distance_to(state, from, *hopf) < farthest * length))
        return std::nullopt;
    return hopf;
}

Orbit at_rest_in(const Orbit& orbit, const HopfPoint& hopf, ParameterId parameter) {
    Orbit result = orbit;
    for (double& duration : result.durations)
        duration *= hopf.period / orbit.period();
    for (std::vector<double>& start : result.starts)
        start = hopf.state;
    result.parameters[parameter.place()] = hopf.parameter;
    return result;
}

double distance_to(BranchState& state, const ContinuationPoint& from, const HopfPoint& hopf) {
    OrbitProblem& problem = state.problem();
    std::vector<double> distance =
        problem.unknowns_of(at_rest_in(problem.orbit_of(from.u), hopf, state.settings().parameter));
    for (std::size_t i = 0; i < distance.size(); ++i)
        distance[i] -= from.u[i];
    return std::sqrt(product(problem.row_of(distance), distance));
}

std::optional<UncutOrbit> begun_for_shrinking(BranchState& state, const Orbit& orbit, const HopfPoint& hopf) {
    const std::vector<std::vector<double>> along = states_along(state, orbit);
    if (along.empty())
        return std::nullopt;
    const auto error = [&](const std::vector<double>& one) {
        double sum = 0;
        for (std::size_t i = 0; i < one.size(); ++i)
            sum += std::pow((one[i] - hopf.state[i]) / state.problem().scales()[i], 2);
        return sum;
    };
    const auto farthest =
        std::max_element(along.begin(), along.end(), [&](const auto& a, const auto& b) { return error(a) < error(b); });
    UncutOrbit result{orbit, {}};
    result.orbit.signature = {{orbit.signature[0].mode, SegmentEnd::cut, 0}};
    result.orbit.starts = {*farthest};
    result.orbit.durations = {orbit.return_time()};
    const Orbit rest = at_rest_in(result.orbit, hopf, state.settings().parameter);
    OrbitDirection& direction = result.direction;
    direction.starts = rest.starts;
    for (std::size_t i = 0; i < farthest->size(); ++i)
        direction.starts[0][i] -= (*farthest)[i];
    direction.durations = {rest.durations[0] - result.orbit.durations[0]};
    const std::size_t place = state.settings().parameter.place();
    direction.parameters = {rest.parameters[place] - orbit.parameters[place]};
    return result;
}

bool shrinks_to(const HopfPoint& hopf, ParameterId parameter, const Orbit& before, const Orbit& now) {
    constexpr double share = 0.3, round_off = 1e-9;
    const auto error = [&](const Orbit& orbit) {
        return std::abs(orbit.parameters[parameter.place()] - hopf.parameter);
    };
    const auto off_period = [&](const Orbit& orbit) { return std::abs(orbit.period() - hopf.period); };
    return error(now) <= share * error(before) + round_off * std::abs(hopf.parameter) &&
           off_period(now) <= share * off_period(before) + round_off * hopf.period;
}

std::optional<SpecialPoint> end_in(BranchState& state, const HopfPoint& hopf, double arclength, double distance) {
    ContinuationPoint at = state.continuation().point();
    at.u = state.problem().unknowns_of(at_rest_in(state.problem().orbit_of(at.u), hopf, state.settings().parameter));
    BranchPoint there;
    std::vector<BranchTest> tests;
    if (!state.describe(at, there, tests))
        return std::nullopt;
    const std::size_t place = state.problem().parameter_place();
    constexpr double round_off = 1e-13;
    const double error = hopf.error + round_off * std::max(std::abs(hopf.parameter), state.problem().scales()[place]);
    return hopf_at(state, there, arclength + distance, error);
}

} // namespace graze
