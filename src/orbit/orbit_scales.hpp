#pragma once

#include "orbit/orbit_flow.hpp"
#include "orbit/orbit_layout.hpp"
#include "orbit/state_scales.hpp"

#include <Eigen/Core>

#include <cstddef>
#include <span>
#include <vector>

namespace graze {

/// Scales of the unknowns of an orbit's equations, which normalise residuals and steps: extents of the states along the
/// orbit, the period, magnitudes of the parameters. Scales of parameters never shrink, those of states only to a share
/// of their largest value. A parameter near zero is scaled by its effect on the orbit.
class OrbitScales {
public:
    /// @param nominal values of the free parameters: those of the model
    /// @param ranges lengths of the intervals in which the free parameters vary; 0 where unknown
    OrbitScales(std::size_t states, std::vector<double> nominal, std::vector<double> ranges);

    /// Records derivatives of states with respect to earlier states; the largest magnitudes count.
    void note_coupling(const Eigen::MatrixXd& derivatives) { coupling_ = coupling_.cwiseMax(derivatives.cwiseAbs()); }
    /// The same for derivatives along an arc, without a jump.
    void note_arc(const Eigen::MatrixXd& derivatives) {
        arcs_ = arcs_.cwiseMax(derivatives.cwiseAbs());
        note_coupling(derivatives);
    }
    const Eigen::MatrixXd& coupling() const { return coupling_; }
    const Eigen::MatrixXd& arcs() const { return arcs_; }
    /// Records the largest derivative of the scaled equations with respect to each free parameter.
    void note_effects(const Eigen::VectorXd& effects) { effects_ = effects; }

    /// Returns the scales at given unknowns. Inner unknowns are states, one after another.
    /// @param modes mode of each segment; @param flow with the parameters set; @param periods of cyclic states, 0 for
    /// others
    Eigen::VectorXd choose(const OrbitLayout& layout, const Eigen::VectorXd& unknowns,
                           std::span<const std::size_t> modes, ModeFlow& flow, std::span<const double> periods);

    bool has_size(std::size_t state) const { return states_.has_size(state); }

private:
    double parameter_scale(std::size_t f, double value);

    StateScales states_;
    std::vector<double> nominal_, ranges_;
    std::vector<double> largest_; ///< largest magnitude so far of each free parameter
    Eigen::MatrixXd coupling_, arcs_;
    Eigen::VectorXd effects_;
};

} // namespace graze
