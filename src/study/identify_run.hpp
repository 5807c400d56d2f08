#pragma once

#include "graze/results/result_file.hpp"
#include "graze/study/fit_records.hpp"
#include "graze/study/study.hpp"

#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace graze {

/// Names of the values of the samples of a run of kind identify: the number of the record, the abscissa and the
/// ordinate.
std::vector<std::string> residual_names(const IdentifyRequest& request);

/// Names of all numbers that a run may find, under the names of parameters where the study gives them.
std::vector<std::string> names_found(const IdentifyRequest& request);

/// The records of the runs IdentifyRequest::records. @throws InputError where one of these keeps no rows
std::vector<KeptRecord> kept_records(const StudyRun& run, const ResultFile& file);

/// The result of a run of kind identify.
struct FoundByRun {
    EstimateRecords estimates;
    PointRecord point;   ///< whose samples are the measured curve, the fitted one and the residuals
    std::string problem; ///< why the estimates must not be used by other runs; empty: they may be used
};

/// Carries out a run of kind identify. @param found estimates of the runs StudyRun::parameters, in their order
/// @return nothing when it was interrupted
/// @throws InputError for records from which the estimate cannot be made
std::optional<FoundByRun> identify(const StudyRun& run, const std::vector<KeptRecord>& records,
                                   const std::vector<EstimateRecords>& found, const std::function<bool()>& interrupted);

} // namespace graze
