#pragma once

#include "program/arguments.hpp"

namespace graze {

/// Declares `graze help` and `graze completion`.
void declare_help_commands(CLI::App& app, Arguments& arguments);

} // namespace graze
