#include "orbit/solve_equilibrium.hpp"

#include "base/concatenated.hpp"
#include "base/decompositions.hpp"
#include "base/linear_systems.hpp"
#include "base/special_numbers.hpp"
#include "flow/cyclic.hpp"
#include "orbit/eigen_index.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>

namespace graze {

namespace {

constexpr double smallest_size = 1e-250;    ///< below which ratios leave the range of numbers
constexpr double round_off_of_rank = 1e-13; ///< relative size of pivots that are zero

/// Newton's method for the equations of an equilibrium.
class EquilibriumNewton {
public:
    EquilibriumNewton(const EquilibriumEquations& equations, const OrbitOptions& options, OrbitSolution& solution)
        : equations_(&equations), options_(&options), solution_(&solution), parameters_(&solution.orbit.parameters) {
        scales_ = scales_of_equilibrium(equations, state(), *parameters_, {});
    }

    OrbitOutcome solve() {
        if (equations_->size() == 0)
            return OrbitOutcome::converged;
        double before = infinity;
        for (solution_->iterations = 1; solution_->iterations <= options_->iterations; ++solution_->iterations) {
            // A state may be far from its size at the equilibrium: corrections are small in the scales of the last one.
            scales_ = scales_of_equilibrium(*equations_, state(), *parameters_, {});
            const Eigen::VectorXd rates = scaled(equations_->rates(state(), *parameters_));
            const Eigen::MatrixXd field = matrix();
            if (!rates.allFinite() || !field.allFinite()) {
                solution_->detail = "the model is not defined there";
                return OrbitOutcome::undefined;
            }
            // Rows and columns of length 1: pivots then tell the rank, whatever the scales.
            const Eigen::VectorXd rows = lengths(field.rowwise().norm());
            Eigen::MatrixXd even = rows.cwiseInverse().asDiagonal() * field;
            const Eigen::VectorXd columns = lengths(even.colwise().norm());
            even = even * columns.cwiseInverse().asDiagonal();
            const PivotedQR factors(even, round_off_of_rank);
            rank_ = factors.rank();
            const auto correction = [&](const Eigen::VectorXd& right) {
                const Eigen::VectorXd divided = right.cwiseQuotient(rows);
                const Eigen::VectorXd result = rank_ == right.size()
                                                   ? factors.solve(divided)
                                                   : shortest_solution(even, divided, round_off_of_rank);
                return Eigen::VectorXd(result.cwiseQuotient(columns));
            };
            const Eigen::VectorXd step = -correction(rates);
            const double size = step.cwiseAbs().maxCoeff();
            solution_->residual = size;
            if (size == 0 || (before <= options_->accuracy && size >= 0.5 * before))
                return OrbitOutcome::converged; // corrections that do not shrink are round-off
            if (!(size <= options_->accuracy) && !damped(step, size, correction))
                return OrbitOutcome::not_converged;
            if (size <= options_->accuracy)
                move(state(), step);
            before = size;
        }
        return before <= options_->accuracy ? OrbitOutcome::converged : OrbitOutcome::not_converged;
    }

    Eigen::Index deficiency() const { return equations_->size() - rank_; }

