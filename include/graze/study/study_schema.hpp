#pragma once

#include <string>

namespace graze {

/// What a study may consist of, as a JSON Schema (draft 7): editors complete and check from it what is typed, and show
/// what keys mean. Its runs have the keys of `study_keys`.
std::string study_schema();

} // namespace graze
