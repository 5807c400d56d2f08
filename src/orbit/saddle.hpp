#pragma once

#include "orbit/equilibrium_equations.hpp"

#include <Eigen/Core>

#include <complex>
#include <cstddef>
#include <span>
#include <string>
#include <vector>

namespace graze {

/// A saddle as a function of parameters: an equilibrium with eigenvalues on both sides of the imaginary axis and none
/// on it, and its linear unstable and stable spaces.
///
/// A state x beside the saddle x_s has the coordinates c = L (x - x_s), in which the linearised motion is a sum of
/// growing and decaying exponentials and spirals. The rows of L belong to the unstable space, then to the stable one;
/// coordinates are in units of the scales of the states.
class Saddle {
public:
    /// @param scales of the states: the columns of the inverse of L have length 1 in these units
    Saddle(const System& system, std::size_t mode, std::vector<ParameterId> free, Eigen::VectorXd scales);

    /// Finds the saddle near a state. @return false, with `problem` set, where there is none
    bool find(std::span<const double> near, std::span<const double> parameters);
    /// The same from the saddle that was found last.
    bool follow(std::span<const double> parameters);
    const std::string& problem() const { return problem_; }

    const std::vector<double>& state() const { return state_; }
    const Eigen::VectorXd& scales() const { return scales_; }
    Eigen::Index unstable() const { return unstable_; } ///< dimension of the unstable space
    Eigen::Index stable() const { return scales_.size() - unstable_; }
    /// The eigenvalues, largest real part first.
    const std::vector<std::complex<double>>& eigenvalues() const { return eigenvalues_; }
    /// The least rate of growth in the unstable space, and of decay in the stable one.
    double slowest_growth() const;
    double slowest_decay() const;

    /// Returns a state relative to the saddle, without whole periods of cyclic states.
    Eigen::VectorXd from_saddle(std::span<const double> state) const;
    const Eigen::MatrixXd& to_coordinates() const { return left_; } ///< L
    /// The direction of a coordinate, in states.
    Eigen::VectorXd direction(Eigen::Index coordinate) const { return right_.col(coordinate); }
    /// Returns the state with the coordinates.
    std::vector<double> state_at(const Eigen::VectorXd& coordinates) const;
    /// Returns where the linearised motion takes coordinates in a time.
    Eigen::VectorXd moved(const Eigen::VectorXd& coordinates, double time) const;
    /// Returns the time of the linearised motion in which coordinates in one of the spaces reach a distance from the
    /// saddle; negative where they have passed it.
    double time_to(double distance, const Eigen::VectorXd& coordinates) const;

    /// Derivatives with respect to the free parameters: of the saddle's state, and of the coordinates of a fixed state.
    const Eigen::MatrixXd& state_by_parameters() const { return state_by_; }
    /// The coordinates are those of frames that turn only across their own space, which is enough to tell where a
    /// coordinate vanishes.
    Eigen::MatrixXd coordinates_by_parameters(std::span<const double> state) const;

private:
    bool solve_for_state(std::span<const double> parameters);
    bool find_spaces(std::span<const double> parameters);
    void find_derivatives(std::span<const double> parameters);
    bool fail(std::string why);

    EquilibriumEquations equations_;
    Eigen::VectorXd scales_;
    std::vector<double> state_, periods_;
    std::vector<std::complex<double>> eigenvalues_;
    Eigen::Index unstable_ = 0;
    Eigen::MatrixXd left_, right_; ///< L and its inverse
    Eigen::MatrixXd field_; ///< the linearised field in coordinates: blocks of one real or two complex eigenvalues
    Eigen::MatrixXd state_by_;
    std::vector<Eigen::MatrixXd> turns_; ///< derivative of L by each free parameter, times the inverse of L
    std::string problem_;
};

} // namespace graze
