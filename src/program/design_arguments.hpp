#pragma once

#include "program/arguments.hpp"

namespace graze {

/// Declares `graze design`.
void declare_design_command(CLI::App& app, Arguments& arguments);

} // namespace graze
