#pragma once

#include "study/study_reader.hpp"

namespace graze {

/// The key `bench` of a run of kind record, whose model is known.
void read_bench(const StudyReader& reader, StudyRun& run, const TomlEntry& entry);

/// The levels that the bench goes through, from what the run varies, which are then no axes of the run.
void set_levels(const StudyReader& reader, StudyRun& run, const TomlEntry& place);

} // namespace graze
