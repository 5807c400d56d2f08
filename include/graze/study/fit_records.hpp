#pragma once

#include "graze/identify/fit.hpp"
#include "graze/record/samples.hpp"
#include "graze/study/study.hpp"

#include <string>
#include <vector>

namespace graze {

/// A record in memory.
struct KeptRecord {
    std::string name; ///< for messages
    RecordHeader header;
    Samples samples;
    /// Values that belong to this record alone, such as the averaged amplitude of its reference.
    ParameterValues known;
};

/// A fit, with the task and the channels from which it was made.
struct FitOfRecords {
    FitTask task;
    std::vector<Channel> channels; ///< of the records, one for each output of the task
    Fit fit;                       ///< offsets are in the units of their channels
};

/// Fits the model of a run of kind identify to all records at once. Values of a record that are not parameters of the
/// model are ignored.
/// @param settings loss, piece and simulation are replaced by those of the run
/// @throws InputError for tasks without meaning (fit_model), for records of fewer than two rows, and for those whose
///         units agree neither with one another nor with the model's
FitOfRecords fit_records(const StudyRun& run, const std::vector<KeptRecord>& records, FitSettings settings = {});

} // namespace graze
