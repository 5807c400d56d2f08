#pragma once

#include "branch/torus_problem.hpp"
#include "graze/branch/continuation.hpp"
#include "graze/orbit/orbit.hpp"

#include <Eigen/Core>

#include <cstddef>
#include <span>
#include <string>
#include <vector>

namespace graze {

/// The equations of orbits that close after several returns, in which the motion on a torus is locked. Unknowns are the
/// active states at each of the returns and the parameter, one more than equations: where the tongue is narrow there is
/// an orbit at each place of the circle, each at its own parameter, so that the equations are regular however narrow it
/// is. Its ends are the extremes of the parameter along the closed curve of these orbits: their folds.
class LockedOrbitProblem : public ContinuationProblem {
public:
    LockedOrbitProblem(TorusSetting setting, std::size_t returns);

    std::size_t returns() const { return returns_; }
    std::size_t parameter_place() const { return returns_ * setting_.active.size(); }
    /// Returns unknowns of states on a circle at equal angles from each other, or the direction in which they move
    /// around it. @param numerator turns by which the motion advances in all returns
    std::vector<double> on_circle(const Torus& circle, double turns, long numerator, double parameter) const;
    std::vector<double> around_circle(const Torus& circle, double turns, long numerator) const;
    /// Returns the unknowns of the same orbit from a later return on.
    std::vector<double> later(std::span<const double> u, std::size_t returns) const;
    /// Returns the least distance of the first state from the others, in scaled states; infinite for a single one.
    double separation(std::span<const double> u) const;

    // At the last evaluation:
    /// Returns the orbit.
    Orbit orbit() const;
    /// Returns the change of the parameter by an error of the returns in all directions, in their scales.
    double parameter_error(std::span<const double> tangent) const;
    /// What the motion does at another parameter, per change of it.
    struct Drift {
        double along = 0;           ///< displacement along the curve after all returns
        std::vector<double> across; ///< change of the circle across itself at each return; the parameter changes by 1
    };
    Drift drift(std::span<const double> tangent) const;

    std::size_t unknowns() const override { return parameter_place() + 1; }
    std::span<const double> scales() const override { return scales_; }
    bool evaluate(std::span<const double> u) override;
    bool solve(std::span<const double> row, double right, bool homogeneous, std::span<double> step,
               double* determinant) override;

private:
    std::vector<double> state_of(std::span<const double> u, std::size_t place) const;
    Eigen::MatrixXd bordered(std::span<const double> row) const;

    TorusSetting setting_;
    std::size_t returns_;
    std::vector<double> scales_, at_; ///< at_: unknowns of the last evaluation; empty: none
    std::vector<SignatureReturn::Image> images_;
    std::vector<std::vector<double>> durations_;
    Eigen::MatrixXd matrix_; ///< derivatives of the scaled equations by scaled unknowns
    Eigen::VectorXd residuals_;
};

} // namespace graze
