#pragma once

#include "graze/study/part_exchange.hpp"

#include <functional>
#include <memory>
#include <string>
#include <string_view>

namespace graze {

// A run of orbits, records or estimates can be computed by any process as a whole: it is given a result file, in bytes,
// with the study and the runs that this one needs, and returns a result file with the run.

/// Whether these are bytes of a run that is computed as a whole, by how they begin.
bool is_whole_run(std::string_view text);

/// Computes the run that `text` names, of the same version of graze, with one thread.
/// @param needed bytes of a result file
/// @return bytes of a result file with the run, complete or failed; empty: it was interrupted
/// @throws InputError when the bytes are none of those, and as run_study
std::string computed_run(std::string_view text, const std::string& needed, const std::function<bool()>& interrupted);

/// For run_study: has runs computed as a whole by whoever empties the exchange.
/// @param results path of the file with the runs that others need
ResultsElsewhere results_by(const std::shared_ptr<PartExchange>& parts, const Study& study, const std::string& results);

} // namespace graze
