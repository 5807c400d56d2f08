#include "branch/reordering.hpp"

#include "branch/orbit_problem.hpp"
#include "graze/symbolic/input_error.hpp"
#include "orbit/certify.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>

namespace graze {

namespace {

/// How far beyond the point the model's motion is looked at, in units of the scales.
constexpr double distances[] = {1e-4, 1e-5, 1e-3, 1e-6};
/// Share of a round at whose end the first event comes again.
constexpr double before_end = 1e-7;

SimulationOptions integration(const OrbitOptions& options) {
    SimulationOptions result;
    result.tolerance = options.tolerance;
    return result;
}

/// The segment whose start, just after an event, is farthest in time from the place where the order changes.
std::optional<std::size_t> quiet_start(const Orbit& orbit, std::size_t segment) {
    const std::size_t count = orbit.segments();
    const double round = std::accumulate(orbit.durations.begin(), orbit.durations.end(), 0.0);
    double at = 0, change = 0, best = -1;
    for (std::size_t k = 0; k <= segment; ++k)
        change += orbit.durations[k];
    std::optional<std::size_t> result;
    for (std::size_t k = 0; k < count; ++k) {
        const double apart = std::abs(at - change), distance = std::min(apart, round - apart);
        const Segment& before = orbit.signature[(k + count - 1) % count];
        if (before.end == SegmentEnd::event && distance > best && (k > 0 || !orbit.symmetry)) {
            best = distance;
            result = k;
        }
        at += orbit.durations[k];
    }
    if (!result && orbit.symmetry && orbit.signature.back().end == SegmentEnd::event)
        result = 0;
    return best > 1e-6 * round || count == 1 || result == std::optional<std::size_t>(0) ? result : std::nullopt;
}

/// What the model does for one round from the start of a segment of an orbit.
std::optional<Orbit> followed(const Simulation& simulation, const Orbit& orbit, std::size_t first, std::string& why) {
    const double round = std::accumulate(orbit.durations.begin(), orbit.durations.end(), 0.0);
    const FollowedMotion motion = follow_motion(simulation, orbit.parameters, orbit.starts[first],
                                                orbit.signature[first].mode, (1 - before_end) * round);
    if (!motion.problem.empty()) {
        why = motion.problem;
        return std::nullopt;
    }
    Orbit result;
    result.parameters = orbit.parameters;
    result.symmetry = orbit.symmetry;
    result.signature = motion.segments;
    result.starts = motion.starts;
    result.durations = motion.durations;
    result.durations.push_back(round - std::accumulate(motion.durations.begin(), motion.durations.end(), 0.0));
    const Model& model = simulation.model();
    Segment last = orbit.signature[(first + orbit.segments() - 1) % orbit.segments()];
    if (orbit.symmetry && first > 0)
        last = image_of(model, *orbit.symmetry, last, orbit);
    result.signature.push_back(last);
    return result;
}

bool is_sound(const Simulation& simulation, const Orbit& orbit, std::string& why) {
    Shooting shooting(simulation, orbit, {});
    const Eigen::VectorXd unknowns = shooting.unknowns_of(orbit);
    if (!shooting.evaluate(unknowns))
        return false;
    const Certificate certificate = certify(shooting, unknowns);
    why = certificate.reason;
    return certificate.admissible &&
           std::all_of(orbit.durations.begin(), orbit.durations.end(), [](double duration) { return duration > 0; });
}

} // namespace

BranchStart with_events_reordered(const Model& model, const SpecialPoint& point, const BranchSettings& settings) {
    const Simulation simulation(model, {}, {}, integration(settings.orbit));
    const Orbit& orbit = point.solution.orbit;
    std::string why = "nothing is far enough from where it changes";
    OrbitProblem problem(simulation, orbit, settings.parameter);
    const Eigen::VectorXd unknowns = problem.shooting().unknowns_of(orbit);
    const auto first = quiet_start(orbit, point.segment);
    if (first && point.tangent.size() == problem.unknowns())
        for (const double distance : distances)
            for (const double side : {1.0, -1.0}) {
                const Eigen::VectorXd there = unknowns + side * distance * OrbitProblem::vector_of(point.tangent);
                Orbit beyond = problem.shooting().orbit_of(there);
                const auto candidate = followed(simulation, beyond, *first, why);
                if (!candidate)
                    continue;
                OrbitOptions options = settings.orbit;
                options.error_estimate = false;
                OrbitSolution solution;
                try {
                    solution = solve_orbit(model, *candidate, options);
                } catch (const InputError& error) { // the motion does not close to a signature of the model
                    why = error.problem();
                    continue;
                }
                if (solution.outcome != OrbitOutcome::converged) {
                    why = solution.detail;
                    continue;
                }
                if (!is_sound(simulation, solution.orbit, why))
                    continue;
                OrbitProblem next(simulation, solution.orbit, settings.parameter);
                std::vector<double> row(next.unknowns(), 0.0), direction(next.unknowns());
                const double rise =
                    solution.orbit.parameters[settings.parameter] - orbit.parameters[settings.parameter];
                row[next.parameter_place()] = 1;
                const Eigen::VectorXd start = next.shooting().unknowns_of(solution.orbit);
                if (!next.shooting().evaluate(start) || !next.solve(row, rise < 0 ? -1 : 1, true, direction, nullptr))
                    continue;
                return {solution.orbit, direction, 0, "with events in another order"};
            }
    throw InputError(fmt::format("no orbit was found beyond: {}", why), "the branch may end here");
}

} // namespace graze
