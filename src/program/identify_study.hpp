#pragma once

#include "program/arguments.hpp"
#include "program/program.hpp"

namespace graze {

/// Computes the runs of kind `identify` of a study that have no results yet, and the runs they depend on, into the
/// study's result file; then shows their estimates. @throws InputError if it is not a study or has no such runs
int identify_study(const IdentifyArguments& arguments, const Console& console);

} // namespace graze
