#pragma once

#include "program/arguments.hpp"
#include "program/program.hpp"

namespace graze {

/// Does the runs of kind `identify` of a study that are not done yet, with those that they need, beside the study's
/// other results; then shows what they have found. @throws InputError for what is no study, or has no such runs
int identify_study(const IdentifyArguments& arguments, const Console& console);

} // namespace graze
