#include "graze/orbit/solve.hpp"

#include "base/concatenated.hpp"
#include "base/enumerator_name.hpp"
#include "graze/base/input_error.hpp"
#include "graze/model/conserved.hpp"
#include "orbit/newton.hpp"
#include "orbit/shooting.hpp"
#include "orbit/solve_equilibrium.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace graze {

namespace {

constexpr int most_halvings = 8;
constexpr double no_time = 1e-9; ///< share of the candidate's period below which an orbit has collapsed

double largest(const Eigen::VectorXd& step, const Eigen::VectorXd& scales) {
    return step.cwiseQuotient(scales).cwiseAbs().maxCoeff();
}

/// Magnitudes of multipliers at located folds and flips differ from 1 by less than this.
constexpr double on_circle = 1e-8;

/// Takes a step, halved until the residual decreases. @param tried set to the evaluation there
bool improves(OrbitEquations& equations, const Eigen::VectorXd& unknowns, const Eigen::VectorXd& step,
              const OrbitEvaluation& at, OrbitEvaluation& tried) {
    const double size = largest(step, equations.scales());
    double factor = 1;
    bool improved = false;
    tried.took_too_long = false;
    for (int halving = 0; halving < most_halvings && !improved && !tried.took_too_long; ++halving, factor *= 0.5) {
        const bool possible = equations.evaluate(unknowns + factor * step, tried);
        // Near the solution the residual is round-off, and any value is accepted.
        improved = possible && (tried.residual <= (1 - 0.1 * factor) * at.residual || size < 1e-6);
    }
    return improved;
}

/// Speed at the start, in units of that of the candidate, below which an orbit has become an equilibrium.
constexpr double at_rest = 1e-6;

/// Returns the magnitude of the vector field at an orbit's first start, in scaled states.
double speed(const System& system, const Orbit& orbit, const Eigen::VectorXd& scales) {
    const std::vector<double> rates =
        system.mode(orbit.signature[0].mode).rates(concatenated(orbit.starts[0], orbit.parameters));
    double square = 0;
    for (std::size_t i = 0; i < rates.size(); ++i)
        square += std::pow(rates[i] / scales[index(i)], 2);
    return std::sqrt(square);
}

/// Returns the first segment whose duration is smaller than its change by round-off of the states. At a double root,
/// Newton's method converges slowly to an orbit with a vanishing slip, until the slip is below round-off and the
/// equations appear solved.
/// @return number of segments when there is none
std::size_t segment_below_round_off(const OrbitEquations& equations, const OrbitEvaluation& at, const Orbit& orbit) {
    constexpr double shorter = 1e-2; ///< only segments shorter than this share of the period are checked
    constexpr double round_off = 16 * std::numeric_limits<double>::epsilon();
    const std::size_t none = orbit.segments();
    if (std::ranges::none_of(orbit.durations, [&](double one) { return one < shorter * orbit.period(); }))
        return none;
    const OrbitLayout& layout = equations.layout();
    const std::size_t last = layout.pieces() - 1;
    std::vector<double> deficiency(orbit.segments(), 0.0);
    for (std::size_t i = 0; i < layout.states(); ++i) {
        if (at.periods[i] > 0)
            continue;
        // Perturbs the state to which the orbit returns by its round-off.
        Eigen::VectorXd change = Eigen::VectorXd::Zero(index(layout.start_of(layout.pieces()))), step;
        change[index(layout.start_of(last) + 1 + i)] =
            round_off * std::abs(at.pieces[last].after[i]) / at.scales[index(layout.start_of(0) + i)];
        if (!equations.respond(at, change, step))
            return none;
        for (std::size_t k = 0; k < layout.pieces(); ++k)
            deficiency[layout.segment_of(k)] += std::abs(step[index(layout.duration_of(k))]);
    }
    for (std::size_t s = 0; s < none; ++s)
        if (orbit.durations[s] < shorter * orbit.period() && deficiency[s] >= orbit.durations[s])
            return s;
    return none;
}

} // namespace

SimulationOptions integration(double tolerance) {
    SimulationOptions options;
    options.tolerance = std::max(tolerance, smallest_tolerance);
    return options;
}

