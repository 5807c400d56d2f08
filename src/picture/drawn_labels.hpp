#pragma once

#include "graze/results/stored_run.hpp"

#include <string>
#include <string_view>
#include <vector>

namespace graze {

/// What a picture makes of a motion's label: only what settled is drawn as an attractor.
enum class DrawnAs {
    attractor,
    uncertain, ///< it goes on but has not settled: crosses, whose meaning the legend says
    nothing    ///< it ended, ran away or failed: counted under the picture
};

/// @param label as results have it
DrawnAs drawn_as(std::string_view label);
/// Whether a run's points are meant to be attractors: those of sweeps and basins.
bool seeks_attractors(const RunRecord& run);

/// How many points of a run are not drawn as attractors, by their labels, as a sentence; empty when all are.
/// @param directions only those; empty: all
std::string note_of_left_out(const StoredRun& run, const std::vector<std::string>& directions);

/// How points without an attractor are told apart: by gnuplot's symbol where they are points, its pattern where they
/// are cells.
struct MarkOfLabel {
    std::size_t colour = 0;
    int symbol = 0, hatch = 0;
};
MarkOfLabel mark_of_label(std::string_view label);

} // namespace graze
