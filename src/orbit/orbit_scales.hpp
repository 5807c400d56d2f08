#pragma once

#include "orbit/orbit_evaluation.hpp"
#include "orbit/orbit_flow.hpp"

#include <span>

namespace graze {

/// Scales of the states of an orbit: their extents along it. The scales remember their largest values; otherwise a
/// branch on which the orbit shrinks to a point would never reach its end.
class StateScales {
public:
    explicit StateScales(std::size_t states) : largest_(states, 0.0), has_size_(states, true) {}

    /// Starts a new orbit: forgets the extents, keeps the largest scales.
    void begin();
    void note(std::span<const double> state);
    /// @param periods of cyclic states, 0 for others
    /// @param coupling largest derivatives of states with respect to earlier ones @param arcs the same along arcs
    /// without jumps
    std::vector<double> choose(std::span<const double> periods, const Eigen::MatrixXd& coupling,
                               const Eigen::MatrixXd& arcs);

    /// True when the state was not negligible at the last choice of scales; otherwise its scale is borrowed from
    /// another state.
    bool has_size(std::size_t state) const { return has_size_[state]; }

private:
    bool is_constant(std::size_t i) const;
    double scale_by_effect(std::size_t i, std::span<const double> own, std::span<const double> periods,
                           const Eigen::MatrixXd& arcs) const;

    std::vector<double> least_, greatest_, sizes_, largest_;
    std::vector<bool> has_size_;
};

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
