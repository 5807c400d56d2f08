#pragma once

#include "graze/model/model.hpp"
#include "graze/results/result_file.hpp"
#include "page/study_session.hpp"

#include <string>

namespace graze {

/// The result file of a session. @throws InputError if nothing has been computed yet
ResultFile present_results(const StudySession& session);

/// The record of a run. @throws InputError for an unknown run, with the nearest one
RunRecord stored_record(const ResultFile& file, const std::string& run);

/// A study that has the run: that of the session, or the one stored in the file.
std::shared_ptr<const Study> study_with_run(const StudySession& session, const ResultFile& file,
                                            const std::string& run);

/// The model of a run, computed or not. @param run empty: the model that was opened
/// @throws InputError for an unknown run
Model model_of_run(const StudySession& session, const std::string& run);

} // namespace graze
