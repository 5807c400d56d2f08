#pragma once

#include "graze/flow/tangent_steps.hpp"
#include "graze/trajectory/simulation.hpp"
#include "graze/trajectory/trajectory.hpp"

#include <memory>
#include <span>
#include <vector>

namespace graze {

/// Derivatives of one trajectory in several directions (of initial state and parameters), carried along arcs by the
/// first variational equations and through contacts by the saltation formulas (Aizerman and Gantmakher 1958; di
/// Bernardo et al. 2008, section 2.5), with the field *before* the jump in the projection.
///
/// Matrices are row by row, [row * directions + direction]. They hold derivatives at fixed time.
class Tangents {
public:
    /// @param seeds direction after direction, each (states + parameters) numbers
    Tangents(const Simulation& simulation, std::span<const double> parameters, std::span<const double> seeds,
             std::size_t directions);

    std::size_t directions() const { return directions_; }
    std::span<const double> matrix() const { return matrix_; }
    bool valid() const { return valid_; }
    void invalidate() { valid_ = false; }

    /// Jets on which the trajectory runs: the first has been computed at the present state, and has tangents. They are
    /// used once for what comes next; without them the motion's series are computed again.
    void use(Jet* jet, Jet* next) {
        jet_ = jet;
        next_jet_ = next;
    }

    /// Derivatives of coefficient k (at most 2) of the function of a watched event at the start of the arc.
    void coefficient(std::size_t mode, std::span<const double> state, std::size_t watched, std::size_t k,
                     std::span<double> row);

    /// Moves along the arc that starts at `state`, by a time s.
    /// @param row derivatives at its end of the function of an event that the mode watches, directions; may be empty
    void advance(std::size_t mode, std::span<const double> state, double s, std::size_t watched = 0,
                 std::span<double> row = {});
    /// Passes a jump that comes `shift` (derivatives, directions) later than time says: at a contact, minus the
    /// derivatives of the event function over its rate.
    /// @param field_before, field_after rates of the states; @param jacobian values of the jump's entries
    void pass_jump(std::span<const double> shift, std::span<const double> field_before,
                   const System::CompiledJump& jump, std::span<const double> jacobian,
                   std::span<const double> field_after);
    /// A cyclic state is set back by so many periods, which parameters may change.
    void set_back(std::size_t state, double periods);
    /// Adds `column` times `row` to the matrix.
    void add_product(std::span<const double> column, std::span<const double> row);

private:
    void find_period_rates(const System& system, std::span<const double> parameters);
    Jet& begin(std::size_t mode, std::span<const double> state);

    Simulation simulation_;
    std::vector<double> parameters_;
    std::size_t states_, directions_;
    TangentSteps steps_;
    std::vector<double> parameter_seeds_, matrix_, next_;
    std::vector<double> period_rates_;         ///< derivatives of the states' periods; empty: no direction changes any
    std::vector<double> here_;                 ///< state, within arcs that are followed in parts
    Jet *jet_ = nullptr, *next_jet_ = nullptr; ///< those of the trajectory, while they are at its state
    std::unique_ptr<ModeJets> jets_;           ///< of its own, where these are not to be had
    bool valid_ = true;
};

} // namespace graze
