#pragma once

#include "graze/sweep/attractor.hpp"
#include "graze/sweep/sampling.hpp"
#include "graze/trajectory/trajectory.hpp"

#include <memory>
#include <span>
#include <vector>

namespace graze {

/// What becomes of one initial state at one parameter value: a state machine that asks for its trajectory to be run,
/// looks at how it ended, and starts it anew or is done. Whoever drives it may run many at once in lanes.
class PointSearch {
public:
    virtual ~PointSearch() = default;
    /// Begins a point. @throws InputError for states or parameters that the model does not admit
    virtual void begin(std::span<const double> parameters, std::span<const double> state, std::size_t mode) = 0;
    // What follows is for after `begin`, in this order, and unchecked.
    /// The trajectory to be run to its end now; it stays at its address until the next `begin`.
    virtual Trajectory& trajectory() = 0;
    /// To be called when the trajectory has finished. @return false when `result` is known
    virtual bool proceed() = 0;
    /// Of the point just done; may be moved from.
    virtual PointResult& result() = 0;
};

/// Makes searches for one kind of run; shared by threads.
class SearchFactory {
public:
    virtual ~SearchFactory() = default;
    virtual const Simulation& simulation() const = 0;
    virtual std::unique_ptr<PointSearch> make() const = 0;
};

/// Looks for the attractor that an initial state leads to.
/// @param values what is sampled, in the model's symbols (states and parameters)
/// @throws InputError for options out of range and unknown sections
std::unique_ptr<SearchFactory> attractor_searches(const System& system, const AttractorOptions& options,
                                                  const std::vector<Sampling>& samplings,
                                                  const std::vector<Expression>& values,
                                                  const SimulationOptions& simulation);

/// Follows a motion for the time or count asked for, without looking for what it settles on.
std::unique_ptr<SearchFactory> transient_searches(const System& system, const TransientOptions& options,
                                                  const std::vector<Sampling>& samplings,
                                                  const std::vector<Expression>& values,
                                                  const SimulationOptions& simulation);

} // namespace graze
