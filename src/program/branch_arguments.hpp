#pragma once

#include "program/arguments.hpp"

namespace graze {

/// The commands that look at branches of periodic orbits: `points` and `orbit`.
void declare_branch_commands(CLI::App& app, Arguments& arguments);

} // namespace graze
