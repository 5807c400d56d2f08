#pragma once

#include "graze/sweep/attractor.hpp"
#include "graze/sweep/sampling.hpp"
#include "graze/trajectory/trajectory.hpp"

#include <cstddef>
#include <memory>
#include <span>
#include <vector>

namespace graze {

/// Determines the behaviour from one initial state at one parameter value: a state machine that provides a trajectory
/// to be run, examines how it ended, and starts it anew or is done. The caller may run many in lanes.
class PointSearch {
public:
    virtual ~PointSearch() = default;
    /// Begins a point. @throws InputError for invalid states or parameters
    virtual void begin(std::span<const double> parameters, std::span<const double> state, std::size_t mode) = 0;
    // The following functions must be called in this order after `begin`; this is not checked.
    /// Returns the trajectory to be run to its end now; its address is constant until the next `begin`.
    virtual Trajectory& trajectory() = 0;
    /// To be called when the trajectory has finished. @return false when `result` is available
    virtual bool proceed() = 0;
    /// Returns the result of the point; may be moved from.
    virtual PointResult& result() = 0;
};

/// Creates searches for one kind of run; shared by threads.
class SearchFactory {
public:
    virtual ~SearchFactory() = default;
    virtual const Simulation& simulation() const = 0;
    virtual std::unique_ptr<PointSearch> make() const = 0;
};

/// Creates searches for the attractor reached from an initial state.
/// @param values expressions to be sampled, in the model's symbols (states and parameters)
/// @throws InputError for options out of range and unknown sections
std::unique_ptr<SearchFactory> attractor_searches(const System& system, const AttractorOptions& options,
                                                  const std::vector<Sampling>& samplings,
                                                  const std::vector<Expression>& values,
                                                  const SimulationOptions& simulation);

/// Creates plain simulations over a given time or count, without a search for attractors.
std::unique_ptr<SearchFactory> transient_searches(const System& system, const TransientOptions& options,
                                                  const std::vector<Sampling>& samplings,
                                                  const std::vector<Expression>& values,
                                                  const SimulationOptions& simulation);

} // namespace graze
