#pragma once

#include "graze/identify/fit.hpp"
#include "graze/record/samples.hpp"
#include "graze/study/study.hpp"

#include <string>
#include <vector>

namespace graze {

/// A record that is in memory.
struct KeptRecord {
    std::string name; ///< for messages
    RecordHeader header;
    Samples samples;
    /// What is known of this record alone, such as the averaged amplitude of its reference.
    ParameterValues known;
};

/// A fit, with what it was made from.
struct FitOfRecords {
    FitTask task;
    std::vector<Channel> channels; ///< of the records, one for each output of the task
    Fit fit;                       ///< offsets are in the units of their channels
};

/// Fits the model of a run of kind identify to records, all of them at once. What is known of a record and is no
/// parameter of the model is passed over.
/// @param settings besides loss and piece, which are those of the run
/// @throws InputError for tasks without meaning (fit_model), for records of fewer than two rows, and for those whose
///         units agree neither with one another nor with the model's
FitOfRecords fit_records(const StudyRun& run, const std::vector<KeptRecord>& records, FitSettings settings = {});

} // namespace graze
