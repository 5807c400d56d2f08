#pragma once

#include "graze/study/study.hpp"
#include "study/shared_file.hpp"

#include <functional>

namespace graze {

/// A copy of a run whose parameters have the values that the runs StudyRun::parameters have found. Each of these counts
/// as set by the run itself (StudyRun::set).
/// @throws InputError when one has found no parameter of the run's model
StudyRun with_parameters_found(const StudyRun& run, const ResultFile& file);

/// The same for runs of kind record or identify, with the units that only records tell.
StudyRun measured_run(const StudyRun& run, const ResultFile& file);

/// Carries out a run of kind record or identify and stores its results. Records that the file has are skipped.
/// @param run as `measured_run` returns it
/// @param told called with each point: whether it was computed now
/// @return false when it was interrupted
/// @throws InputError when it cannot be carried out, or when its estimates must not be used by other runs
bool run_measured(const StudyRun& run, SharedFile& file, const std::function<bool()>& interrupted,
                  const std::function<void(bool computed)>& told);

} // namespace graze
