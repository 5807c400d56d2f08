#pragma once

#include "graze/results/result_file.hpp"
#include "graze/study/study.hpp"

#include <set>
#include <string>

namespace graze {

/// The runs of a study whose stored results are those of other settings, another model, or other runs that they need:
/// run_study would compute them anew. A run without results is none of them.
std::set<std::string> outdated_runs(const Study& study, const ResultFile& file);

} // namespace graze
