#include "branch/other_branch.hpp"

#include "branch/orbit_problem.hpp"
#include "graze/base/input_error.hpp"
#include "orbit/drift.hpp"
#include "orbit/newton.hpp"

namespace graze {

namespace {

/// Scaled distance of the first point on another branch.
constexpr double first_distance = 1e-2;

} // namespace

Orbit twice(const Orbit& orbit) {
    Orbit result = orbit;
    result.signature.insert(result.signature.end(), orbit.signature.begin(), orbit.signature.end());
    result.starts.insert(result.starts.end(), orbit.starts.begin(), orbit.starts.end());
    result.durations.insert(result.durations.end(), orbit.durations.begin(), orbit.durations.end());
    return result;
}

std::vector<BranchStart> along_null_vector(const System& system, Orbit orbit, const BranchSettings& settings,
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
        row = vector_of(problem.row_of(problem.unknowns_of(along))).transpose();
    else
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

} // namespace graze
