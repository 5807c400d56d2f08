#pragma once

#include "graze/sweep/point_search.hpp"

#include <cstddef>
#include <functional>
#include <optional>
#include <span>
#include <vector>

namespace graze {

/// Where a point begins.
struct PointStart {
    std::vector<double> parameters; ///< of the model, in its order
    std::vector<double> state;      ///< not used when it is carried over from the point before
    std::size_t mode = 0;
};

/// The points of a sweep, basin or ensemble: chains of equal length, within which states may be carried along.
/// Points are numbered chain after chain, and are made when they are needed.
struct Plan {
    std::size_t chains = 1;
    std::size_t chain_length = 1;
    /// Each point of a chain begins where the one before ended, if that was regular. Where that state violates a
    /// barrier the point begins at its start or, where that does too, at the nearest admissible state, and its outcome
    /// says so.
    bool carry = false;
    /// @param point number; must give the same whenever asked
    std::function<PointStart(std::size_t point)> start;

    std::size_t points() const { return chains * chain_length; }
};

/// What has been done of one chain in an earlier, interrupted execution.
struct ChainProgress {
    std::size_t done = 0;      ///< points
    bool regular = false;      ///< whether the last can be carried on from
    std::vector<double> state; ///< at its end
    std::size_t mode = 0;
};

struct ExecutionOptions {
    int jobs = 1; ///< threads
    InstructionSet instruction_set = best_instruction_set();
    /// Asked between points and legs of points, and every some hundred steps.
    std::function<bool()> interrupted{};
};

/// Whether the next point of a chain can begin where this one ended.
bool can_be_carried_on(const PointResult& result);

/// Runs the points of a plan on several threads, and in SIMD lanes within each. Results do not depend on either.
/// @param progress for each chain what is done already; empty: nothing
/// @param sink receives results, in order within each chain, with the number of the point and the start it had
/// @return false when it was stopped
/// @throws what a callback throws, after all threads have ended
bool execute(const Plan& plan, const SearchFactory& searches, std::span<const ChainProgress> progress,
             const ExecutionOptions& options,
             const std::function<void(std::size_t point, const PointStart& start, PointResult& result)>& sink);

} // namespace graze
