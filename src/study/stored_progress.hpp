#pragma once

#include "graze/study/run_part.hpp"

#include <cstddef>

namespace graze {

// What a result file has of a run that is asked for.

/// The points of the chains that the file has.
/// @param done is increased by their number
KnownChains progress_of(const ResultFile& file, const PartedRun& parted, std::size_t& done);

/// True when a run ended without finding all orbits: it would fail again.
bool lacks_orbits(const RunRecord& run, const ResultFile& file);

/// Why a run has failed, to let it fail in another file in the same words.
InputError failure_of(const RunRecord& run);

/// True when the file has the complete run as it is asked for now. Otherwise begins it, or reopens it if it can be
/// continued.
bool is_done(const RunRecord& record, ResultFile& file);

} // namespace graze
