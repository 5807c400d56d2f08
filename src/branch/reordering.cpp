#include "branch/reordering.hpp"

#include "branch/inserted_contact.hpp"
#include "branch/orbit_problem.hpp"
#include "graze/base/input_error.hpp"
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

/// Which rounds of the model's motion are taken for an orbit.
struct Rounds {
    int before; ///< rounds that pass first: beyond a guard the first one still begins in the mode of the old orbit
    int taken;  ///< rounds of the old orbit that make one of the new: at a border an orbit may give way to one of twice
                ///< its period
};
constexpr Rounds next_round{0, 1};
constexpr Rounds all_rounds[] = {next_round, {1, 1}, {2, 1}, {1, 2}, {2, 2}};

/// What the model does for some rounds from the middle of an orbit's longest segment, as an orbit.
std::optional<Orbit> followed(const Simulation& simulation, const Orbit& orbit, const Rounds& rounds,
                              std::string& why) {
    const double round = orbit.return_time() * rounds.taken;
    const auto longest = static_cast<std::size_t>(std::max_element(orbit.durations.begin(), orbit.durations.end()) -
                                                  orbit.durations.begin());
    std::vector<double> state = orbit.starts[longest];
    std::size_t mode = orbit.signature[longest].mode;
    ModeFlow flow = flow_of(simulation);
    flow.set_parameters(orbit.parameters);
    if (flow.run(mode, state, 0.5 * orbit.durations[longest]) != ModeFlow::Ending::done) {
        why = "the orbit cannot be followed";
        return std::nullopt;
    }
    if (rounds.before > 0) {
        const FollowedMotion before =
            follow_motion(simulation, orbit.parameters, state, mode, orbit.return_time() * rounds.before);
        why = before.problem;
        if (!why.empty())
            return std::nullopt;
        state = before.final_state;
        mode = before.final_mode;
    }
    const FollowedMotion motion = follow_motion(simulation, orbit.parameters, state, mode, round);
    why = motion.problem;
    if (!why.empty())
        return std::nullopt;
    Orbit like = orbit;
    if (rounds.taken > 1)
        like.symmetry.reset(); // two halves are the whole
    return motion.segments.empty()
               ? close_at_section(simulation.system(), orbit.parameters, state, mode, round, "", like.symmetry)
               : std::optional(begun_after_first_contact(simulation.system(), like, motion, round));
}

/// Whether an orbit has the segments of another, once or several times, wherever it begins: then it is on the branch of
/// the other.
bool are_alike(const Orbit& one, const Orbit& other) {
    const std::size_t count = other.signature.size();
    Signature signature = other.signature;
    for (std::size_t k = 0; k < count; ++k) {
        bool same = one.signature.size() % count == 0;
        for (std::size_t s = 0; same && s < one.signature.size(); ++s)
            same = one.signature[s] == signature[s % count];
        if (same)
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
    auto candidate = followed(simulation, problem.equations().orbit_of(there), next_round, why);
    return candidate && !are_alike(*candidate, orbit) ? candidate : std::nullopt;
}

namespace {

/// A candidate that the model follows, or why it is none.
std::optional<Orbit> admissible_from(const Simulation& simulation, const Orbit& guess, const OrbitOptions& options,
                                     std::string& why) {
    OrbitSolution solution;
    try {
        solution = solve_orbit(simulation.system(), guess, options);
    } catch (const InputError& error) { // the motion does not close to a signature of the model
        why = error.problem();
        return std::nullopt;
    }
    if (solution.outcome != OrbitOutcome::converged)
        why = solution.detail;
    else if (is_admissible(simulation, solution.orbit, why))
        return solution.orbit;
    return std::nullopt;
}

/// The orbit that a guess beyond a point leads to, with the branch's direction away from the point. At a nonsmooth fold
/// both orbits are on the side that the branch comes from.
std::optional<BranchStart> start_from(const Simulation& simulation, const Orbit& guess, const BranchSettings& settings,
                                      double parameter_there, std::string& why) {
    OrbitOptions options = settings.orbit;
    options.error_estimate = false;
    const std::size_t place = settings.parameter.place();
    auto orbit = admissible_from(simulation, guess, options, why);
    if (!orbit) {
        Orbit mirrored = guess;
        mirrored.parameters[place] = 2 * parameter_there - guess.parameters[place];
        std::string of_mirrored;
        orbit = admissible_from(simulation, mirrored, options, of_mirrored);
    }
    if (!orbit)
        return std::nullopt;
    OrbitProblem problem(simulation, *orbit, settings.parameter);
    std::vector<double> row(problem.unknowns(), 0.0), onward(problem.unknowns());
    row[problem.parameter_place()] = 1;
    const bool falls = orbit->parameters[place] < parameter_there;
    if (!problem.evaluate(problem.unknowns_of(*orbit)) || !problem.solve(row, falls ? -1 : 1, true, onward, nullptr))
        return std::nullopt;
    return BranchStart{*orbit, problem.direction_of(onward), 0, "with events in another order"};
}

} // namespace

BranchStart with_events_reordered(const System& system, const SpecialPoint& point, const BranchSettings& settings) {
    const Simulation simulation(system, {}, {}, integration(settings.orbit.tolerance));
    const Orbit& orbit = point.solution.orbit;
    std::string why = "the branch's direction is not known";
    OrbitProblem problem(simulation, orbit, settings.parameter);
    const std::vector<double> u = problem.unknowns_of(orbit);
    if (!point.tangent.is_empty() && problem.evaluate(u)) {
        const std::vector<double> tangent = problem.unknowns_of(point.tangent);
        for (const Rounds& rounds : all_rounds)
            for (const double distance : distances)
                for (const double side : {1.0, -1.0}) {
                    const Eigen::VectorXd there =
                        OrbitProblem::vector_of(u) + side * distance * OrbitProblem::vector_of(tangent);
                    const Orbit beyond = problem.equations().orbit_of(there);
                    const auto candidate = followed(simulation, beyond, rounds, why);
                    if (!candidate || are_alike(*candidate, orbit))
                        continue;
                    if (auto start = start_from(simulation, *candidate, settings,
                                                orbit.parameters[settings.parameter.place()], why))
                        return *start;
                }
    }
    throw InputError(fmt::format("no orbit was found beyond: {}", why), "the branch may end here");
}

} // namespace graze
