#pragma once

#include "study/study_reader.hpp"

namespace graze {

// Readers of keys that have a form of their own, such as a table. They throw InputError, or InputErrors, with the
// places of mistakes.

void read_vary(const StudyReader& reader, StudyRun& run, const TomlEntry& entry);
void read_section(const StudyReader& reader, StudyRun& run, const TomlEntry& entry);
void read_bounds(const StudyReader& reader, StudyRun& run, const TomlEntry& entry);
void read_samplings(const StudyReader& reader, StudyRun& run, const TomlEntry& entry);
void read_values(const StudyReader& reader, StudyRun& run, const TomlEntry& entry);
void read_start(const StudyReader& reader, StudyRun& run, const TomlEntry& entry);
/// Runs of kind identify that find parameters.
void read_parameters(const StudyReader& reader, StudyRun& run, const TomlEntry& entry);
void read_skip(const StudyReader& reader, StudyRun& run, const TomlEntry& entry);
/// The ranges of initial states of an atlas.
void read_starts(const StudyReader& reader, StudyRun& run, const TomlEntry& entry);
/// The events whose contacts are counted.
void read_counted(const StudyReader& reader, StudyRun& run, const TomlEntry& entry);

void read_signature(const StudyReader& reader, StudyRun& run, const TomlEntry& entry);
/// The file with a motion near the first orbit.
/// The box in which equilibria are searched for.
void read_within(const StudyReader& reader, StudyRun& run, const TomlEntry& entry);
void read_orbit_table(const StudyReader& reader, StudyRun& run, const TomlEntry& entry);
void read_monitors(const StudyReader& reader, StudyRun& run, const TomlEntry& entry);
void read_along(const StudyReader& reader, StudyRun& run, const TomlEntry& entry);
void read_free(const StudyReader& reader, StudyRun& run, const TomlEntry& entry);
void read_stop(const StudyReader& reader, StudyRun& run, const TomlEntry& entry);
void read_point_names(const StudyReader& reader, StudyRun& run, const TomlEntry& entry);

void read_scales(const StudyReader& reader, StudyRun& run, const TomlEntry& entry);
/// What a virtual bench measures.
void read_bench_channels(const StudyReader& reader, StudyRun& run, const TomlEntry& entry);
/// The time range of a record that is kept.
void read_part(const StudyReader& reader, StudyRun& run, const TomlEntry& entry);
void read_filter(const StudyReader& reader, StudyRun& run, const TomlEntry& entry);
void read_derivative(const StudyReader& reader, StudyRun& run, const TomlEntry& entry);

void read_records(const StudyReader& reader, StudyRun& run, const TomlEntry& entry);
void read_gives(const StudyReader& reader, StudyRun& run, const TomlEntry& entry);
void read_unknowns(const StudyReader& reader, StudyRun& run, const TomlEntry& entry);
void read_readings(const StudyReader& reader, StudyRun& run, const TomlEntry& entry);
void read_known(const StudyReader& reader, StudyRun& run, const TomlEntry& entry);

// What these readers and those of whole runs have in common.

/// Whether an initial state of a run is an expression in what varies, which has another value at each point.
bool follows_what_varies(const StudyReader& reader, const StudyRun& run, const TomlEntry& item);
/// Reads these initial states, once the axes are known. @param from the table of initial states
/// @throws InputError for a state that varies itself, and for an expression in states that do not vary
void read_following_states(const StudyReader& reader, StudyRun& run, const TomlEntry& from);
/// @throws InputError when the initial states that follow from others are none that a study could ask for
void check_following_states(const StudyRun& run, const Place& place);
/// The key `bench` of a run of kind record, whose model is known.
void read_bench(const StudyReader& reader, StudyRun& run, const TomlEntry& entry);
/// The levels that the bench goes through, from what the run varies, which are then no axes of the run.
void set_levels(const StudyReader& reader, StudyRun& run, const TomlEntry& place);

} // namespace graze
