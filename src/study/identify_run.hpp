#pragma once

#include "graze/results/result_file.hpp"
#include "graze/study/fit_records.hpp"
#include "graze/study/study.hpp"

#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace graze {

/// What samples of a run of kind identify are: the number of the record, what is shown, and over what.
std::vector<std::string> residual_names(const IdentifyRequest& request);

/// What it finds besides fits, by its own names; of several records some numbers more.
std::vector<std::string> names_of_estimates(IdentifyRequest::What what);
/// All names of numbers that it may find under the names of parameters, as far as the study tells.
std::vector<std::string> names_found(const IdentifyRequest& request);

/// Records that other runs have kept. @throws InputError where one of these keeps no rows
std::vector<KeptRecord> kept_records(const StudyRun& run, const ResultFile& file);

/// What a run of kind identify has found.
struct FoundByRun {
    EstimateRecords estimates;
    PointRecord point;   ///< with what was measured, fitted, and is left
    std::string problem; ///< what makes it unfit to be gone on with; empty: nothing
};

/// A run of kind identify, from records and what other runs have found.
/// @param found by runs of StudyRun::parameters, in their order
/// @return nothing when it was interrupted
/// @throws InputError for records from which it cannot be found
std::optional<FoundByRun> identify(const StudyRun& run, const std::vector<KeptRecord>& records,
                                   const std::vector<EstimateRecords>& found, const std::function<bool()>& interrupted);

} // namespace graze
