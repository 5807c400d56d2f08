#pragma once

#include "program/manual.hpp"

#include <string>
#include <vector>

namespace graze {

/// What may stand behind an option, or for an argument, of a command.
struct Choices {
    std::vector<std::string> words;
    bool files = false; ///< also, or only, files and folders
};

Choices choices_for(const CLI::App& app, const CLI::App& command, const DeclaredOption& option);

/// Shells that can complete commands.
std::vector<std::string> completion_shells();
/// A script by which a shell completes the commands, options and values that are declared.
/// @throws InputError for a shell that it is not known of
std::string completion_script(const CLI::App& app, const std::string& shell);

} // namespace graze
