#include "branch/reordering.hpp"

#include "branch/inserted_contact.hpp"
#include "branch/orbit_problem.hpp"
#include "graze/symbolic/input_error.hpp"
#include "orbit/certify.hpp"
#include "orbit/close_at_section.hpp"
#include "orbit/newton.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

namespace graze {

namespace {

/// How far beyond the point the model's motion is looked at, in units of the scales.
constexpr double distances[] = {1e-4, 1e-5, 1e-3, 1e-6};

/// What the model does for one round from the middle of an orbit's longest segment, as an orbit.
std::optional<Orbit> followed(const Simulation& simulation, const Orbit& orbit, std::string& why) {
    const double round = orbit.round();
    const auto longest = static_cast<std::size_t>(std::max_element(orbit.durations.begin(), orbit.durations.end()) -
                                                  orbit.durations.begin());
    std::vector<double> state = orbit.starts[longest];
    const std::size_t mode = orbit.signature[longest].mode;
    ModeFlow flow = flow_of(simulation);
    flow.set_parameters(orbit.parameters);
    if (flow.run(mode, state, 0.5 * orbit.durations[longest]) != ModeFlow::Ending::done) {
        why = "the orbit cannot be followed";
        return std::nullopt;
    }
    const FollowedMotion motion = follow_motion(simulation, orbit.parameters, state, mode, round);
    if (!motion.problem.empty()) {
        why = motion.problem;
        return std::nullopt;
    }
    return motion.segments.empty()
               ? close_at_section(simulation.system(), orbit.parameters, state, mode, round, "", orbit.symmetry)
               : std::optional(begun_after_first_contact(simulation.system(), orbit, motion, round));
}

/// Whether orbits have the same segments, wherever they begin: then the one is on the branch of the other.
bool are_alike(const Orbit& one, const Orbit& other) {
    Signature signature = one.signature;
    if (signature.size() != other.signature.size())
        return false;
    for (std::size_t k = 0; k < signature.size(); ++k) {
        if (signature == other.signature)
            return true;
        std::rotate(signature.begin(), signature.begin() + 1, signature.end());
    }
    return false;
}

} // namespace

namespace {

/// Unknowns along the branch in the first parameter, of unit length in units of the scales. None where it turns.
std::optional<Eigen::VectorXd> along_branch(const Simulation& simulation, const Orbit& orbit,
                                            const BranchSettings& settings, const OrbitProblem& with_all) {
    OrbitProblem problem(simulation, orbit, settings.parameter);
    std::vector<double> row(problem.unknowns(), 0.0), onward(problem.unknowns());
    row[problem.parameter_place()] = 1;
    if (!problem.evaluate(problem.unknowns_of(orbit)) || !problem.solve(row, 1, true, onward, nullptr))
        return std::nullopt;
    const std::vector<double> all = with_all.unknowns_of(problem.direction_of(onward));
    const Eigen::VectorXd result = OrbitProblem::vector_of(all);
    return result / result.cwiseQuotient(OrbitProblem::vector_of(with_all.scales())).norm();
}

} // namespace

std::optional<Orbit> reordered_beyond(const System& system, const SpecialPoint& point, const BranchSettings& settings,
                                      double distance, double aside) {
    const Simulation simulation(system, {}, {}, integration(settings.orbit.tolerance));
    const Orbit& orbit = point.solution.orbit;
    OrbitProblem problem(simulation, orbit, settings);
    const std::vector<double> u = problem.unknowns_of(orbit);
    if (point.tangent.is_empty() || !problem.evaluate(u))
        return std::nullopt;
    const std::vector<double> tangent = problem.unknowns_of(point.tangent);
    Eigen::VectorXd there = OrbitProblem::vector_of(u) + distance * OrbitProblem::vector_of(tangent);
    if (aside != 0) {
        const auto off = along_branch(simulation, orbit, settings, problem);
        if (!off)
            return std::nullopt;
        there += aside * *off;
    }
    std::string why;
    auto candidate = followed(simulation, problem.equations().orbit_of(there), why);
    return candidate && !are_alike(*candidate, orbit) ? candidate : std::nullopt;
}

BranchStart with_events_reordered(const System& system, const SpecialPoint& point, const BranchSettings& settings) {
    const Simulation simulation(system, {}, {}, integration(settings.orbit.tolerance));
    const Orbit& orbit = point.solution.orbit;
    std::string why = "the branch's direction is not known";
    OrbitProblem problem(simulation, orbit, settings.parameter);
    const std::vector<double> u = problem.unknowns_of(orbit);
    if (!point.tangent.is_empty() && problem.evaluate(u)) {
        const std::vector<double> tangent = problem.unknowns_of(point.tangent);
        for (const double distance : distances)
            for (const double side : {1.0, -1.0}) {
                const Eigen::VectorXd there =
                    OrbitProblem::vector_of(u) + side * distance * OrbitProblem::vector_of(tangent);
                Orbit beyond = problem.equations().orbit_of(there);
                const auto candidate = followed(simulation, beyond, why);
                if (!candidate || are_alike(*candidate, orbit))
                    continue;
                OrbitOptions options = settings.orbit;
                options.error_estimate = false;
                OrbitSolution solution;
                try {
                    solution = solve_orbit(system, *candidate, options);
                } catch (const InputError& error) { // the motion does not close to a signature of the model
                    why = error.problem();
                    continue;
                }
                if (solution.outcome != OrbitOutcome::converged) {
                    why = solution.detail;
                    continue;
                }
                if (!is_admissible(simulation, solution.orbit, why))
                    continue;
                OrbitProblem next(simulation, solution.orbit, settings.parameter);
                std::vector<double> row(next.unknowns(), 0.0), onward(next.unknowns());
                const double rise = solution.orbit.parameters[settings.parameter.place()] -
                                    orbit.parameters[settings.parameter.place()];
                row[next.parameter_place()] = 1;
                if (!next.evaluate(next.unknowns_of(solution.orbit)) ||
                    !next.solve(row, rise < 0 ? -1 : 1, true, onward, nullptr))
                    continue;
                return {solution.orbit, next.direction_of(onward), 0, "with events in another order"};
            }
    }
    throw InputError(fmt::format("no orbit was found beyond: {}", why), "the branch may end here");
}

} // namespace graze
