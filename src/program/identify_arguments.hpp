#pragma once

#include "program/arguments.hpp"

namespace graze {

/// What `graze identify fit --table` shows.
std::vector<std::string> fit_table_names();

/// The command that finds parameters from measured records: `identify`.
void declare_identify_command(CLI::App& app, Arguments& arguments);

} // namespace graze
