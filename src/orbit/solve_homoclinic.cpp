#include "orbit/solve_homoclinic.hpp"

#include "graze/base/input_error.hpp"
#include "graze/base/require.hpp"
#include "orbit/end_distances.hpp"
#include "orbit/newton.hpp"
#include "orbit/shooting.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace graze {

namespace {

bool are_near(const EndDistances& one, const EndDistances& other, double factor) {
    const auto near = [&](double a, double b) { return a < factor * b && b < factor * a; };
    return near(one.departure, other.departure) && near(one.approach, other.approach);
}

EndDistances distances_of(const HomoclinicEnds& ends) {
    return {ends.departure(), ends.approach()};
}

/// Returns distances on the way to others. The end of the orbit is moved along its motion, which leaves the stable
/// space again: from an end that is off by d^2, the distance can be made smaller by a factor f as long as d^2 f^(-g/s)
/// stays below it.
EndDistances on_the_way(const EndDistances& from, const EndDistances& to, const Saddle& saddle) {
    constexpr double share = 0.2, shortest = 1e-2, always = 0.5;
    const double ratio = saddle.slowest_growth() / saddle.slowest_decay();
    const double least = std::clamp(std::pow(from.approach / share, 1 / (1 + ratio)), shortest, always);
    return {std::max(to.departure, shortest * from.departure), std::max(to.approach, least * from.approach)};
}

class HomoclinicSolver {
public:
    HomoclinicSolver(const System& system, ParameterId parameter, const OrbitOptions& options)
        : simulation_(system, {}, {}, integration(options.tolerance)), parameter_(parameter), options_(options) {}

    HomoclinicSolution solve(const Orbit& candidate) {
        constexpr int most_changes = 30;
        constexpr double larger = 2;
        if (!solve_at_distances(candidate))
            return std::move(result_);
        std::optional<double> coarse; // the parameter at larger distances
        for (int change = 0; change < most_changes; ++change) {
            const EndDistances wanted = wanted_distances(saddle().slowest_growth(), saddle().slowest_decay()),
                               target =
                                   coarse ? wanted : EndDistances{larger * wanted.departure, larger * wanted.approach},
                               next = on_the_way(distances_of(*equations_->homoclinic_ends()), target, saddle());
            const auto orbit = at(next);
            if (!orbit)
                break;
            if (!solve_at_distances(*orbit))
                return std::move(result_);
            if (next.departure != target.departure || next.approach != target.approach)
                continue;
            if (coarse) {
                complete(*coarse);
                return std::move(result_);
            }
            coarse = result_.parameter;
        }
        result_.solution.outcome = OrbitOutcome::not_converged;
        result_.solution.detail = "no distances from the saddle are found at which the orbit is accurate";
        return std::move(result_);
    }

private:
    const Saddle& saddle() const { return equations_->homoclinic_ends()->saddle(); }

    /// Newton's method at the distances of a candidate.
    bool solve_at_distances(const Orbit& candidate) {
        equations_.emplace(simulation_, candidate, std::vector{parameter_});
        at_.emplace(equations_->evaluation());
        Eigen::VectorXd unknowns = equations_->unknowns_of(candidate);
        const Eigen::VectorXd first = unknowns;
        OrbitSolution& solution = result_.solution;
        solution.outcome = OrbitOutcome::undefined;
        solution.orbit = candidate;
        if (equations_->evaluate(unknowns, *at_))
            solution.outcome = iterate(unknowns);
        if (solution.detail.empty())
            solution.detail = at_->problem;
        if (solution.outcome != OrbitOutcome::converged)
            return false;
        solution.orbit = equations_->orbit_of(unknowns);
        result_.parameter = solution.orbit.parameters[parameter_.place()];
        if (result_.saddle.empty())
            result_.moved = (unknowns - first).cwiseQuotient(equations_->scales()).cwiseAbs().maxCoeff();
        result_.saddle = saddle().state();
        return true;
    }

