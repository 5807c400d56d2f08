#pragma once

#include "study/study_reader.hpp"

#include <cstddef>
#include <vector>

namespace graze {

// What runs of motions say of where values are taken, and which.

/// @throws InputError for a section that the model does not have
std::size_t section_index(const StudyReader& reader, const Model& model, const TomlEntry& entry);
/// Those that are named, or all barriers. @throws InputError for one that the model does not have
std::vector<std::size_t> events_of(const StudyReader& reader, const Model& model, const TomlEntry& entry);
/// The key `sample`.
void read_samplings(const StudyReader& reader, StudyRun& run, const TomlEntry& entry);
/// The key `values`.
void read_values(const StudyReader& reader, StudyRun& run, const TomlEntry& entry);

} // namespace graze
