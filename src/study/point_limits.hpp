#pragma once

#include <cstddef>

namespace graze {

// How much a run may ask for.

/// Points: more would take months.
constexpr double most_points = 1e9;
/// Points that begin by themselves, of each of which something is kept in memory.
constexpr double most_rows = 2e7;
/// Runs of a study, each of which is in memory with its model, and has tables of its own in the result file.
constexpr std::size_t most_runs = 10'000;
/// Values along one axis.
constexpr std::size_t most_values = 10'000'000;
/// Samples of a record that a virtual bench makes, which are in memory.
constexpr double most_bench_samples = 1e7;
constexpr double most_bench_records = 1e6;
/// Steps along a branch, each of which stores an orbit.
constexpr std::size_t most_branch_steps = 10'000'000;
/// Grazings of a ladder: each is many steps, and their distances fall below round-off long before.
constexpr std::size_t most_rungs = 1000;
/// Digits to which located points of a branch are the same, with some reserve: relative to what is compared.
constexpr double same_point = 1e-6;

} // namespace graze
