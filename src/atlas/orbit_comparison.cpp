#include "atlas/orbit_comparison.hpp"

#include "graze/base/input_error.hpp"
#include "graze/branch/curve_start.hpp"
#include "graze/branch/impacting_curve.hpp"
#include "study/start_point.hpp"

#include <algorithm>
#include <cmath>

namespace graze {

namespace {

/// How much farther apart than neighbouring points of a branch an orbit may be from both, for it to be looked at
/// closely: branches are curved between points.
constexpr double farther = 3, at_least = 1e-3;

/// Whether an orbit may lie between two neighbouring points of a branch.
bool may_lie_between(const FollowedOrbit& one, const FollowedOrbit& other, const OrbitMark& mark,
                     const MarkScales& scales) {
    const double low = std::min(one.mark.at[0], other.mark.at[0]), high = std::max(one.mark.at[0], other.mark.at[0]);
    const double room = same_place * scales.at[0];
    if (!(mark.at[0] >= low - room && mark.at[0] <= high + room))
        return false;
    double step = 0; // the largest of all states, since one of them may have an extremum between the points
    const auto scale = [&](std::size_t i) { return scales.extent(i, one.mark, other.mark); };
    for (std::size_t i = 0; i < scales.extents.size(); ++i)
        if (scale(i) > 0)
            step = std::max(step, std::abs(one.mark.extents[i] - other.mark.extents[i]) / scale(i));
    for (std::size_t i = 0; i < scales.extents.size(); ++i) {
        const double reach = (farther * step + at_least) * scale(i);
        const double least = std::min(one.mark.extents[i], other.mark.extents[i]) - reach;
        const double greatest = std::max(one.mark.extents[i], other.mark.extents[i]) + reach;
        if (!(mark.extents[i] >= least && mark.extents[i] <= greatest))
            return false;
    }
    return true;
}

/// Whether motions may stay on an orbit: also on one at a bifurcation, which repels none.
bool may_stay_on(const OrbitSolution& solution) {
    return number_of_multipliers(solution) > 0 && unstable_directions(solution) == 0;
}

/// The orbit that lies on the straight line between two of the same signature.
Orbit on_line(const Orbit& one, const Orbit& other, double share) {
    Orbit result = one;
    const auto mix = [&](double& value, double far) { value += share * (far - value); };
    for (std::size_t s = 0; s < result.segments(); ++s) {
        for (std::size_t i = 0; i < result.starts[s].size(); ++i)
            mix(result.starts[s][i], other.starts[s][i]);
        mix(result.durations[s], other.durations[s]);
    }
    return result;
}

} // namespace

std::vector<Monitor> mark_monitors(const Model& model) {
    std::vector<Monitor> monitors;
    Monitor& period = monitors.emplace_back();
    period.name = "period";
    period.unit = model.time_unit;
    for (const State& state : model.states)
        if (!state.period && !state.drifting)
            for (const bool greatest : {true, false}) {
                Monitor& one = monitors.emplace_back();
                one.name = (greatest ? "max_" : "min_") + state.name;
                one.unit = state.unit;
                one.kind = greatest ? Monitor::Kind::maximum : Monitor::Kind::minimum;
                one.expression = model.symbol(state.name);
            }
    return monitors;
}

OrbitComparison::OrbitComparison(const Study& study, const StudyRun& atlas, const ResultFile& file)
    : atlas_(&atlas), file_(&file), base_(atlas.model), system_(std::make_unique<System>(atlas.model)),
      monitors_(mark_monitors(atlas.model)) {
    if (atlas.start && file.find_run(atlas.name)) // it has been computed from there
        set_parameters(base_, point_to_start_from(atlas, study, file).parameters);
}

std::optional<OrbitMark> OrbitComparison::mark_of(const OrbitSolution& solution) const {
    if (solution.outcome != OrbitOutcome::converged)
        return std::nullopt;
    const std::vector<double> values = OrbitMonitors(*system_, solution.orbit.signature, monitors_)(solution.orbit);
    OrbitMark mark;
    for (const Variation& axis : atlas_->motion().axes)
        mark.at.push_back(solution.orbit.parameters[axis.parameter.place()]);
    mark.period = values.front();
    mark.extents.assign(values.begin() + 1, values.end());
    return mark;
}

std::optional<OrbitMark> OrbitComparison::mark_of(const SampledMotion& sample, std::string& why) const {
    Model model = base_;
    const auto point = file_->point(sample.run->name, sample.number);
    if (!point) {
        why = "the motion is not in the file";
        return std::nullopt;
    }
    if (point->result.mode >= model.modes.size() || point->result.state.size() != model.states.size()) {
        why = "its state or mode is none of the model";
        return std::nullopt;
    }
    const auto record = file_->find_run(sample.run->name);
    for (std::size_t i = 0; i < record->coordinates.size(); ++i)
        if (model.find_independent_parameter(record->coordinates[i].name))
            model.set_parameter(record->coordinates[i].name, point->coordinates[i]);
    for (std::size_t i = 0; i < model.states.size(); ++i)
        model.set_initial(model.states[i].name, point->result.state[i]);
    model.set_initial_mode(model.modes[point->result.mode].name);
    try {
        const auto mark = mark_of(find_orbit(System(model), atlas_->attractor(), {}, atlas_->motion().simulation));
        if (!mark)
            why = "Newton's method does not find its orbit";
        return mark;
    } catch (const InputError& error) {
        why = error.problem();
        return std::nullopt;
    }
}

std::optional<Orbit> OrbitComparison::between(const FollowedRun& branch, std::size_t index, double value) const {
    const FollowedOrbit &one = branch.orbits[index], &other = branch.orbits[index + 1];
    const auto first = file_->orbit(branch.name(), one.number);
    const auto second = file_->orbit(branch.name(), other.number);
    if (!first || !second)
        return std::nullopt;
    const double from = one.mark.at[0], to = other.mark.at[0];
    const double share = from == to ? 0 : (value - from) / (to - from);
    const Orbit &start = first->point.solution.orbit, &end = second->point.solution.orbit;
    const bool alike = start.signature == end.signature && start.symmetry == end.symmetry;
    Orbit orbit = alike ? on_line(start, end, share) : (share < 0.5 ? start : end);
    orbit.parameters[atlas_->motion().axes[0].parameter.place()] = value;
    return orbit;
}

std::optional<std::size_t> OrbitComparison::place_on(const FollowedRun& branch, const OrbitMark& mark,
                                                     const MarkScales& scales, bool stable) const {
    for (std::size_t i = 0; i + 1 < branch.orbits.size(); ++i) {
        if (!may_lie_between(branch.orbits[i], branch.orbits[i + 1], mark, scales))
            continue;
        const auto guess = between(branch, i, mark.at[0]);
        if (!guess)
            continue;
        const OrbitSolution solution = solve_orbit(*system_, *guess);
        const auto found = mark_of(solution);
        if (found && is_same_orbit(*found, mark, scales, true) && (!stable || may_stay_on(solution)))
            return branch.orbits[i].number;
    }
    return std::nullopt;
}

std::vector<PointType> OrbitComparison::curves_through(const FollowedRun& curve, const FollowedOrbit& point) const {
    const auto record = file_->orbit(curve.name(), point.number);
    if (!record)
        return {};
    try {
        std::vector<PointType> types = curves_at(record->point);
        for (const PointType type : impacting_curves_at(*system_, record->point))
            if (std::ranges::find(types, type) == types.end())
                types.push_back(type);
        return types;
    } catch (const InputError&) { // a changed file: its numbers are not those of such a point
        return {};
    }
}

} // namespace graze
