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
    /// @param probe of the simulation, whose passages are returns
    SectionMap(const Simulation& simulation, std::size_t probe);

    const Simulation& simulation() const { return simulation_; }
    std::size_t probe() const { return probe_; }
    std::size_t states() const { return states_; }
    bool is_phase() const { return simulation_.probes()[probe_].kind == Probe::Kind::phase; }
    /// Whether the state takes part in returns: neither drifting nor the section's own phase.
    bool takes_part(std::size_t state) const { return takes_part_[state]; }

    /// Numbers that every use needs, for one thread.
    struct Workspace {
        std::vector<double> inputs, work, field, gradient, events, event_gradients, errors;
    };
    Workspace workspace(std::span<const double> parameters) const;

    /// Derivatives at fixed time (state x direction, row by row) made those at the section: displacements along the
    /// flow bring each back to it. @return false where the flow is tangent to the section
    bool project(Workspace& workspace, std::size_t mode, std::span<const double> state,
                 Eigen::MatrixXd& tangents) const;
    /// Of the function whose zero is the section, by the states; of a phase, which takes no part, nought.
    std::vector<double> gradient_at(std::span<const double> parameters, std::span<const double> state) const;
    /// Moves a state onto a crossing section by one step of Newton's method; a phase is left as it is.
    void settle_on_section(Workspace& workspace, std::span<double> state) const;
    /// How far the rounding of rates may move each state within a time, where the motion stays about here. At least
    /// what `result` has.
    void add_round_off(Workspace& workspace, std::size_t mode, std::span<const double> state, double time,
                       std::span<double> result) const;
    /// Whether an event of the mode happens within `time` of the state.
    bool is_on_event(Workspace& workspace, std::size_t mode, std::span<const double> state,
                     std::span<const double> periods, double time) const;

private:
    bool meets_event(Workspace& workspace, std::size_t mode, double time) const;

    Simulation simulation_;
    std::size_t probe_, states_;
    Function section_; ///< value, then gradient; of crossings
    std::vector<bool> takes_part_;
};

/// Difference of two values of each state, cyclic ones by the shorter way round.
void subtract_states(std::span<const double> a, std::span<const double> b, std::span<const double> periods,
                     std::span<double> difference);

/// One step of Newton's method for a fixed point of a return map, and the multipliers.
struct ReturnJacobian {
    Eigen::MatrixXd matrix;          ///< state x state, zero in rows and columns that take no part
    std::vector<std::size_t> active; ///< states that take part and are not conserved
};
/// @param tangents of the return map in the directions of all states. States that it leaves exactly as they are
///        (a frame at rest) are conserved, and taken out.
ReturnJacobian return_jacobian(const SectionMap& map, const Eigen::MatrixXd& tangents);
/// @param defect image minus point; @param scale of each state
/// @return correction of the point: least in norm if the matrix is singular
Eigen::VectorXd newton_correction(const ReturnJacobian& jacobian, const Eigen::VectorXd& defect,
                                  const Eigen::VectorXd& scale);
/// Of the return map within the section.
struct ReturnSpectrum {
    std::vector<std::complex<double>> multipliers; ///< largest first
    Eigen::VectorXd direction;                     ///< of the leading one: a real vector of states
    /// Component along that direction, or in its plane, of a deviation whose states are divided by their scales.
    Eigen::VectorXcd functional;
};
/// @return nothing where the eigenvalues could not be computed
std::optional<ReturnSpectrum> return_spectrum(const SectionMap& map, const ReturnJacobian& jacobian,
                                              const Eigen::VectorXd& scale);

} // namespace graze
