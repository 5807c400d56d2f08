#pragma once

#include "branch/orbit_condition.hpp"
#include "branch/orbit_quantity.hpp"
#include "orbit/orbit_equations.hpp"

#include <Eigen/Core>

#include <cstddef>
#include <vector>

namespace graze {

/// Returns the derivatives of an orbit's equations as a dense matrix, all scaled: equations x unknowns.
Eigen::MatrixXd dense_derivatives(const OrbitEquations& equations, const OrbitEvaluation& at);

/// Finds the directions in which an orbit can be moved without a change of its period and of what its model conserves,
/// such as a turn of the whole orbit about a centre of attraction.
class NeutralDirections {
public:
    explicit NeutralDirections(const OrbitEquations& equations);
    /// Returns the directions, scaled, in columns. @param most number of directions at most
    Eigen::MatrixXd operator()(const OrbitEquations& equations, const OrbitEvaluation& at, std::size_t most);

private:
    std::vector<OrbitQuantity> unchanged_;
};

/// Keeps an orbit from moving in a neutral direction: a phase condition. It is renewed along a branch.
class NeutralDirection final : public OrbitCondition {
public:
    /// @param place index among the neutral directions, of which there are `count`
    NeutralDirection(const OrbitEquations& equations, std::size_t place, std::size_t count)
        : find_(equations), place_(place), count_(count) {}

    bool evaluate(const OrbitEquations& equations, const OrbitEvaluation& at) override;
    void renew(const OrbitEquations& equations, const OrbitEvaluation& at) override;

private:
    NeutralDirections find_;
    std::size_t place_, count_;
    Eigen::VectorXd direction_, reference_; ///< empty before the first evaluation
};

} // namespace graze
