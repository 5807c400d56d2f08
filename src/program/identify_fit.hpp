#pragma once

#include "program/arguments.hpp"
#include "program/program.hpp"

namespace graze {

/// Fits a model to records. @return exit_success for a fit that has converged and was checked. @throws InputError
int identify_fit(const IdentifyArguments& arguments, const Console& console);

} // namespace graze