void require_accuracy(double accuracy) {
    if (!(accuracy >= 1e-15 && accuracy <= 1e-2))
        throw InputError(fmt::format("the accuracy {} is out of range", accuracy), "choose from 1e-15 to 1e-2");
}

void require_tolerance_in_range(double tolerance) {
    if (!(tolerance >= smallest_tolerance && tolerance <= largest_tolerance))
        throw InputError(fmt::format("the tolerance {} is out of range", tolerance), "give 1e-16 to 1e-2");
}

void OrbitOptions::validate() const {
    if (!(tolerance >= smallest_tolerance && tolerance <= largest_tolerance))
        throw InputError(fmt::format("the tolerance {} is out of range", tolerance),
                         fmt::format("choose from {} to {}", smallest_tolerance, largest_tolerance));
    require_accuracy(accuracy);
    if (iterations == 0)
        throw InputError("no iterations are allowed", "allow at least one");
}

std::string_view name_of(OrbitOutcome outcome) {
    constexpr std::string_view names[] = {"converged", "not converged", "singular", "undefined"};
    return enumerator_name(names, outcome, "");
}

std::size_t number_of_multipliers(const OrbitSolution& solution) {
    return solution.multipliers.size() + solution.other_multipliers;
}

bool is_stable(const OrbitSolution& solution) {
    if (is_rest(solution.orbit.signature))
        return solution.outcome == OrbitOutcome::converged &&
               std::ranges::all_of(solution.eigenvalues, [margin = neutral_growth(solution.eigenvalues)](auto one) {
                   return one.real() < -margin;
               });
    const auto& multipliers = solution.multipliers;
    constexpr double off_circle = 1e-6; // a double multiplier is known only to the root of its uncertainty
    if (solution.neutral > 0)
        return number_of_multipliers(solution) > 0 &&
               std::ranges::all_of(multipliers, [](auto one) { return std::abs(one) < 1 + off_circle; });
    return number_of_multipliers(solution) > 0 &&
           std::ranges::all_of(multipliers, [](auto one) { return std::abs(one) < 1 - on_circle; });
}

std::size_t unstable_directions(const OrbitSolution& solution) {
    const auto growing = std::ranges::count_if(solution.eigenvalues, [margin = neutral_growth(solution.eigenvalues)](
                                                                         auto one) { return one.real() > margin; });
    const auto outside =
        std::ranges::count_if(solution.multipliers, [](auto one) { return std::abs(one) > 1 + on_circle; });
    return static_cast<std::size_t>(growing + outside);
}

OrbitOutcome solve_equations(OrbitEquations& equations, Eigen::VectorXd& unknowns, const OrbitOptions& options,
                             OrbitEvaluation& at, std::size_t& iterations, std::string& detail,
                             std::size_t undetermined) {
    const Eigen::MatrixXd no_borders(0, index(equations.unknowns()));
    const Eigen::VectorXd nothing(0);
    if (!equations.evaluate(unknowns, at)) {
        detail = at.problem;
        return OrbitOutcome::undefined;
    }
    constexpr double far_off = 1e8; // ratio of step to residual that indicates singular equations
    constexpr double round_off = 1e-11;
    const auto singular = [&] {
        detail = "the equations are singular: at a fold, or because states are not determined";
        return OrbitOutcome::singular;
    };
    OrbitEvaluation tried = equations.evaluation();
    const auto damped = [&](const Eigen::VectorXd& step) { return improves(equations, unknowns, step, at, tried); };
    for (iterations = 1; iterations <= options.iterations; ++iterations) {
        Eigen::VectorXd step;
        std::size_t deficiency = undetermined;
        const bool solved = deficiency > 0 ? equations.solve_nearest(at, step, deficiency)
                                           : equations.solve(at, no_borders, nothing, false, step);
        // In a family of orbits take the nearest one: along the family, round-off determines the step.
        if (deficiency == 0 && (!solved || largest(step, equations.scales()) > far_off * at.residual)) {
            Eigen::VectorXd nearest;
            if (equations.solve_nearest(at, nearest, deficiency) && deficiency > 0)
                step = nearest;
            else if (!solved)
                return singular();
        }
        bool improved = damped(step);
        // Near a family the equations are nearly singular and steps along it are too long: try the minimum-norm step.
        if (!improved && deficiency == 0 && tried.problem.empty()) {
            deficiency = 1;
            improved = equations.solve_nearest(at, step, deficiency) && damped(step);
        }
        if (!improved) {
            if (deficiency > 0 && !solved && tried.problem.empty())
                return singular();
            detail =
                tried.problem.empty() ? fmt::format("residuals do not fall below {:.3g}", at.residual) : tried.problem;
            return tried.problem.empty() ? OrbitOutcome::not_converged : OrbitOutcome::undefined;
        }
        std::swap(at, tried);
        unknowns = at.unknowns;
        // A minimum-norm step does not reduce the residual of a dependent equation, so the residual is checked too.
        if (largest(step, equations.scales()) < options.accuracy)
            return deficiency == 0 || at.residual < round_off ? OrbitOutcome::converged : singular();
    }
    detail = fmt::format("{} iterations were not enough; the residual is {:.3g}", options.iterations, at.residual);
    return OrbitOutcome::not_converged;
}

