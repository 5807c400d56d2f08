#pragma once

#include "program/arguments.hpp"
#include "program/program.hpp"

namespace graze {

/// Carries out `graze identify fit`. @return exit_success if the fit converged and passed its checks. @throws
/// InputError
int identify_fit(const IdentifyArguments& arguments, const Console& console);

} // namespace graze
