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
/// The events whose contacts are counted.
void read_counted(const StudyReader& reader, StudyRun& run, const TomlEntry& entry);

void read_signature(const StudyReader& reader, StudyRun& run, const TomlEntry& entry);
/// The file with a motion near the first orbit.
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

} // namespace graze
