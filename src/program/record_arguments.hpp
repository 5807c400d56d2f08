#pragma once

#include "program/arguments.hpp"

namespace graze {

/// Options that say what is read of a record.
void declare_reading(CLI::App& command, RecordArguments& arguments);

/// The command that looks at measured records: `record`.
void declare_record_commands(CLI::App& app, Arguments& arguments);

} // namespace graze
