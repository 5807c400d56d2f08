#pragma once

#include "graze/identify/identification.hpp"
#include "graze/results/result_file.hpp"
#include "graze/study/study.hpp"

#include <cstddef>
#include <vector>

namespace graze {

/// What a run of kind identify that is no fit finds in records, in their units. Records are read part by part.
/// @param count how many records there are
/// @param found by the runs of StudyRun::parameters: their errors count in numbers that depend on them
/// @throws InputError for records from which it cannot be found, and for those whose units do not agree with the
///         model's
Identification identify_records(const StudyRun& run, const EachRecord& records, std::size_t count,
                                const std::vector<EstimateRecords>& found = {});

} // namespace graze
