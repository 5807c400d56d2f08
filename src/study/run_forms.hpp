#pragma once

#include "study/study_reader.hpp"

namespace graze {

// Keys of a run that have a form of their own, such as a table. Each @throws InputError, or InputErrors, with the place
// of what is wrong.

void read_vary(const StudyReader& reader, StudyRun& run, const TomlEntry& entry);
void read_section(const StudyReader& reader, StudyRun& run, const TomlEntry& entry);
void read_bounds(const StudyReader& reader, StudyRun& run, const TomlEntry& entry);
void read_samplings(const StudyReader& reader, StudyRun& run, const TomlEntry& entry);
void read_values(const StudyReader& reader, StudyRun& run, const TomlEntry& entry);
void read_start(const StudyReader& reader, StudyRun& run, const TomlEntry& entry);
/// Runs that find parameters.
void read_parameters(const StudyReader& reader, StudyRun& run, const TomlEntry& entry);
void read_skip(const StudyReader& reader, StudyRun& run, const TomlEntry& entry);
/// Events whose contacts count.
void read_counted(const StudyReader& reader, StudyRun& run, const TomlEntry& entry);

void read_signature(const StudyReader& reader, StudyRun& run, const TomlEntry& entry);
/// The file of a motion.
void read_orbit_table(const StudyReader& reader, StudyRun& run, const TomlEntry& entry);
void read_monitors(const StudyReader& reader, StudyRun& run, const TomlEntry& entry);
void read_along(const StudyReader& reader, StudyRun& run, const TomlEntry& entry);
void read_free(const StudyReader& reader, StudyRun& run, const TomlEntry& entry);
void read_stop(const StudyReader& reader, StudyRun& run, const TomlEntry& entry);
void read_step(const StudyReader& reader, StudyRun& run, const TomlEntry& entry);
void read_point_names(const StudyReader& reader, StudyRun& run, const TomlEntry& entry);

void read_lines(const StudyReader& reader, StudyRun& run, const TomlEntry& entry);
void read_scales(const StudyReader& reader, StudyRun& run, const TomlEntry& entry);
/// The part of a record that is kept.
void read_part(const StudyReader& reader, StudyRun& run, const TomlEntry& entry);
void read_filter(const StudyReader& reader, StudyRun& run, const TomlEntry& entry);
void read_derivative(const StudyReader& reader, StudyRun& run, const TomlEntry& entry);

void read_records(const StudyReader& reader, StudyRun& run, const TomlEntry& entry);
void read_gives(const StudyReader& reader, StudyRun& run, const TomlEntry& entry);
void read_noise(const StudyReader& reader, StudyRun& run, const TomlEntry& entry);
void read_unknowns(const StudyReader& reader, StudyRun& run, const TomlEntry& entry);
void read_readings(const StudyReader& reader, StudyRun& run, const TomlEntry& entry);
void read_known(const StudyReader& reader, StudyRun& run, const TomlEntry& entry);

} // namespace graze
