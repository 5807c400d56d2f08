#pragma once

#include "graze/layout/process_spread.hpp"
#include "study/study_reader.hpp"

namespace graze {

/// Reads [spread]. @throws InputErrors with places for several errors, or InputError
ProcessSpread read_spread(const StudyReader& reader, const TomlEntry& entry);

} // namespace graze