    OrbitOutcome iterate(Eigen::VectorXd& unknowns) {
        constexpr double noise = 1e-8; // corrections below this that do not shrink are round-off
        OrbitEvaluation tried = equations_->evaluation();
        double before = std::numeric_limits<double>::infinity();
        for (std::size_t i = 0; i < options_.iterations; ++i, ++result_.solution.iterations) {
            Eigen::VectorXd step;
            const Eigen::VectorXd lack = Eigen::VectorXd::Constant(1, -at_->departure);
            if (!equations_->solve(*at_, equations_->departure_row(*at_), lack, false, step)) {
                result_.solution.detail = "the parameter does not determine the orbit";
                return OrbitOutcome::singular;
            }
            const double size = step.cwiseQuotient(equations_->scales()).cwiseAbs().maxCoeff();
            if (!damped(unknowns, step, size, tried))
                return OrbitOutcome::not_converged;
            if (size < options_.accuracy || (size < noise && size > 0.5 * before))
                return OrbitOutcome::converged;
            before = size;
        }
        result_.solution.detail = fmt::format("{} iterations were not enough", options_.iterations);
        return OrbitOutcome::not_converged;
    }

    /// Takes a step, halved until the residuals fall.
    bool damped(Eigen::VectorXd& unknowns, const Eigen::VectorXd& step, double size, OrbitEvaluation& tried) {
        constexpr double smallest = 1e-3, near = 1e-6;
        const auto residual = [](const OrbitEvaluation& one) {
            return std::max(one.residual, std::abs(one.departure));
        };
        for (double factor = 1; factor > smallest; factor *= 0.5) {
            if (!equations_->evaluate(unknowns + factor * step, tried) ||
                (size > near && residual(tried) > (1 - 0.1 * factor) * residual(*at_)))
                continue;
            std::swap(*at_, tried);
            unknowns = at_->unknowns;
            return true;
        }
        result_.solution.detail = tried.problem.empty() ? "residuals do not fall" : tried.problem;
        return false;
    }

    /// Returns the orbit that begins and ends at other distances: nearer to the saddle it follows the linearised
    /// motion, farther from it its own.
    std::optional<Orbit> at(const EndDistances& distances) {
        Orbit orbit = result_.solution.orbit;
        Eigen::VectorXd departing = saddle().to_coordinates() * saddle().from_saddle(orbit.starts.front());
        departing.tail(saddle().stable()).setZero();
        const double later = saddle().time_to(distances.departure, departing);
        if (later < 0) {
            orbit.starts.front() = saddle().state_at(saddle().moved(departing, later));
        } else {
            ModeFlow& flow = equations_->flow_at(*at_);
            if (flow.run(orbit.signature.front().mode, orbit.starts.front(), later) != ModeFlow::Ending::done)
                return std::nullopt;
        }
        orbit.durations.front() -= later;
        Eigen::VectorXd approaching = saddle().to_coordinates() * saddle().from_saddle(at_->pieces.back().end);
        approaching.head(saddle().unstable()).setZero();
        orbit.durations.back() += saddle().time_to(distances.approach, approaching);
        return orbit.durations.front() > 0 && orbit.durations.back() > 0 ? std::optional(orbit) : std::nullopt;
    }

    /// @param coarse the parameter at twice the distances
    void complete(double coarse) {
        constexpr double round_off = 1e-12;
        const double scale = equations_->scales()[index(equations_->layout().parameter(0))];
        // A change of the parameter by its scale, or one that has an effect of the size of the orbit.
        const double change = std::max(scale, at_->effects[0] > 0 ? 1 / at_->effects[0] : 0);
        result_.error = std::abs(result_.parameter - coarse) + round_off * change;
        result_.solution.error = result_.error / scale;
        describe_orbit(*equations_, *at_, result_.solution);
    }

    Simulation simulation_;
    ParameterId parameter_;
    OrbitOptions options_;
    std::optional<Shooting> equations_;
    std::optional<OrbitEvaluation> at_;
    HomoclinicSolution result_;
};

} // namespace

bool distances_need_renewal(const HomoclinicEnds& ends) {
    constexpr double far = 4;
    const EndDistances wanted = wanted_distances(ends.saddle().slowest_growth(), ends.saddle().slowest_decay());
    return ends.have_turned() || !are_near(distances_of(ends), wanted, far);
}

HomoclinicSolution solve_homoclinic(const System& system, const Orbit& candidate, ParameterId parameter,
                                    const OrbitOptions& options) {
    options.validate();
    validate_orbit(system.model(), candidate);
    require_index(parameter.place(), candidate.parameters.size(), "independent parameter");
    if (!is_homoclinic(candidate.signature))
        throw InputError("the orbit is not homoclinic", "let its last segment approach a saddle");
    return HomoclinicSolver(system, parameter, options).solve(candidate);
}

} // namespace graze
