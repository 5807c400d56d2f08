#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace graze {

/// What a run of a study computes.
enum class RunKind {
    simulate,    ///< one motion of given duration
    sweep,       ///< the attractors of motions as a parameter changes step by step
    basin,       ///< the attractors of motions from many initial states
    orbit,       ///< one periodic orbit
    equilibrium, ///< one equilibrium, or all in a box of states
    follow,      ///< a branch of periodic orbits or equilibria; called "continue" in studies and results
    curve,       ///< a curve of special points in two parameters
    ladder,      ///< a sequence of grazing orbits, each found from the one before
    torus,       ///< the tori that begin at a torus point of a branch
    record,      ///< measured records
    identify,    ///< parameters fitted to measured records
    atlas        ///< a sweep over a box of parameters, from which an exploration of all branches and curves begins
};

/// The names of all kinds, in the order of RunKind.
const std::vector<std::string>& kinds_of_runs();
/// The name of a kind; "unknown" for a number outside the enumeration.
std::string_view name_of(RunKind kind);
/// The kind with this name; nothing if there is none.
std::optional<RunKind> run_kind(std::string_view name);

/// Whether the points of runs of this kind are simulated motions.
bool has_motions(RunKind kind);
/// Whether each of these motions is followed until it has settled on an attractor, rather than for a given time.
bool seeks_attractors(RunKind kind);
/// Whether motions are carried along the first varied value, in one direction or both.
bool is_swept(RunKind kind);
/// Whether runs of this kind follow orbits or tori along a branch, a curve or a ladder.
bool is_followed(RunKind kind);
/// Whether the points of runs of this kind are periodic orbits or equilibria.
bool is_branch(RunKind kind);
/// Whether the points of runs of this kind are measured records or results of fits to them.
bool is_measured(RunKind kind);

} // namespace graze
