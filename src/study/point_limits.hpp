#pragma once

namespace graze {

// How much a run may ask for.

/// Points: more would take months.
constexpr double most_points = 1e9;
/// Points that begin by themselves, of each of which something is kept in memory.
constexpr double most_chains = 2e7;
/// Digits to which located points of a branch are the same, with some reserve: relative to what is compared.
constexpr double same_point = 1e-6;

} // namespace graze
