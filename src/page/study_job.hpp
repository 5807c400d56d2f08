#pragma once

#include "page/job_queue.hpp"
#include "page/study_session.hpp"

#include <string>
#include <vector>

namespace graze {

/// Computes runs of a study, with those that they need, and stores them in its result file, which nobody else may write
/// meanwhile.
/// @throws InputError when the file cannot be written, and when its results are of other values of parameters
JobEnd compute_runs(const StudySession& session, const std::vector<std::string>& runs, const JobControl& control,
                    int threads);

} // namespace graze
