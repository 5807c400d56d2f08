#pragma once

#include "program/arguments.hpp"
#include "program/program.hpp"

namespace graze {

/// The studies that come with graze. @return the exit code
int list_studies(const RunArguments& arguments, const Console& console);
/// The keys of runs of a kind, or of all kinds. @return the exit code
int list_study_keys(const RunArguments& arguments, const Console& console);

} // namespace graze
