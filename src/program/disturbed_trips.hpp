#pragma once

#include "graze/results/result_file.hpp"
#include "program/arguments.hpp"
#include "program/program.hpp"

namespace graze {

/// True when `graze trip` is asked about a parameter that changes in time.
bool is_disturbed(const TripArguments& arguments);

/// Prints the table or draws the picture of `graze trip` with --ramp, --wave or --noise. @return the exit code
/// @throws InputError as loss_point does, and for options that do not go together
int disturbed_trips(const ResultFile& file, const TripArguments& arguments, const Console& console);

} // namespace graze
