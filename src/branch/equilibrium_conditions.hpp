#pragma once

#include "branch/equilibrium_problem.hpp"
#include "graze/branch/special_point.hpp"

#include <Eigen/Core>

#include <complex>
#include <memory>
#include <optional>
#include <span>

namespace graze {

/// The null vectors of the linearised field at a fold, with lengths and signs that vary smoothly between points: given
/// by fixed borders (W. Govaerts, "Numerical Methods for Bifurcations of Dynamical Equilibria", 2000).
class FoldBorders {
public:
    struct Null {
        double value = 0;            ///< zero where the field is singular
        Eigen::VectorXd right, left; ///< field * right = -value * border of rows, likewise left
    };
    /// Chooses borders for a point and those near it; their signs follow those of the last ones.
    /// @param size of the equations: the field may be zero
    void choose(const Eigen::MatrixXd& field, double size);
    bool are_chosen() const { return rows_.size() > 0; }
    std::optional<Null> at(const Eigen::MatrixXd& field) const;

private:
    Eigen::VectorXd rows_, columns_;
    double size_ = 1;
};

/// The two-dimensional invariant subspace of a pair of eigenvalues, complex or real, with its left counterpart:
/// left^T right = 1. The sum and the product of the pair are smooth where it turns from complex to real.
struct EigenvaluePair {
    double sum = 0, product = 0;
    Eigen::MatrixXd right, left;
};
/// Returns the pair whose sum is nearest to zero and whose product is nearest to the given one.
std::optional<EigenvaluePair> eigenvalue_pair(const Eigen::MatrixXd& field, double product);

/// The condition of a fold: the linearised field has an eigenvalue 0.
class EquilibriumFold : public EquilibriumCondition {
public:
    explicit EquilibriumFold(const EquilibriumEvaluation& at) { accept(at); }
    bool evaluate(const EquilibriumEvaluation& at, double& value, Eigen::VectorXd& gradient) override;
    void accept(const EquilibriumEvaluation& at) override;
    const FoldBorders& borders() const { return borders_; }

private:
    FoldBorders borders_;
    double size_ = 1;
};

/// The condition of a Hopf point: two eigenvalues have the sum 0.
class EquilibriumHopf : public EquilibriumCondition {
public:
    /// @param product of the two eigenvalues at the first point
    EquilibriumHopf(const EquilibriumEvaluation& at, double product) : product_(product) { accept(at); }
    bool evaluate(const EquilibriumEvaluation& at, double& value, Eigen::VectorXd& gradient) override;
    void accept(const EquilibriumEvaluation& at) override;
    double product() const { return product_; }

private:
    double product_, size_ = 1;
};

/// A function of states and parameters that is held: an event's function at zero, or a monitor's expression.
class HeldFunction : public EquilibriumCondition {
public:
    /// @param function value, then derivatives with respect to states and parameters
    HeldFunction(Function function, double held, const EquilibriumEvaluation& at)
        : function_(std::move(function)), held_(held) {
        accept(at);
    }
    bool evaluate(const EquilibriumEvaluation& at, double& value, Eigen::VectorXd& gradient) override;
    void accept(const EquilibriumEvaluation& at) override;

private:
    Function function_;
    double held_, size_ = 1;
};

} // namespace graze
