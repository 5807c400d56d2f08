#pragma once

#include "graze/identify/identification.hpp"
#include "program/arguments.hpp"
#include "program/program.hpp"

namespace graze {

/// What the estimates that are no fits find in the records that are asked for. @throws InputError
Identification identify_from_files(const IdentifyArguments& arguments, const Console& console);

} // namespace graze