void describe_orbit(OrbitEquations& equations, const OrbitEvaluation& at, OrbitSolution& solution,
                    const std::optional<HeldLimit>& held, Spectrum spectrum) {
    solution.residual = at.residual;
    if (equations.homoclinic_ends()) // there is no section map
        solution.eigenvalues = at.eigenvalues;
    else if (equations.cycle_ends())
        solution.multipliers = equations.cycle_ends()->cycle().multipliers();
    else if (auto leading = spectrum == Spectrum::leading ? leading_multipliers(equations, at) : std::nullopt) {
        solution.multipliers = std::move(leading->values);
        solution.other_multipliers = leading->others;
        solution.others_within = leading->others_within;
    } else {
        solution.multipliers = floquet_multipliers(equations, at);
    }
    if (equations.symmetry()) {
        solution.half_multipliers = solution.multipliers;
        solution.others_within *= solution.others_within;
        for (auto& multiplier : solution.multipliers)
            multiplier *= multiplier;
    }
    solution.certificate = certify(equations, at, held);
}

void mark_neutral(OrbitSolution& solution, std::size_t count) {
    solution.neutral = count;
    for (auto* const multipliers : {&solution.multipliers, &solution.half_multipliers}) {
        std::vector<std::complex<double>*> nearest;
        for (std::complex<double>& one : *multipliers)
            nearest.push_back(&one);
        std::ranges::sort(nearest, {}, [](const auto* one) { return std::abs(*one - 1.0); });
        for (std::size_t i = 0; i < std::min(count, nearest.size()); ++i)
            *nearest[i] = 1;
    }
}

bool is_in_family(OrbitEquations& equations, const OrbitEvaluation& at) {
    // Displacement in units of the scales; share of it that must remain after the corrections.
    constexpr double distance = 1e-2, kept_share = 0.5;
    constexpr double solved = 1e-11;
    constexpr int iterations = 8;
    const Eigen::MatrixXd no_borders(0, index(at.system.unknowns()));
    Eigen::VectorXd direction; // null vector in units of the scales
    if (at.system.undetermined() == 0 || !at.system.null_vector(no_borders, direction))
        return false;
    const double length = direction.cwiseAbs().maxCoeff();
    Eigen::VectorXd unknowns = at.unknowns + distance / length * direction.cwiseProduct(at.scales), step;
    OrbitEvaluation there = equations.evaluation();
    std::size_t deficiency = at.system.undetermined();
    for (int i = 0; i < iterations; ++i) {
        if (!equations.evaluate(unknowns, there))
            return false;
        if (there.residual < solved)
            return there.system.undetermined() > 0 &&
                   largest(unknowns - at.unknowns, at.scales) > kept_share * distance;
        if (!equations.solve_nearest(there, step, deficiency))
            return false;
        unknowns += step;
    }
    return false;
}

