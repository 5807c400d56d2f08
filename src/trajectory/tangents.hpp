#pragma once

#include "graze/flow/mode_flow.hpp"
#include "graze/flow/tangent_steps.hpp"
#include "graze/trajectory/simulation.hpp"
#include "graze/trajectory/trajectory.hpp"

#include <memory>
#include <span>
#include <vector>

namespace graze {

/// Derivatives of one trajectory in several directions (of initial state and parameters): along arcs by the first
/// variational equations, at contacts by the saltation formulas (Aizerman and Gantmakher 1958; di Bernardo et al. 2008,
/// section 2.5), with the field *before* the jump in the projection.
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

    /// Provides the trajectory's jets: the first has tangents and has been computed at the present state. They are used
    /// once, by the next call; without them the series of the motion are computed again.
    void use(Jet* jet, Jet* next) {
        jet_ = jet;
        next_jet_ = next;
    }

    /// Says whether the next call of `advance` passes a knot of a table, in a step as short as round-off.
    void cross_knot(bool crosses) { crosses_knot_ = crosses; }

    /// Computes derivatives of coefficient k (at most 2) of a watched event's function at the start of the arc.
    void coefficient(std::size_t mode, std::span<const double> state, std::size_t watched, std::size_t k,
                     std::span<double> row);

    /// Propagates derivatives along the arc that starts at `state`, over a time s.
    /// @param row receives the derivatives of a watched event's function at the end, by direction; may be empty
    void advance(std::size_t mode, std::span<const double> state, double s, std::size_t watched = 0,
                 std::span<double> row = {});
    /// Propagates derivatives over a short time from a state at which the argument of a root or power is zero, and the
    /// motion has no series. Where that is no event of the mode they stay as they are.
    void leave_root(std::size_t mode, std::span<const double> state, double duration);
    /// Propagates derivatives through a jump whose time changes by `shift`, one number for each direction: at a
    /// contact, minus the derivatives of the event function over its rate.
    /// @param field_before, field_after rates of the states; @param jacobian values of the jump's entries
    void pass_jump(std::span<const double> shift, std::span<const double> field_before,
                   const System::CompiledJump& jump, std::span<const double> jacobian,
                   std::span<const double> field_after);
    /// Accounts for a shift of a cyclic state by whole periods, which may depend on parameters.
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
    std::vector<double> period_rates_; ///< derivatives of the states' periods; empty: no direction changes a period
    std::vector<double> here_;         ///< state within an arc that is propagated in parts
    Jet *jet_ = nullptr, *next_jet_ = nullptr; ///< the trajectory's jets, while they are at its state
    std::unique_ptr<ModeJets> jets_;           ///< own jets, used without those of the trajectory
    std::unique_ptr<ModeFlow> flow_;           ///< made when a root is left
    bool crosses_knot_ = false;
    bool valid_ = true;
};

} // namespace graze
