#pragma once

#include "graze/flow/mode_flow.hpp"
#include "graze/flow/variational_system.hpp"

#include <cstddef>
#include <span>
#include <vector>

namespace graze {

/// The smooth flow of one mode over a given time, as of ModeFlow, with its derivatives and its second derivatives
/// contracted with a vector: what Newton's method asks for where equations have derivatives in them, as those of folds
/// and other curves have.
///
/// With x(t) the state after a time, y = (x(0), p) the variables (states, then free parameters) and a vector v of
/// as many components, the second derivatives are those of the tangent x_y v with respect to y, at fixed v and time.
/// They are derivatives of the flow of the first variational equations, and so as accurate as those of any flow.
class SecondOrderFlow {
public:
    /// @param tolerance, order as of ModeFlow. @throws InputError for one that is out of range
    explicit SecondOrderFlow(const VariationalSystem& system, double tolerance, int order = 0);

    const VariationalSystem& system() const { return system_; }
    /// The independent parameters of the model, to be set before `run`. @throws InputError unless there are as many
    void set_parameters(std::span<const double> parameters);
    std::span<const double> parameters() const { return parameters_; }

    /// @param state start, replaced by the end (below, by what is not said where the ending is not `done`)
    /// @param vector one component for each variable; of states: at the start
    /// @param derivatives of the end at fixed time, states x variables, row by row
    /// @param second derivatives contracted with the vector, likewise
    /// @throws InputError for a mode or numbers that do not fit the system
    /// @throws OrderError before parameters are set
    ModeFlow::Ending run(std::size_t mode, std::span<double> state, double duration, std::span<const double> vector,
                         std::span<double> derivatives, std::span<double> second);

    std::size_t steps() const { return flow_.steps(); } ///< since it was made

private:
    VariationalSystem system_;
    ModeFlow flow_;
    std::vector<double> parameters_;
    std::vector<double> inputs_, start_, rows_; ///< of the variational equations
};

} // namespace graze