    /// Returns the error of the states by round-off of the rates, relative to their scales.
    double error() const {
        const Eigen::VectorXd noise = scaled(equations_->round_off(state(), *parameters_));
        if (noise.size() == 0)
            return 0;
        const FullLU<double> factors(matrix());
        const Eigen::MatrixXd unit = Eigen::MatrixXd::Identity(noise.size(), noise.size());
        double largest = 0;
        for (Eigen::Index k = 0; k < noise.size(); ++k)
            largest = std::max(largest, (factors.solve(unit.col(k)).cwiseAbs() * noise[k]).maxCoeff());
        return largest + epsilon;
    }

private:
    std::vector<double>& state() const { return solution_->orbit.starts[0]; }
    static Eigen::VectorXd lengths(const Eigen::VectorXd& norms) {
        return norms.unaryExpr([](double one) { return one > 0 ? one : 1; });
    }
    Eigen::VectorXd scaled(const Eigen::VectorXd& rates) const { return rates.cwiseQuotient(scales_); }
    Eigen::MatrixXd matrix() const {
        return scales_.cwiseInverse().asDiagonal() *
               equations_->jacobian(state(), *parameters_).leftCols(equations_->size()) * scales_.asDiagonal();
    }
    void move(std::vector<double>& state, const Eigen::VectorXd& step) const {
        for (Eigen::Index k = 0; k < step.size(); ++k)
            state[equations_->active()[static_cast<std::size_t>(k)]] += step[k] * scales_[k];
    }
    /// Takes a step, halved until the correction that would follow with the same derivatives is shorter.
    template <class Correction>
    bool damped(const Eigen::VectorXd& step, double size, const Correction& correction) const {
        constexpr double smallest = 1e-6, near = 1e-6;
        for (double factor = 1; factor > smallest; factor *= 0.5) {
            std::vector<double> tried = state();
            move(tried, factor * step);
            const Eigen::VectorXd rates = scaled(equations_->rates(tried, *parameters_));
            if (!rates.allFinite())
                continue;
            if (size < near || correction(rates).cwiseAbs().maxCoeff() <= (1 - 0.25 * factor) * size) {
                state() = std::move(tried);
                return true;
            }
        }
        return false;
    }

