#pragma once

#include "graze/identify/identification.hpp"
#include "graze/results/result_file.hpp"
#include "graze/study/study.hpp"

#include <cstddef>
#include <vector>

namespace graze {

/// The estimates of a run of kind identify other than a fit, in the units of the records. Records are read part by
/// part.
/// @param count number of records
/// @param found estimates of the runs StudyRun::parameters, whose errors propagate to numbers that depend on them
/// @throws InputError for records from which the estimate cannot be made, and for units that do not agree with those of
///         the model
Identification identify_records(const StudyRun& run, const EachRecord& records, std::size_t count,
                                const std::vector<EstimateRecords>& found = {});

} // namespace graze
