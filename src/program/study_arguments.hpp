#pragma once

#include "program/arguments.hpp"

namespace graze {

/// Declares the commands run, info, export and plot.
void declare_study_commands(CLI::App& app, Arguments& arguments);

} // namespace graze
