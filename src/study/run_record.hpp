#pragma once

#include "graze/results/result_file.hpp"
#include "graze/study/study.hpp"

#include <cstddef>
#include <string>

namespace graze {

/// What results keep of a run besides its points.
/// @param parent_fingerprint of the runs that it needs
/// @param points planned
RunRecord record_of(const StudyRun& run, const std::string& parent_fingerprint, std::size_t points);

} // namespace graze
