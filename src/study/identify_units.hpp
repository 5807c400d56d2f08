#pragma once

#include "graze/record/samples.hpp"
#include "graze/results/result_file.hpp"
#include "graze/study/study.hpp"

#include <string>

namespace graze {

/// Numbers that a calculation takes from a model and from records at once must be in the same units: displacements of
/// couplings, all channels and times of leakage inductances, times where a frequency is given. What the model or the
/// record does not say is taken to agree.
/// @param header of one of the records
/// @throws InputError without a place for the record, with the scale that makes it agree
void check_record_units(const StudyRun& run, const RecordHeader& header);
/// The same of its time alone.
void check_record_time(const StudyRun& run, const RecordHeader& header);
/// How to bring a channel into a unit, in the words of a study.
std::string scale_remedy(const Channel& channel, const std::string& unit);

/// Gives estimates of parameters of the run's model the units of these, their covariances as well: 0.1 rad/ms is
/// 100 rad/s, and a frequency of 1 Hz is 2 pi rad/s. Other estimates stay as they are, and units that one of both does
/// not say are taken to agree.
/// @throws InputError for units that measure different things, and for one of an estimate that is not known
void convert_to_model(EstimateRecords& estimates, const StudyRun& run);

} // namespace graze
