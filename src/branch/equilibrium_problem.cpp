#include "branch/equilibrium_problem.hpp"

#include "base/linear_systems.hpp"
#include "flow/cyclic.hpp"
#include "graze/base/input_error.hpp"
#include "orbit/eigen_index.hpp"
#include "orbit/solve_equilibrium.hpp"

#include <algorithm>
#include <cmath>

namespace graze {

namespace {

std::vector<ParameterId> varying(const BranchSettings& settings) {
    std::vector<ParameterId> all{settings.parameter};
    all.insert(all.end(), settings.free.begin(), settings.free.end());
    return all;
}

} // namespace

Eigen::MatrixXd EquilibriumEvaluation::second(const Eigen::VectorXd& direction) const {
    const Eigen::VectorXd sizes = scales.head(size());
    return sizes.cwiseInverse().asDiagonal() *
           equations->second(state, parameters, direction.cwiseProduct(scales.head(direction.size()))) *
           scales.asDiagonal();
}

Eigen::VectorXd EquilibriumEvaluation::gradient_of(std::span<const double> by_inputs) const {
    Eigen::VectorXd gradient(scales.size());
    for (Eigen::Index k = 0; k < size(); ++k)
        gradient[k] = by_inputs[equations->active()[static_cast<std::size_t>(k)]];
    for (std::size_t f = 0; f < equations->free().size(); ++f)
        gradient[size() + index(f)] = by_inputs[state.size() + equations->free()[f].place()];
    return gradient.cwiseProduct(scales);
}

EquilibriumProblem::EquilibriumProblem(const System& system, const Orbit& candidate, const BranchSettings& settings)
    : like_(candidate), equations_(system, candidate.signature.front().mode, varying(settings)) {
    const std::vector<double> nominal = system.model().parameter_values();
    for (const ParameterId parameter : equations_.free()) {
        nominal_.push_back(std::abs(nominal[parameter.place()]));
        double range = 0;
        if (parameter == settings.parameter && settings.least && settings.greatest)
            range = *settings.greatest - *settings.least;
        for (const FreeBounds& bounds : settings.free_bounds)
            if (bounds.parameter == parameter && bounds.least && bounds.greatest)
                range = *bounds.greatest - *bounds.least;
        ranges_.push_back(range);
    }
    largest_.assign(equations_.free().size(), 0.0);
    hints_ = system.initial()(candidate.parameters);
    choose_scales(unknowns_of(candidate));
}

std::vector<double> EquilibriumProblem::unknowns_of(const Orbit& orbit) const {
    std::vector<double> u;
    for (const std::size_t i : equations_.active())
        u.push_back(orbit.starts[0][i]);
    for (const ParameterId parameter : equations_.free())
        u.push_back(orbit.parameters[parameter.place()]);
    return u;
}

std::vector<double> EquilibriumProblem::unknowns_of(const OrbitDirection& direction) const {
    if (direction.starts.size() != 1 || direction.starts[0].size() != like_.starts[0].size() ||
        direction.parameters.size() > equations_.free().size())
        throw InputError("the direction does not fit the equilibrium", "give one of a branch of equilibria");
    std::vector<double> u;
    for (const std::size_t i : equations_.active())
        u.push_back(direction.starts[0][i]);
    u.insert(u.end(), direction.parameters.begin(), direction.parameters.end());
    u.resize(unknowns(), 0.0);
    return u;
}

Orbit EquilibriumProblem::orbit_of(std::span<const double> u) const {
    Orbit orbit = like_;
    const std::size_t n = equations_.active().size();
    for (std::size_t f = 0; f < equations_.free().size(); ++f)
        orbit.parameters[equations_.free()[f].place()] = u[n + f];
    const std::vector<double> periods = equations_.system().periods()(orbit.parameters);
    for (std::size_t k = 0; k < n; ++k) {
        const std::size_t i = equations_.active()[k];
        orbit.starts[0][i] = within_period(u[k], periods[i]);
    }
    return orbit;
}

OrbitDirection EquilibriumProblem::direction_of(std::span<const double> u) const {
    OrbitDirection direction;
    direction.starts = {std::vector<double>(like_.starts[0].size(), 0.0)};
    direction.durations = {0.0};
    const std::size_t n = equations_.active().size();
    for (std::size_t k = 0; k < n; ++k)
        direction.starts[0][equations_.active()[k]] = u[k];
    direction.parameters.assign(u.begin() + static_cast<std::ptrdiff_t>(n), u.end());
    return direction;
}

bool EquilibriumProblem::describe(std::span<const double> u, EquilibriumEvaluation& at) const {
    const Orbit orbit = orbit_of(u);
    const Eigen::Index n = equations_.size();
    at.equations = &equations_;
    at.state = orbit.starts[0];
    at.parameters = orbit.parameters;
    at.scales = scales_;
    const Eigen::VectorXd sizes = scales_.head(n);
    at.rates = equations_.rates(at.state, at.parameters).cwiseQuotient(sizes);
    at.jacobian =
        sizes.cwiseInverse().asDiagonal() * equations_.jacobian(at.state, at.parameters) * scales_.asDiagonal();
    at.field = at.jacobian.leftCols(n);
    return at.rates.allFinite() && at.jacobian.allFinite();
}

bool EquilibriumProblem::evaluate(std::span<const double> u) {
    if (!describe(u, at_))
        return false;
    const Eigen::Index n = equations_.size(), all = scales_.size();
    values_.resize(all - 1);
    matrix_.resize(all - 1, all);
    values_.head(n) = at_.rates;
    matrix_.topRows(n) = at_.jacobian;
    Eigen::VectorXd gradient;
    for (std::size_t k = 0; k < held_.size(); ++k) {
        const Eigen::Index row = n + index(k);
        if (!held_[k]->evaluate(at_, values_[row], gradient))
            return false;
        matrix_.row(row) = gradient.transpose();
    }
    if (row_sizes_.size() == 0)
        measure_rows();
    return values_.allFinite() && matrix_.allFinite();
}

void EquilibriumProblem::measure_rows() {
    constexpr double smallest = 1e-8; // of the longest row: one that nearly vanishes has no length of its own
    row_sizes_ = matrix_.rowwise().norm();
    const double longest = row_sizes_.size() > 0 ? row_sizes_.maxCoeff() : 0;
    for (double& size : row_sizes_)
        size = std::isfinite(size) && longest > 0 ? std::max(size, smallest * longest) : 1;
}

bool EquilibriumProblem::solve(std::span<const double> row, double right, bool homogeneous, std::span<double> step,
                               double* determinant) {
    const Eigen::Index all = scales_.size();
    Eigen::MatrixXd matrix(all, all);
    matrix.topRows(all - 1) = matrix_;
    matrix.row(all - 1) = vector_of(row).cwiseProduct(scales_).transpose();
    // Rates have units of their own: rows of similar length make pivots comparable. The factors do not change within a
    // step, so that the determinant is smooth even where a row vanishes.
    Eigen::VectorXd values = Eigen::VectorXd::Zero(all);
    if (!homogeneous)
        values.head(all - 1) = -values_;
    values[all - 1] = right;
    for (Eigen::Index i = 0; i + 1 < all; ++i) {
        matrix.row(i) /= row_sizes_[i];
        values[i] /= row_sizes_[i];
    }
    const FullLU<double> factors(matrix);
    if (determinant)
        *determinant = factors.determinant();
    if (!factors.is_invertible())
        return false;
    entries_of(step) = factors.solve(values).cwiseProduct(scales_);
    return entries_of(step).allFinite();
}

void EquilibriumProblem::choose_scales(std::span<const double> u) {
    constexpr double smallest = 1e-2;  // of a parameter's nominal value or range
    constexpr double remembered = 0.1; // share of the largest value of a state so far
    const Orbit orbit = orbit_of(u);
    const Eigen::Index n = equations_.size();
    for (const std::size_t i : equations_.active())
        hints_[i] = std::max(std::abs(hints_[i]), remembered * std::abs(orbit.starts[0][i]));
    scales_.resize(equations_.variables());
    scales_.head(n) = scales_of_equilibrium(equations_, orbit.starts[0], orbit.parameters, hints_);
    // A scale that follows from the field is kept: where an eigenvalue vanishes the field would give another.
    for (Eigen::Index k = 0; k < n; ++k)
        hints_[equations_.active()[static_cast<std::size_t>(k)]] =
            std::max(hints_[equations_.active()[static_cast<std::size_t>(k)]], remembered * scales_[k]);
    for (std::size_t f = 0; f < largest_.size(); ++f) {
        double& largest = largest_[f];
        largest = std::max(
            {largest, std::abs(u[equations_.active().size() + f]), smallest * nominal_[f], smallest * ranges_[f]});
        scales_[n + index(f)] = largest > 0 ? largest : 1;
    }
}

void EquilibriumProblem::accept(std::span<const double> u) {
    choose_scales(u);
    for (std::size_t k = 0; k < held_.size(); ++k)
        if (describe(u, at_))
            held_[k]->accept(at_);
    if (evaluate(u))
        measure_rows();
}

void EquilibriumProblem::reduce(std::span<double> difference) const {
    const std::vector<double> periods = equations_.system().periods()(at_.parameters);
    for (std::size_t k = 0; k < equations_.active().size(); ++k)
        difference[k] = without_turns(difference[k], periods[equations_.active()[k]]);
}

} // namespace graze
