#pragma once

#include "graze/results/result_file.hpp"
#include "graze/study/runner.hpp"

#include <cstddef>
#include <string>
#include <utility>
#include <vector>

namespace graze {

/// How many points have which label, such as "periodic", or of branches of which type special points are, such as "GR".
using LabelCounts = std::vector<std::pair<std::string, std::size_t>>;

/// What there is to say of a run that has been carried out.
struct RunSummary {
    LabelCounts labels;
    std::string remedy;                                    ///< or what went wrong
    std::vector<std::pair<std::string, std::string>> ends; ///< of the parts of a branch: what their last points say
    std::string escapes; ///< the rate at which motions leave a transient, if there is one
};

RunSummary summary_of(const RunReport& report, const ResultFile& file);

} // namespace graze
