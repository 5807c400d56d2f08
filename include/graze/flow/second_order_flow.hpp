#pragma once

#include "graze/flow/mode_flow.hpp"
#include "graze/flow/variational_system.hpp"

#include <cstddef>
#include <span>
#include <vector>

namespace graze {

/// The smooth flow of one mode over a given time, as ModeFlow, with first derivatives and second derivatives contracted
/// with a vector. Newton's method needs them for equations that contain derivatives, such as those of folds and of
/// other curves of bifurcations.
///
/// Let x(t) be the state after a time, y = (x(0), p) the variables (states, then free parameters) and v a vector with
/// one component for each variable. The second derivatives are those of the tangent x_y v with respect to y, at fixed v
/// and time. They are derivatives of the flow of the first variational equations, and as accurate as those of any flow.
class SecondOrderFlow {
public:
    /// @param tolerance, order as of ModeFlow. @throws InputError for a value out of range
    explicit SecondOrderFlow(const VariationalSystem& system, double tolerance, int order = 0);

    const VariationalSystem& system() const { return system_; }
    /// Sets the independent parameters, before `run`. @throws InputError for a wrong number of parameters
    void set_parameters(std::span<const double> parameters);
    std::span<const double> parameters() const { return parameters_; }

    /// @param state initial state, replaced by the final one (results are unspecified unless the ending is `done`)
    /// @param vector one component for each variable; those of states refer to the start
    /// @param derivatives of the final state at fixed time, states x variables, row by row
    /// @param second second derivatives contracted with the vector, in the same layout
    /// @throws InputError for a mode or numbers that do not match the system
    /// @throws OrderError before parameters are set
    ModeFlow::Ending run(std::size_t mode, std::span<double> state, double duration, std::span<const double> vector,
                         std::span<double> derivatives, std::span<double> second);

    std::size_t steps() const { return flow_.steps(); } ///< since construction

private:
    VariationalSystem system_;
    ModeFlow flow_;
    std::vector<double> parameters_;
    std::vector<double> inputs_, start_, rows_; ///< of the flow of the variational equations
};

} // namespace graze