void join_drifts(const Simulation& simulation, Orbit& orbit) {
    const auto& states = simulation.model().states;
    if (orbit.segments() < 2 || std::ranges::none_of(states, [](const State& one) { return one.drifting; }))
        return;
    Shooting shooting(simulation, orbit, {});
    OrbitEvaluation at = shooting.evaluation();
    if (!shooting.evaluate(shooting.unknowns_of(orbit), at))
        return;
    // The motion does not depend on drifting states, so all segments are integrated before any start is shifted.
    std::vector<double> shift(states.size(), 0.0);
    for (std::size_t s = 0; s + 1 < orbit.segments(); ++s)
        for (std::size_t i = 0; i < states.size(); ++i) {
            if (!states[i].drifting)
                continue;
            const double end = at.pieces[shooting.layout().last_piece(s)].after[i] + shift[i];
            shift[i] = end - orbit.starts[s + 1][i];
            orbit.starts[s + 1][i] = end;
            for (std::size_t j = 0; j < states.size(); ++j)
                if (states[j].drifts_with == i)
                    orbit.starts[s + 1][j] += shift[i];
        }
}

OrbitSolution solve_orbit(const System& system, const Orbit& candidate, const OrbitOptions& options) {
    const Model& model = system.model();
    options.validate();
    validate_orbit(model, candidate);
    if (is_rest(candidate.signature))
        return solve_equilibrium(system, candidate, options);
    if (is_homoclinic(candidate.signature))
        throw InputError(
            "a homoclinic orbit exists at one value of a parameter only, and cannot be solved for at others",
            "follow it in two parameters: kind = \"curve\"");
    const Simulation simulation(system, {}, {}, integration(options.tolerance));
    Shooting shooting(simulation, candidate, {});
    Eigen::VectorXd unknowns = shooting.unknowns_of(candidate);
    OrbitEvaluation at = shooting.evaluation();
    const Eigen::VectorXd scales = shooting.scales();
    OrbitSolution solution;
    // Where something is conserved the orbit is one of a family, unless a state that contacts only reverse is held.
    const bool is_one_of_many = conserves_something(model, candidate.parameters) && shooting.evaluate(unknowns, at) &&
                                moving_neutral_states(shooting, at) == 0;
    solution.outcome =
        solve_equations(shooting, unknowns, options, at, solution.iterations, solution.detail, is_one_of_many ? 1 : 0);
    solution.orbit = shooting.orbit_of(unknowns);
    solution.residual = at.residual;
    if (solution.outcome == OrbitOutcome::converged && !(solution.orbit.period() > no_time * candidate.period())) {
        solution.outcome = OrbitOutcome::not_converged;
        solution.detail = "Newton's method converged to an orbit of zero duration";
    }
    if (is_one_of_many && solution.outcome == OrbitOutcome::converged &&
        !(speed(system, solution.orbit, scales) > at_rest * speed(system, candidate, scales))) {
        solution.outcome = OrbitOutcome::not_converged;
        solution.detail = "Newton's method converged to an equilibrium, at which the family ends";
    }
    if (solution.outcome != OrbitOutcome::converged)
        return solution;
    describe_orbit(shooting, at, solution);
    const std::size_t spurious_segment = segment_below_round_off(shooting, at, solution.orbit);
    if (spurious_segment < solution.orbit.segments() && solution.certificate.admissible) {
        solution.certificate.admissible = false;
        solution.certificate.reason =
            fmt::format("the duration of segment {} is below round-off", spurious_segment + 1);
    }
    if (moving_neutral_states(shooting, at) > 0 || is_in_family(shooting, at))
        solution.detail = "one of a family of orbits at the same parameters: a multiplier is 1";
    if (options.error_estimate) {
        const Simulation tighter(system, {}, {}, integration(0.01 * options.tolerance));
        Shooting again(tighter, solution.orbit, {});
        Eigen::VectorXd step;
        OrbitEvaluation there = again.evaluation();
        const Eigen::MatrixXd no_borders(0, index(again.unknowns()));
        std::size_t deficiency = 0;
        const bool defined = again.evaluate(again.unknowns_of(solution.orbit), there);
        if (defined && there.system.undetermined() > 0
                ? again.solve_nearest(there, step, deficiency)
                : defined && again.solve(there, no_borders, Eigen::VectorXd(0), false, step))
            solution.error = largest(step, again.scales());
    }
    return solution;
}

} // namespace graze
