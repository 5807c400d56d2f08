#pragma once

#include "graze/sweep/known_chains.hpp"
#include "graze/sweep/point_search.hpp"

#include <atomic>
#include <cstddef>
#include <functional>
#include <vector>

namespace graze {

/// The initial values of a point.
struct PointStart {
    std::vector<double> parameters; ///< independent parameters, in the order of the model
    std::vector<double> state;      ///< not used if the state is carried over from the point before
    std::size_t mode = 0;
};

/// The points of a sweep, basin or ensemble: chains of equal length, within which states may be carried along. Points
/// are numbered chain after chain, and are generated when needed.
struct Plan {
    std::size_t chains = 1;
    std::size_t chain_length = 1;
    /// If true, each point of a chain starts at the final state of the point before, if that ended regularly. If this
    /// state violates a barrier, the point starts at its own initial state or, if that violates a barrier too, at the
    /// nearest admissible state; its outcome reports this.
    bool carry = false;
    /// @param point number; the function must be deterministic and callable from any thread
    std::function<PointStart(std::size_t point)> start;

    std::size_t points() const { return chains * chain_length; }
};

struct ExecutionOptions {
    int jobs = 1; ///< number of threads
    InstructionSet instruction_set = best_instruction_set();
    const std::atomic<bool>* stop = nullptr; ///< stops the execution when true; read between points and legs of points
    /// The same as a function; called from any thread.
    std::function<bool()> interrupted{};
};

/// Returns whether the next point of a chain can start from the final state of this one.
bool can_be_carried_on(const PointResult& result);

/// Runs the points of a plan on several threads, and in SIMD lanes within each. Results do not depend on either.
/// @param known what is completed
/// @param sink receives results, in order within each chain; called by one thread at a time, with the number of the
/// point and its initial values
/// @return false if the execution was stopped
/// @throws what `sink` throws, after all threads have ended
bool execute(const Plan& plan, const SearchFactory& searches, const KnownChains& known, const ExecutionOptions& options,
             const std::function<void(std::size_t point, const PointStart& start, PointResult& result)>& sink);

} // namespace graze
