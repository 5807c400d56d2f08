#pragma once

#include "graze/trajectory/simulation.hpp"
#include "graze/trajectory/trajectory.hpp"

#include <Eigen/Core>

#include <complex>
#include <cstddef>
#include <optional>
#include <span>
#include <vector>

namespace graze {

/// The geometry of a section, for derivatives of the return map. Immutable; threads may share it.
class SectionMap {
public:
    /// @param probe probe of the simulation; its passages are returns
    SectionMap(const Simulation& simulation, std::size_t probe);

    const Simulation& simulation() const { return simulation_; }
    std::size_t probe() const { return probe_; }
    std::size_t states() const { return states_; }
    bool is_phase() const { return simulation_.probes()[probe_].kind == Probe::Kind::phase; }
    /// Returns whether the state takes part in returns: neither drifting nor the section's own phase.
    bool takes_part(std::size_t state) const { return takes_part_[state]; }

    /// Workspace for one thread.
    struct Workspace {
        std::vector<double> inputs, work, field, gradient, events, event_gradients, errors;
    };
    Workspace workspace(std::span<const double> parameters) const;

    /// Converts derivatives at fixed time (state x direction, row by row) to derivatives on the section, by
    /// displacements along the flow. @return false if the flow is tangent to the section
    bool project(Workspace& workspace, std::size_t mode, std::span<const double> state,
                 Eigen::MatrixXd& tangents) const;
    /// Returns the gradient of the section's function by the states; zero for the section of a phase, which takes no
    /// part.
    std::vector<double> gradient_at(std::span<const double> parameters, std::span<const double> state) const;
    /// Moves a state onto a crossing section by one Newton step; a phase is unchanged.
    void settle_on_section(Workspace& workspace, std::span<double> state) const;
    /// Raises `result` to the displacement that the rounding of rates may cause in each state within a time, near this
    /// state.
    void add_round_off(Workspace& workspace, std::size_t mode, std::span<const double> state, double time,
                       std::span<double> result) const;
    /// Returns whether an event of the mode happens within `time` of the state.
    bool is_on_event(Workspace& workspace, std::size_t mode, std::span<const double> state,
                     std::span<const double> periods, double time) const;

private:
    bool meets_event(Workspace& workspace, std::size_t mode, double time) const;

    Simulation simulation_;
    std::size_t probe_, states_;
    Function section_; ///< value, then gradient; for crossings
    std::vector<bool> takes_part_;
};

/// Computes the difference of two values of each state; of cyclic states, the shorter one.
void subtract_states(std::span<const double> a, std::span<const double> b, std::span<const double> periods,
                     std::span<double> difference);

/// The derivative of a return map, for a Newton step to a fixed point and for multipliers.
struct ReturnJacobian {
    Eigen::MatrixXd matrix;          ///< state x state, zero in rows and columns of states that take no part
    std::vector<std::size_t> active; ///< states that take part and are not conserved
};
/// @param tangents of the return map in the directions of all states. States that it leaves exactly unchanged (a frame
/// at rest) are conserved and removed.
ReturnJacobian return_jacobian(const SectionMap& map, const Eigen::MatrixXd& tangents);
/// @param defect image minus point; @param scale of each state
/// @return correction of the point: of least norm if the matrix is singular
Eigen::VectorXd newton_correction(const ReturnJacobian& jacobian, const Eigen::VectorXd& defect,
                                  const Eigen::VectorXd& scale);
/// The spectrum of the return map within the section.
struct ReturnSpectrum {
    std::vector<std::complex<double>> multipliers; ///< largest first
    Eigen::VectorXd direction;                     ///< real direction of the leading multiplier, in states
    /// Component along this direction, or in its plane, of a deviation in units of the scales.
    Eigen::VectorXcd functional;
};
/// @return nothing if the eigenvalues could not be computed
std::optional<ReturnSpectrum> return_spectrum(const SectionMap& map, const ReturnJacobian& jacobian,
                                              const Eigen::VectorXd& scale);
/// True if a multiplier is larger than a radius, of at least 1. Of many states not all multipliers are computed.
bool has_multiplier_beyond(const ReturnJacobian& jacobian, const Eigen::VectorXd& scale, double radius);

} // namespace graze
