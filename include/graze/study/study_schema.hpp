#pragma once

#include <string>

namespace graze {

/// Returns a JSON Schema (draft 7) of study files, with which editors complete and check keys and show what they mean.
/// Its runs have the keys of `study_keys`.
std::string study_schema();

} // namespace graze