    const EquilibriumEquations* equations_;
    const OrbitOptions* options_;
    OrbitSolution* solution_;
    const std::vector<double>* parameters_;
    Eigen::VectorXd scales_;
    Eigen::Index rank_ = 0;
};

} // namespace

Orbit orbit_of_rest(std::size_t mode, std::vector<double> state, std::vector<double> parameters) {
    return {signature_of_rest(mode), std::move(parameters), {std::move(state)}, {0.0}, std::nullopt};
}

namespace {

/// Returns the scale of a state by how it moves those with known scales within a time. @return infinity if it moves
/// none
double scale_by_effect(std::size_t i, const Eigen::MatrixXd& field, const Eigen::VectorXd& scales,
                       const std::vector<bool>& known, double fastest) {
    double scale = infinity;
    for (std::size_t j = 0; j < known.size(); ++j)
        if (const double acts = std::abs(field(index(j), index(i))); j != i && known[j] && acts > 0)
            scale = std::min(scale, scales[index(j)] * fastest / acts);
    return scale;
}

/// Returns the linearised field beside a state: at the state itself, such as a fold, an effect of one state on another
/// may vanish that tells their scales.
Eigen::MatrixXd typical_field(const EquilibriumEquations& equations, std::span<const double> state,
                              std::span<const double> parameters, const Eigen::VectorXd& scales,
                              const std::vector<bool>& known) {
    constexpr double aside = 0.06;
    std::vector<double> beside(state.begin(), state.end());
    for (std::size_t k = 0; k < known.size(); ++k)
        if (known[k])
            beside[equations.active()[k]] += aside * std::cos(static_cast<double>(k + 1)) * scales[index(k)];
    const Eigen::MatrixXd field = equations.jacobian(beside, parameters).leftCols(equations.size());
    return field.allFinite() ? field
                             : Eigen::MatrixXd(equations.jacobian(state, parameters).leftCols(equations.size()));
}

/// Completes the scales of states that have none, such as the velocity of a body at rest: each moves a state with a
/// scale by that scale within the time of the fastest eigenvalue, or is moved so. @param known whether a state has a
/// scale
void complete_scales(const Eigen::MatrixXd& field, Eigen::VectorXd& scales, std::vector<bool>& known) {
    double fastest = 0;
    if (const auto values = field.allFinite() ? eigenvalues(field) : std::nullopt)
        fastest = values->cwiseAbs().maxCoeff();
    // A state that is only round-off of zero has no scale either.
    constexpr double round_off = 1e-10;
    const std::vector<bool> sized = known;
    for (std::size_t i = 0; i < known.size(); ++i) {
        const double effect = known[i] ? scale_by_effect(i, field, scales, sized, fastest) : infinity;
        known[i] = known[i] && !(std::isfinite(effect) && scales[index(i)] < round_off * effect);
    }
    if (std::ranges::none_of(known, std::identity()))
        known[0] = true; // only ratios of scales matter
    for (bool found = true; found && fastest > 0;) {
        found = false;
        for (std::size_t i = 0; i < known.size(); ++i) {
            if (known[i])
                continue;
            const double acts = scale_by_effect(i, field, scales, known, fastest);
            double is_moved = 0;
            for (std::size_t j = 0; j < known.size(); ++j)
                if (known[j])
                    is_moved = std::max(is_moved, std::abs(field(index(i), index(j))) * scales[index(j)] / fastest);
            const double scale = std::isfinite(acts) ? acts : is_moved;
            if (!(scale > 0) || !std::isfinite(scale))
                continue;
            scales[index(i)] = scale;
            known[i] = found = true;
        }
    }
}

} // namespace

Eigen::VectorXd scales_of_equilibrium(const EquilibriumEquations& equations, std::span<const double> state,
                                      std::span<const double> parameters, std::span<const double> hints) {
    const std::vector<double> periods = equations.system().periods()(parameters);
    Eigen::VectorXd scales(equations.size());
    std::vector<bool> known(equations.active().size());
    for (std::size_t k = 0; k < known.size(); ++k) {
        const std::size_t i = equations.active()[k];
        const double hint = hints.empty() ? 0 : std::abs(hints[i]);
        const double size = periods[i] > 0 ? periods[i] : std::max(std::abs(state[i]), hint);
        known[k] = size > smallest_size && std::isfinite(size);
        scales[index(k)] = known[k] ? size : 1;
    }
    if (!known.empty())
        complete_scales(typical_field(equations, state, parameters, scales, known), scales, known);
    return scales;
}

double neutral_growth(std::span<const std::complex<double>> eigenvalues) {
    constexpr double relative = 1e-10;
    double largest = 0;
    for (const auto one : eigenvalues)
        largest = std::max(largest, std::abs(one));
    return relative * largest;
}

std::vector<std::complex<double>> eigenvalues_at(const EquilibriumEquations& equations, std::span<const double> state,
                                                 std::span<const double> parameters) {
    const Eigen::VectorXd scales = scales_of_equilibrium(equations, state, parameters, {});
    return sorted_eigenvalues(equations, scales.cwiseInverse().asDiagonal() *
                                             equations.jacobian(state, parameters).leftCols(equations.size()) *
                                             scales.asDiagonal());
}

std::vector<std::complex<double>> sorted_eigenvalues(const EquilibriumEquations& equations,
                                                     const Eigen::MatrixXd& field) {
    const auto found = field.allFinite() && field.size() > 0 ? eigenvalues(field) : std::nullopt;
    std::vector<std::complex<double>> sorted;
    if (found)
        sorted.assign(found->begin(), found->end());
    for (const double added : equations.added_eigenvalues()) {
        const auto distance = [added](std::complex<double> one) { return std::abs(one - added); };
        const auto nearest = std::ranges::min_element(sorted, {}, distance);
        if (nearest != sorted.end())
            sorted.erase(nearest);
    }
    std::ranges::stable_sort(sorted, [](const auto& a, const auto& b) {
        return a.real() != b.real() ? a.real() > b.real() : a.imag() > b.imag();
    });
    return sorted;
}

double event_round_off(const Function& function, std::span<const double> inputs, std::span<const double> values,
                       std::size_t states) {
    std::vector<double> bounds(function.outputs()), work(2 * function.workspace());
    const std::vector<double> exact(inputs.size(), 0.0);
    function.error_bounds(inputs, exact, bounds, work);
    // The function may be as uncertain as the states on which it depends.
    double size = 0;
    for (std::size_t i = 0; i < states; ++i)
        size += std::abs(values[1 + i] * inputs[i]);
    return std::max(smallest_clearance * size, 4 * bounds[0]);
}

Certificate certify_equilibrium(const EquilibriumEquations& equations, const Orbit& orbit) {
    const Model& model = equations.system().model();
    const std::vector<double> inputs = concatenated(orbit.starts[0], orbit.parameters);
    Certificate certificate;
    certificate.approach_speeds = {0.0};
    certificate.departures = {0.0};
    certificate.guard_margins = {infinity};
    for (const std::size_t event : model.modes[equations.mode()].watched) {
        const Function& function = equations.system().event(event);
        const std::vector<double> values = function(inputs);
        certificate.end_values.push_back({0, event, values[0], 0});
        if (model.events[event].kind != EventKind::barrier || !certificate.admissible)
            continue;
        if (values[0] < -event_round_off(function, inputs, values, orbit.starts[0].size())) {
            certificate.admissible = false;
            certificate.reason = fmt::format("the equilibrium lies beyond '{}'", model.events[event].name);
        }
    }
    return certificate;
}

std::string disturbed_by_clock(const EquilibriumEquations& equations, std::span<const double> state,
                               std::span<const double> parameters) {
    constexpr int phases = 16;
    constexpr double round_off = 1e-10;
    const Model& model = equations.system().model();
    if (equations.clocks().empty() || equations.size() == 0)
        return "";
    const std::vector<double> periods = equations.system().periods()(parameters);
    const Eigen::VectorXd scales = scales_of_equilibrium(equations, state, parameters, {});
    const auto field = [&](std::span<const double> at) {
        return Eigen::MatrixXd(scales.cwiseInverse().asDiagonal() *
                               equations.jacobian(at, parameters).leftCols(equations.size()) * scales.asDiagonal());
    };
    const Eigen::MatrixXd here = field(state);
    const FullLU<double> factors(here);
    std::vector<double> at(state.begin(), state.end());
    for (const std::size_t clock : equations.clocks()) {
        for (int k = 1; k <= phases; ++k) {
            // Multiples of the golden ratio: no symmetry of the model can hide a dependence.
            at[clock] = within_period(state[clock] + 0.6180339887498949 * k * periods[clock], periods[clock]);
            const Eigen::VectorXd rates = equations.rates(at, parameters).cwiseQuotient(scales);
            const bool moved = !(factors.solve(rates).cwiseAbs().maxCoeff() <= round_off);
            const bool changed = !((field(at) - here).cwiseAbs().maxCoeff() <= round_off * here.cwiseAbs().maxCoeff());
            if (moved || changed)
                return fmt::format("the clock '{}' acts on mode '{}': a motion at rest is an orbit of its period",
                                   model.states[clock].name, model.modes[equations.mode()].name);
        }
        at[clock] = state[clock];
    }
    return "";
}

OrbitSolution solve_equilibrium(const System& system, const Orbit& candidate, const OrbitOptions& options) {
    const EquilibriumEquations equations(system, candidate.signature.front().mode, {});
    OrbitSolution solution;
    solution.orbit = candidate;
    solution.orbit.durations = {0.0};
    solution.detail = equations.why_none(candidate.parameters);
    if (!solution.detail.empty()) {
        solution.outcome = OrbitOutcome::undefined;
        return solution;
    }
    EquilibriumNewton newton(equations, options, solution);
    solution.outcome = newton.solve();
    std::vector<double>& state = solution.orbit.starts[0];
    if (solution.outcome != OrbitOutcome::converged)
        return solution;
    solution.detail = disturbed_by_clock(equations, state, candidate.parameters);
    if (!solution.detail.empty()) {
        solution.outcome = OrbitOutcome::undefined;
        return solution;
    }
    if (newton.deficiency() > 0)
        solution.detail = "an eigenvalue is 0: it is one of a family of equilibria, or a fold or branch point";
    else if (equations.size() == 0)
        solution.detail = "nothing moves in this mode: each state is an equilibrium";
    else if (options.error_estimate)
        solution.error = newton.error();
    const std::vector<double> periods = system.periods()(candidate.parameters);
    for (std::size_t i = 0; i < state.size(); ++i)
        state[i] = within_period(state[i], periods[i]);
    solution.eigenvalues = eigenvalues_at(equations, state, candidate.parameters);
    solution.certificate = certify_equilibrium(equations, solution.orbit);
    return solution;
}

} // namespace graze
