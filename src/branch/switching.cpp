#include "graze/branch/switching.hpp"

#include "branch/grazing_switch.hpp"
#include "branch/orbit_problem.hpp"
#include "branch/reordering.hpp"
#include "graze/symbolic/input_error.hpp"
#include "graze/symbolic/require.hpp"
#include "orbit/drift.hpp"
#include "orbit/newton.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace graze {

namespace {

/// First distance onto another branch, in units of the scales.
constexpr double first_distance = 1e-2;

Orbit twice(const Orbit& orbit) {
    Orbit result = orbit;
    result.signature.insert(result.signature.end(), orbit.signature.begin(), orbit.signature.end());
    result.starts.insert(result.starts.end(), orbit.starts.begin(), orbit.starts.end());
    result.durations.insert(result.durations.end(), orbit.durations.begin(), orbit.durations.end());
    return result;
}

/// Both ways along the null vector of an orbit's equations that is orthogonal to a row.
std::vector<BranchStart> both_ways(const System& system, Orbit orbit, const BranchSettings& settings,
                                   const OrbitDirection& along, const std::string& how, bool second) {
    const Simulation simulation(system, {}, {}, integration(settings.orbit.tolerance));
    join_drifts(simulation, orbit);
    OrbitProblem problem(simulation, orbit, settings.parameter);
    const auto fail = [] {
        throw InputError("the direction of the other branch could not be found", "try another point");
    };
    if (!problem.evaluate(problem.unknowns_of(orbit)))
        fail();
    Eigen::RowVectorXd row = Eigen::RowVectorXd::Zero(static_cast<Eigen::Index>(problem.unknowns()));
    if (!along.is_empty())
        row = OrbitProblem::vector_of(problem.row_of(problem.unknowns_of(along))).transpose();
    else // orbits of the new kind appear at a turning point
        row[static_cast<Eigen::Index>(problem.parameter_place())] = 1;
    Eigen::VectorXd vector;
    if (!problem.equations().null_vector(problem.evaluation(), row, vector))
        fail();
    const OrbitDirection direction = problem.equations().direction_of(vector);
    std::vector<BranchStart> result{{orbit, direction, first_distance, how}};
    if (second)
        result.push_back({orbit, direction, -first_distance, how + ", the other way"});
    return result;
}

} // namespace

std::vector<BranchStart> branches_at(const System& system, const SpecialPoint& point, const BranchSettings& settings) {
    const Model& model = system.model();
    settings.validate(model);
    const Orbit& orbit = point.solution.orbit;
    switch (point.type) {
    case PointType::grazing:
    case PointType::vanishing:
    case PointType::two_events:
    case PointType::guard:
        require_index(point.segment, orbit.segments(), "segment");
        require_index(point.event, model.events.size(), "event");
        require_finite(point.time, "the time of the point");
        [[fallthrough]];
    case PointType::flip:
    case PointType::asymmetry:
    case PointType::branch_point:
        validate_orbit(model, orbit);
        break;
    default:
        throw InputError(fmt::format("no other branch leaves from a point of type {} ({})", short_name(point.type),
                                     name_of(point.type)),
                         "choose one of type PD, BP, SB, GR, DZ, EE or GU, or vary another parameter from it");
    }
    switch (point.type) {
    case PointType::flip:
        return both_ways(system, twice(orbit), settings, {}, "doubled", false);
    case PointType::asymmetry:
        return both_ways(system, whole_orbit(system, orbit), settings, {}, "without the symmetry", true);
    case PointType::branch_point:
        return both_ways(system, orbit, settings, point.tangent, "other branch", true);
    case PointType::grazing:
        return {point.at_end ? with_one_contact_fewer(system, point, settings)
                             : with_one_more_contact(system, point, settings)};
    default:
        return {with_events_reordered(system, point, settings)};
    }
}

} // namespace graze
