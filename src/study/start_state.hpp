#pragma once

#include "graze/study/study.hpp"
#include "study/study_reader.hpp"

namespace graze {

/// Whether an initial state of a run is an expression in what varies, which has another value at each point.
bool follows_what_varies(const StudyReader& reader, const StudyRun& run, const TomlEntry& item);

/// Reads these initial states, once the axes are known. @param from the table of initial states
/// @throws InputError for a state that varies itself, and for an expression in states that do not vary
void read_following_states(const StudyReader& reader, StudyRun& run, const TomlEntry& from);

/// @throws InputError when the initial states that follow from others are none that a study could ask for
void check_following_states(const StudyRun& run, const Place& place);

} // namespace graze
