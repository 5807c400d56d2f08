#pragma once

#include "graze/orbit/orbit.hpp"
#include "graze/trajectory/simulation.hpp"
#include "orbit/end_distances.hpp"

#include <Eigen/Core>

#include <complex>
#include <cstddef>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace graze {

/// A saddle cycle as a function of parameters: a periodic orbit with one multiplier outside the unit circle, which is
/// real, and all others inside, with its linear unstable and stable spaces where its first segment starts.
///
/// The derivative P of the return to that place has a right eigenvector v of the unstable multiplier, which spans the
/// linear unstable space, and a left one, w, with w v = 1. For a state x beside the cycle's start x_c the unstable
/// coordinate w (x - x_c) vanishes in the linear stable space, and along the motion through x_c.
class SaddleCycle {
public:
    /// @param cycle a periodic orbit, or a guess; whole
    SaddleCycle(const Simulation& simulation, const Orbit& cycle, std::vector<ParameterId> free);
    ~SaddleCycle();
    SaddleCycle(SaddleCycle&&) noexcept;
    SaddleCycle& operator=(SaddleCycle&&) noexcept;

    /// Finds the cycle at parameters, from where it was last. @return false, with `problem` set, where it is lost or no
    /// saddle with one unstable direction
    bool follow(std::span<const double> parameters);
    const std::string& problem() const { return problem_; }
    /// Chooses the units of distances. @param scales of the states
    void set_scales(const Eigen::VectorXd& scales);
    const Eigen::VectorXd& scales() const { return scales_; }

    const Orbit& orbit() const { return orbit_; }
    const std::vector<double>& state() const { return orbit_.starts.front(); }
    std::size_t segments() const { return orbit_.segments(); }
    const std::vector<double>& periods() const { return periods_; } ///< of cyclic states, 0 for others
    /// The Floquet multipliers, largest first.
    const std::vector<std::complex<double>>& multipliers() const { return multipliers_; }
    double unstable_multiplier() const { return multipliers_.front().real(); }
    /// The rates, per turn, at which distances grow in the unstable space, and decay at least in the stable one.
    double growth() const;
    double decay() const;
    /// The distances at which a homoclinic orbit shall begin and end.
    EndDistances wanted_distances() const;
    const Eigen::VectorXd& unstable_direction() const { return direction_; }      ///< v, of length 1 in these units
    const Eigen::RowVectorXd& unstable_coordinate() const { return coordinate_; } ///< w
    /// Derivatives of the start with respect to the free parameters.
    const Eigen::MatrixXd& state_by_parameters() const { return state_by_; }

    /// Returns a state relative to the cycle's start, without whole periods of cyclic states.
    Eigen::VectorXd from_cycle(std::span<const double> state) const;
    /// The length of a difference of states, in units of the scales.
    double length_of(const Eigen::VectorXd& difference) const { return difference.cwiseQuotient(scales_).norm(); }

    /// The segments of one turn beside the cycle, to first order.
    struct Turn {
        std::vector<std::vector<double>> starts;
        std::vector<double> durations;
        Eigen::VectorXd off; ///< distance from the cycle's start after the turn
    };
    /// @param off distance from the cycle's start at the beginning
    Turn turn_from(const Eigen::VectorXd& off) const;

private:
    class Equations;

    bool fail(std::string why);
    bool find_spaces();

    std::unique_ptr<Equations> equations_;
    Eigen::VectorXd scales_;
    Orbit orbit_;
    std::vector<double> periods_;
    std::vector<std::complex<double>> multipliers_;
    Eigen::VectorXd direction_;
    Eigen::RowVectorXd coordinate_;
    Eigen::MatrixXd state_by_;
    /// Per segment: derivatives of the next start, and of the duration, with respect to the start.
    std::vector<Eigen::MatrixXd> links_;
    std::vector<Eigen::RowVectorXd> delays_;
    std::string problem_;
};

} // namespace graze
