#pragma once

#include "program/manual.hpp"

#include <string>
#include <vector>

namespace graze {

/// Values that completion offers for an option or an argument.
struct Choices {
    std::vector<std::string> words;
    bool files = false; ///< paths of files and folders too
};

/// The values that completion offers for an option or argument of a command.
Choices choices_for(const CLI::App& app, const CLI::App& command, const DeclaredOption& option);

/// Shells for which completion scripts can be made.
std::vector<std::string> completion_shells();
/// A script with which a shell completes all declared commands, options and values.
/// @throws InputError for an unknown shell
std::string completion_script(const CLI::App& app, const std::string& shell);

} // namespace graze
