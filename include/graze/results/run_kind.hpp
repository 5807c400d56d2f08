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
    identify  ///< parameters from them
};

/// The names of all kinds, in the order of RunKind.
const std::vector<std::string>& kinds_of_runs();
/// The name of a kind; "unknown" for what is none.
std::string_view name_of(RunKind kind);
/// The kind of this name.
std::optional<RunKind> run_kind(std::string_view name);

/// Whether points of runs of a kind are motions: simulated from a state, alone or many of them.
bool has_motions(RunKind kind);
/// Whether orbits are followed: along a branch, a curve or a ladder.
bool is_followed(RunKind kind);
/// Whether points are periodic orbits.
bool is_branch(RunKind kind);
/// Whether points are records, or what was found from them: such runs simulate nothing themselves.
bool is_measured(RunKind kind);

} // namespace graze
