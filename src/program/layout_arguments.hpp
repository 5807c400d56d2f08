#pragma once

#include "program/arguments.hpp"

namespace graze {

/// Declares `graze layout`.
void declare_layout_command(CLI::App& app, Arguments& arguments);

} // namespace graze
