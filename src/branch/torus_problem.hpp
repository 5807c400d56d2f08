#pragma once

#include "branch/signature_return.hpp"
#include "graze/branch/continuation.hpp"
#include "graze/branch/torus.hpp"

#include <Eigen/Core>

#include <cstddef>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace graze {

/// What all tori of a branch have in common: their return, and the states that take part in it.
struct TorusSetting {
    std::shared_ptr<SignatureReturn> back;
    std::vector<std::size_t> active; ///< states that are neither drifting nor neutral; the others are held
    Eigen::VectorXd scales;          ///< of all states
    double parameter_scale = 1;
    ParameterId parameter;
};

/// The equations of a torus: the return of its circle is the circle, turned by the rotation number, at as many angles
/// as its Fourier series has terms; and a phase condition, since the angle 0 may lie anywhere on the circle. Unknowns
/// are the terms of the active states (term by term), the rotation number and the parameter.
class TorusProblem : public ContinuationProblem {
public:
    TorusProblem(TorusSetting setting, std::size_t harmonics);

    const TorusSetting& setting() const { return setting_; }
    std::size_t harmonics() const { return harmonics_; }
    /// Number of terms of the series of a state, and of angles at which the equations hold.
    std::size_t terms() const { return 2 * harmonics_ + 1; }
    std::size_t rotation_place() const { return terms() * setting_.active.size(); }
    std::size_t parameter_place() const { return rotation_place() + 1; }
    /// Place of the term of an active state.
    std::size_t place_of(std::size_t term, std::size_t active) const { return term * setting_.active.size() + active; }

    Torus torus_of(std::span<const double> u) const;
    /// Returns unknowns, or a direction of them, of a series with fewer terms with zeros for the further terms.
    std::vector<double> extended(std::span<const double> fewer) const;
    /// Returns the largest term from one on, in scaled states.
    double largest_from(std::size_t first_term, std::span<const double> u) const;
    /// Returns the largest of the last two harmonics, relative to the largest of all, in scaled states.
    double tail_of(std::span<const double> u) const;
    /// Returns the same equations with more harmonics, whose first guesses and scales are those of these.
    std::shared_ptr<TorusProblem> with_harmonics(std::size_t harmonics) const;
    /// The returns from each of the angles, at the last evaluation.
    const std::vector<SignatureReturn::Image>& images() const { return images_; }
    /// Why the last evaluation failed.
    const std::string& problem() const { return problem_; }
    /// Sets the scale of the parameter, which is not to change within a step.
    void set_parameter_scale(double scale) { scales_[parameter_place()] = scale; }

    std::size_t unknowns() const override { return parameter_place() + 1; }
    std::span<const double> scales() const override { return scales_; }
    bool evaluate(std::span<const double> u) override;
    bool solve(std::span<const double> row, double right, bool homogeneous, std::span<double> step,
               double* determinant) override;
    /// The phase condition refers to the circle from which a step begins.
    void accept(std::span<const double> u) override;

private:
    void assemble(const Eigen::MatrixXd& circle, double rotation);

    TorusSetting setting_;
    std::size_t harmonics_;
    std::vector<double> scales_, at_; ///< at_: unknowns of the last evaluation; empty: none
    std::vector<SignatureReturn::Image> images_;
    std::vector<std::vector<double>> durations_; ///< of the motions from each of the angles
    Eigen::MatrixXd matrix_; ///< derivatives of the scaled equations by scaled unknowns, but by the parameter itself
    Eigen::VectorXd residuals_, phase_; ///< the same; row of the phase condition
    std::string problem_;
};

/// Returns 1, then for k = 1, 2, ... cos(2 pi k turns) and sin(2 pi k turns).
Eigen::VectorXd circle_functions(std::size_t harmonics, double turns);
/// Returns their derivatives by the turns.
Eigen::VectorXd circle_function_rates(std::size_t harmonics, double turns);

} // namespace graze
