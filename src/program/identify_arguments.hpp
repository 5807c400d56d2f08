#pragma once

#include "program/arguments.hpp"

namespace graze {

/// Values of `graze identify fit --table`.
std::vector<std::string> fit_table_names();

/// Declares `graze identify`.
void declare_identify_command(CLI::App& app, Arguments& arguments);

} // namespace graze
