#pragma once

#include "graze/results/result_file.hpp"
#include "graze/study/runner.hpp"

#include <cstddef>
#include <string>
#include <utility>
#include <vector>

namespace graze {

/// Number of points with each label, such as "periodic"; of branches number of special points of each type, such as
/// "GR".
using LabelCounts = std::vector<std::pair<std::string, std::size_t>>;

/// A summary of a run that has been carried out.
struct RunSummary {
    LabelCounts labels;
    std::string remedy; ///< what to do about points that failed; of a failed run its problem
    std::vector<std::pair<std::string, std::string>> ends; ///< of each part of a branch: name, and why it ends
    std::string escapes; ///< the rate at which motions leave a chaotic transient; empty: there is none
};

RunSummary summary_of(const RunReport& report, const ResultFile& file);

} // namespace graze
