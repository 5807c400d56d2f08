#pragma once

#include "program/arguments.hpp"
#include "program/program.hpp"

namespace graze {

/// Lists the shipped studies. @return the exit code
int list_studies(const RunArguments& arguments, const Console& console);
/// Lists the keys of runs of a kind, or of all kinds. @return the exit code
int list_study_keys(const RunArguments& arguments, const Console& console);

} // namespace graze
