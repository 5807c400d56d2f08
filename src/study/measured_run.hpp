#pragma once

#include "graze/study/study.hpp"
#include "study/shared_file.hpp"

#include <functional>

namespace graze {

/// A run with the parameters that runs of kind identify have found, in the place of those that are set. Each of them
/// counts as set by the run itself where it starts from another.
/// @throws InputError when one has found no parameter of the run's model
StudyRun with_parameters_found(const StudyRun& run, const ResultFile& file);

/// The same, with units that only records tell.
StudyRun measured_run(const StudyRun& run, const ResultFile& file);

/// Does a run of kind record or identify, and keeps what it gives. Records that the file has are passed over.
/// @param run as `measured_run` gives it
/// @param told of each point: whether it was computed
/// @return false when it was interrupted
/// @throws InputError when it cannot be done, or what is found must not be gone on with
bool run_measured(const StudyRun& run, SharedFile& file, const std::function<bool()>& interrupted,
                  const std::function<void(bool computed)>& told);

} // namespace graze
