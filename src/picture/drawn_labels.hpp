#pragma once

#include "graze/results/stored_run.hpp"

#include <string>
#include <string_view>
#include <vector>

namespace graze {

/// How a picture draws a motion with a label (of the enumeration Label).
enum class DrawnAs {
    attractor, ///< the motion has settled
    uncertain, ///< the motion has not settled: drawn as crosses, which the legend explains
    nothing    ///< the motion ended, is unbounded or failed: not drawn, but counted under the picture
};

/// @param label name of a Label, as in result files
DrawnAs drawn_as(std::string_view label);
/// True for runs whose points should be attractors: sweeps and basins.
bool seeks_attractors(const RunRecord& run);

/// A sentence with the numbers of points that are not drawn, by label; empty if all are drawn.
/// @param directions only points of these; empty: all
std::string note_of_left_out(const StoredRun& run, const std::vector<std::string>& directions);

/// The mark of points without an attractor, by their label: gnuplot's symbol for points, gnuplot's pattern for cells.
struct MarkOfLabel {
    std::size_t colour = 0;
    int symbol = 0, hatch = 0;
};
/// The mark of a label. @param label name of a Label
MarkOfLabel mark_of_label(std::string_view label);

} // namespace graze
