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
    std::string value;      ///< what follows it, as "FORMAT"; empty: nothing
    std::string text, group;
    bool is_argument = false, required = false;
};

/// Those that `--help` shows, in their order.
std::vector<DeclaredOption> declared_options(const CLI::App& command);
/// All commands, in their order.
std::vector<const CLI::App*> declared_commands(const CLI::App& app);
/// The first line of its description.
std::string summary_of(const CLI::App& command);
/// The command of that name. @throws InputError when there is none, with the nearest
const CLI::App& command_named(const CLI::App& app, const std::string& name);

/// What `graze COMMAND --help` prints. @param command `app` itself: what `graze --help` does
std::string help_of(const CLI::App& app, const CLI::App& command);
/// The same as a page for `man`. @param command `app` itself: the page of the program
std::string manual_page(const CLI::App& app, const CLI::App& command);
/// What that page is called: "graze-run"
std::string page_name(const CLI::App& app, const CLI::App& command);

} // namespace graze
