#pragma once

#include "orbit/orbit_flow.hpp"
#include "orbit/orbit_layout.hpp"
#include "orbit/state_scales.hpp"

#include <Eigen/Core>

#include <cstddef>
#include <span>
#include <vector>

namespace graze {

/// Sizes of the unknowns of an orbit's equations, by which residuals and steps are measured: extents of the states
/// along the orbit, the period, the parameters. Those of the parameters never shrink, those of the states only so far.
/// A parameter that is small or zero is measured by what it does to the orbit.
class OrbitScales {
public:
    /// @param usual values of the free parameters
    /// @param ranges in which they are looked at, where that is known; 0 where it is not
    OrbitScales(std::size_t states, std::vector<double> usual, std::vector<double> ranges);

    /// How strongly states act on one another over some time: the greatest derivatives count.
    void note_coupling(const Eigen::MatrixXd& derivatives) { coupling_ = coupling_.cwiseMax(derivatives.cwiseAbs()); }
    /// The same along an arc rather than by a jump.
    void note_arc(const Eigen::MatrixXd& derivatives) {
        arcs_ = arcs_.cwiseMax(derivatives.cwiseAbs());
        note_coupling(derivatives);
    }
    const Eigen::MatrixXd& coupling() const { return coupling_; }
    const Eigen::MatrixXd& arcs() const { return arcs_; }
    /// What the free parameters do to the equations, in units of the states' scales.
    void note_effects(const Eigen::VectorXd& effects) { effects_ = effects; }

    /// Scales at some unknowns. Inner ones are states, one after the other.
    /// @param modes of the segments; @param flow with the parameters set; @param periods of cyclic states
    Eigen::VectorXd choose(const OrbitLayout& layout, const Eigen::VectorXd& unknowns,
                           std::span<const std::size_t> modes, ModeFlow& flow, std::span<const double> periods);

    bool has_size(std::size_t state) const { return states_.has_size(state); }

private:
    double parameter_scale(std::size_t f, double value);

    StateScales states_;
    std::vector<double> usual_, ranges_;
    std::vector<double> largest_; ///< that the free parameters have been
    Eigen::MatrixXd coupling_, arcs_;
    Eigen::VectorXd effects_;
};

} // namespace graze
