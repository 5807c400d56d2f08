#include "branch/cycle_at_hopf.hpp"

#include "branch/equilibrium_normal_form.hpp"
#include "branch/equilibrium_tests.hpp"
#include "graze/base/input_error.hpp"
#include "orbit/eigen_index.hpp"
#include "orbit/solve_equilibrium.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace graze {

namespace {

/// A cycle near a Hopf point, to second order in its amplitude, with its derivative by the amplitude.
struct SmallCycle {
    Orbit orbit;
    OrbitDirection direction;
};

SmallCycle small_cycle(const EquilibriumProblem& problem, const EquilibriumEvaluation& at, const HopfForm& form,
                       double amplitude) {
    const Eigen::Index n = at.size();
    // z' = (i w + r dp) z + c z |z|^2 has the cycle |z| = amplitude, turning at w + Im(r dp + c amplitude^2).
    const double squared = amplitude * amplitude,
                 change = -squared * form.coefficient.real() / form.eigenvalue_rate.real(),
                 turning = form.frequency + (form.eigenvalue_rate * change + form.coefficient * squared).imag();
    const Eigen::VectorXd first = 2 * form.vector.real(), second = form.mean + 2 * 0.5 * form.second.real();
    const Eigen::VectorXd state = amplitude * first + squared * second + change * form.state_rate;
    std::vector<double> u = problem.unknowns_of(orbit_of_rest(problem.equations().mode(), at.state, at.parameters));
    std::vector<double> rate(u.size(), 0.0);
    for (Eigen::Index k = 0; k < n; ++k) {
        u[static_cast<std::size_t>(k)] += state[k] * at.scales[k];
        rate[static_cast<std::size_t>(k)] = first[k] * at.scales[k];
    }
    u[problem.parameter_place()] += change * at.scales[n];
    rate[problem.parameter_place()] = 2 * change / amplitude * at.scales[n];
    SmallCycle cycle{problem.orbit_of(u), problem.direction_of(rate)};
    cycle.orbit.signature = {{problem.equations().mode(), SegmentEnd::cut, 0}};
    cycle.orbit.durations = {2 * std::numbers::pi / turning};
    return cycle;
}

/// How far a cycle reaches from the equilibrium, relative to the amplitude of its guess.
bool is_like(const OrbitSolution& solution, const Orbit& guess, const EquilibriumProblem& problem,
             const EquilibriumEvaluation& at) {
    constexpr double same = 0.5;
    double distance = 0, from_guess = 0;
    for (std::size_t k = 0; k < problem.equations().active().size(); ++k) {
        const std::size_t i = problem.equations().active()[k];
        const double scale = at.scales[index(k)];
        distance = std::max(distance, std::abs(guess.starts[0][i] - at.state[i]) / scale);
        from_guess = std::max(from_guess, std::abs(solution.orbit.starts[0][i] - guess.starts[0][i]) / scale);
    }
    return from_guess < same * distance && std::abs(solution.orbit.period() - guess.period()) < 0.1 * guess.period();
}

[[noreturn]] void refuse(const std::string& why, const std::string& remedy) {
    throw InputError(fmt::format("no cycle was found at the Hopf point: {}", why), remedy);
}

std::vector<BranchStart> equilibria_from(const System& system, const SpecialPoint& point) {
    std::vector<BranchStart> starts;
    const Orbit rest = hopf_of_equilibrium(system, point).solution.orbit;
    OrbitDirection direction;
    direction.starts = {std::vector<double>(rest.starts[0].size(), 0.0)};
    direction.durations = {0.0};
    for (const double sign : {1.0, -1.0}) {
        direction.parameters = {sign};
        starts.push_back({rest, direction, 0, sign > 0 ? "equilibrium, up" : "equilibrium, down"});
    }
    return starts;
}

} // namespace

SpecialPoint hopf_of_equilibrium(const System& system, const SpecialPoint& point) {
    const Orbit& orbit = point.solution.orbit;
    if (point.type != PointType::hopf || is_rest(orbit.signature))
        return point;
    SpecialPoint result = point;
    result.solution =
        solve_orbit(system, orbit_of_rest(orbit.signature.front().mode, orbit.starts.front(), orbit.parameters));
    const std::string remedy = "start from a point HB of a branch of equilibria";
    if (result.solution.outcome != OrbitOutcome::converged)
        throw InputError("the equilibrium to which the cycles shrink was not found: " + result.solution.detail, remedy);
    constexpr double near = 1e-3; // of the states' sizes: located points are far more accurate
    const std::vector<double>& state = result.solution.orbit.starts.front();
    const std::vector<double> usual = system.initial()(orbit.parameters);
    double off = 0, size = 0;
    for (std::size_t i = 0; i < state.size(); ++i)
        if (!system.model().states[i].period) {
            off = std::max(off, std::abs(state[i] - orbit.starts.front()[i]));
            size = std::max({size, std::abs(state[i]), std::abs(usual[i])});
        }
    if (size > 0 && !(off <= near * size))
        throw InputError("the orbit has not shrunk to an equilibrium", remedy);
    result.tangent = {};
    return result;
}

std::vector<BranchStart> leave_hopf(const System& system, const SpecialPoint& point, const BranchSettings& settings) {
    if (!is_rest(point.solution.orbit.signature))
        return equilibria_from(system, point);
    BranchSettings plain = settings;
    plain.monitors.clear();
    plain.free.clear();
    plain.free_bounds.clear();
    const EquilibriumPath path(system, point.solution.orbit, plain);
    const EquilibriumProblem& problem = *path.problem();
    EquilibriumEvaluation at;
    problem.describe(problem.unknowns_of(point.solution.orbit), at);
    const auto form = path.form_at(at, product_of_nearest_pair(point.solution.eigenvalues));
    if (!form)
        refuse("its eigenvalues are not imaginary", "start from a point HB of a branch of equilibria");
    if (!(std::abs(form->eigenvalue_rate.real()) > 1e-10 * at.field.norm()))
        refuse("the eigenvalues do not cross the axis along this parameter", "vary another parameter");
    if (!(std::abs(form->lyapunov) > form->uncertainty))
        refuse("its first Lyapunov coefficient is 0: cycles are neutral or need a higher order",
               "vary another parameter, or start from a motion beside the point");
    // An amplitude at which the third order is small against the first, and the parameter changes little.
    const double by_cubic = std::sqrt(form->frequency / std::abs(form->coefficient)),
                 by_parameter = std::sqrt(std::abs(form->eigenvalue_rate.real() / form->coefficient.real()));
    double amplitude = 0.05 * std::min(by_cubic, by_parameter);
    for (int attempt = 0; attempt < 8; ++attempt, amplitude *= 0.5) {
        const SmallCycle guess = small_cycle(problem, at, *form, amplitude);
        const OrbitSolution solution = solve_orbit(system, guess.orbit, settings.orbit);
        if (solution.outcome != OrbitOutcome::converged || !is_like(solution, guess.orbit, problem, at))
            continue;
        return {{solution.orbit, guess.direction, 0, "cycle"}};
    }
    refuse("Newton's method did not converge to small cycles",
           "start from a motion beside the point, if the cycles are stable");
}

} // namespace graze
