#pragma once

#include <CLI/App.hpp>

#include <string>
#include <string_view>
#include <vector>

namespace graze {

/// An option or argument of a command, as it was declared.
struct DeclaredOption {
    std::string name;       ///< "--format", or of an argument "STUDY"
    std::string short_name; ///< "-h", or empty
    std::string value;      ///< word for its value, as "FORMAT"; empty: it takes no value
    std::string text, group;
    bool is_argument = false, required = false;
};

/// The options and arguments of a command that `--help` shows, arguments first.
std::vector<DeclaredOption> declared_options(const CLI::App& command);
/// All commands, in their order.
std::vector<const CLI::App*> declared_commands(const CLI::App& app);
/// The first line of a command's description.
std::string summary_of(const CLI::App& command);
/// The command of that name. @throws InputError, with the nearest name, when there is none
const CLI::App& command_named(const CLI::App& app, const std::string& name);

/// The text that `graze COMMAND --help` prints. @param command `app` itself gives the text of `graze --help`
std::string help_of(const CLI::App& app, const CLI::App& command);
/// The help as a manual page in roff. @param command `app` itself gives the page of the program
std::string manual_page(const CLI::App& app, const CLI::App& command);
/// Name of that page, as "graze-run"
std::string page_name(const CLI::App& app, const CLI::App& command);

} // namespace graze
