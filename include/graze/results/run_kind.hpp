#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace graze {

/// What a run of a study computes.
enum class RunKind {
    simulate, ///< motions for a time
    sweep,    ///< what motions settle on as a parameter changes
    basin,    ///< what they settle on from many states
    orbit,    ///< one periodic orbit
    follow,   ///< a branch of them; called "continue" in studies and results
    curve,    ///< special points in two parameters
    ladder,   ///< from one grazing to the next
    record,   ///< measured records
    identify  ///< parameters from records
};

/// The names of all kinds, in the order of RunKind.
const std::vector<std::string>& kinds_of_runs();
/// The name of a kind; "unknown" for what is none.
std::string_view name_of(RunKind kind);
/// The kind of this name.
std::optional<RunKind> run_kind(std::string_view name);

/// True when the points of runs of a kind are motions that are simulated from a state.
bool has_motions(RunKind kind);
/// True when each of these motions is followed until it has settled on an attractor, rather than for a given time.
bool seeks_attractors(RunKind kind);
/// True when orbits are followed along a branch, a curve or a ladder.
bool is_followed(RunKind kind);
/// True when the points are periodic orbits.
bool is_branch(RunKind kind);
/// True when the points are records, or estimates from records: such runs simulate nothing themselves.
bool is_measured(RunKind kind);

} // namespace graze
