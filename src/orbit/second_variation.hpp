#pragma once

#include "graze/flow/second_order_flow.hpp"
#include "orbit/orbit_equations.hpp"

#include <Eigen/Core>

#include <cstddef>
#include <vector>

namespace graze {

/// Computes the gradient of l^T A(u) r at fixed vectors l and r, where A(u) is the matrix of derivatives of an orbit's
/// equations with respect to starts and durations. Conditions that the matrix is singular, such as that of a fold, need
/// it (W. Govaerts, "Numerical Methods for Bifurcations of Dynamical Equilibria", 2000, for -l^T A_u r). Second
/// derivatives come from the flow of the first variational equations and from symbolic differentiation of events and
/// jumps, not from differences.
///
/// Pieces are integrated, whatever the discretisation is.
class SecondVariation {
public:
    explicit SecondVariation(const OrbitEquations& equations);

    /// @param left one column for each l: per piece the weight of its end condition, then those of its continuity rows,
    /// pieces (1 + states) rows; @param right the vector r: directions of starts and durations, pieces (states + 1)
    /// @param gradients of the products with respect to all unknowns, one row for each l
    /// @return false where a piece cannot be followed
    bool contract(const OrbitEquations& equations, const OrbitEvaluation& at, const Eigen::MatrixXd& left,
                  const Eigen::VectorXd& right, Eigen::MatrixXd& gradients);

private:
    /// A state and its variation (gain), both with derivatives with respect to start, duration and free parameters.
    struct Tangent {
        std::vector<double> state;
        Eigen::VectorXd gain;
        Eigen::MatrixXd of_state, of_gain;
    };
    bool follow(const OrbitEquations& equations, const OrbitEvaluation& at, std::size_t piece,
                const Eigen::VectorXd& gain, double longer, Tangent& result);
    void evaluate(const Function& function, const Tangent& tangent);
    Eigen::MatrixXd derivative_of_gain(const Tangent& tangent, std::size_t values) const;
    void pass(const Function& map, Tangent& tangent);
    Eigen::VectorXd rate_along(std::size_t mode, const std::vector<double>& state, const Eigen::VectorXd& by_state,
                               const Eigen::VectorXd& by_parameters);

    VariationalSystem system_;
    SecondOrderFlow flow_;
    std::size_t states_, free_;
    std::vector<double> parameters_, inputs_, values_, work_;
};

} // namespace graze
