#pragma once

#include "graze/branch/continuation.hpp"
#include "graze/branch/orbit_branch.hpp"
#include "orbit/equilibrium_equations.hpp"

#include <Eigen/Core>

#include <cstddef>
#include <memory>
#include <optional>
#include <span>
#include <vector>

namespace graze {

/// The equations of equilibria and their derivatives at a point, in units of the unknowns' scales: active states, then
/// varying parameters. Rates are divided by the scales of their states, so that `field` has the eigenvalues of the
/// linearised field.
struct EquilibriumEvaluation {
    const EquilibriumEquations* equations = nullptr;
    std::vector<double> state, parameters; ///< all states, all independent parameters
    Eigen::VectorXd scales, rates;
    Eigen::MatrixXd field;    ///< active states x active states
    Eigen::MatrixXd jacobian; ///< active states x unknowns

    Eigen::Index size() const { return rates.size(); }
    /// Derivatives, with respect to all unknowns, of the derivative of the rates along a direction of the active
    /// states, or of all unknowns.
    Eigen::MatrixXd second(const Eigen::VectorXd& direction) const;
    /// The gradient of a function, from its derivatives with respect to all states and all independent parameters.
    Eigen::VectorXd gradient_of(std::span<const double> by_inputs) const;
};

/// A condition that holds along a curve of equilibria.
class EquilibriumCondition {
public:
    virtual ~EquilibriumCondition() = default;
    /// @param gradient with respect to the scaled unknowns. @return false where it is not defined
    virtual bool evaluate(const EquilibriumEvaluation& at, double& value, Eigen::VectorXd& gradient) = 0;
    /// Called at each accepted point of the curve, to choose what must stay the same during the next step.
    virtual void accept(const EquilibriumEvaluation&) {}
};

/// Equilibria with a free parameter as a continuation problem, optionally with conditions that hold and as many
/// additional free parameters. Unknowns are the active states and the free parameters, in their own units.
class EquilibriumProblem : public ContinuationProblem {
public:
    /// @param settings names the free parameters: that of the branch, then the additional ones
    EquilibriumProblem(const System& system, const Orbit& candidate, const BranchSettings& settings);

    const EquilibriumEquations& equations() const { return equations_; }
    const EquilibriumEvaluation& evaluation() const { return at_; }
    void hold(std::unique_ptr<EquilibriumCondition> condition) { held_.push_back(std::move(condition)); }
    /// Index of the branch parameter among the unknowns.
    std::size_t parameter_place() const { return equations_.active().size(); }

    std::vector<double> unknowns_of(const Orbit& orbit) const;
    std::vector<double> unknowns_of(const OrbitDirection& direction) const;
    Orbit orbit_of(std::span<const double> u) const;
    OrbitDirection direction_of(std::span<const double> u) const;
    /// Evaluates the equations without the conditions. @return false where they are not defined
    bool describe(std::span<const double> u, EquilibriumEvaluation& at) const;

    std::size_t unknowns() const override { return static_cast<std::size_t>(scales_.size()); }
    std::span<const double> scales() const override { return {scales_.data(), unknowns()}; }
    bool evaluate(std::span<const double> u) override;
    bool solve(std::span<const double> row, double right, bool homogeneous, std::span<double> step,
               double* determinant) override;
    void accept(std::span<const double> u) override;
    void reduce(std::span<double> difference) const override;

private:
    void choose_scales(std::span<const double> u);
    void measure_rows();

    Orbit like_; ///< the candidate, whose other states and parameters stay
    EquilibriumEquations equations_;
    std::vector<double> hints_, largest_, nominal_, ranges_;
    std::vector<std::unique_ptr<EquilibriumCondition>> held_;
    Eigen::VectorXd scales_;
    EquilibriumEvaluation at_;
    Eigen::VectorXd values_;
    Eigen::MatrixXd matrix_;    ///< in scaled unknowns
    Eigen::VectorXd row_sizes_; ///< lengths of its rows at the last accepted point, by which they are divided
};

} // namespace graze
