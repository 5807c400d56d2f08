#include "program/commands.hpp"
#include "program/completion.hpp"
#include "program/manual.hpp"
#include "program/output_file.hpp"

#include <filesystem>

namespace graze {

namespace {

void write_pages(const CLI::App& app, const std::string& folder, const Console& console) {
    make_folder(folder, "--write");
    std::vector<const CLI::App*> all = declared_commands(app);
    all.insert(all.begin(), &app);
    for (const CLI::App* command : all) {
        const std::string path = (std::filesystem::path(folder) / (page_name(app, *command) + ".1")).string();
        write_file(path, manual_page(app, *command));
        console.out << path << '\n';
    }
}

} // namespace

int help_command(const HelpArguments& arguments, const Console& console) {
    const CLI::App& app = *arguments.app;
    if (!arguments.folder.empty()) {
        write_pages(app, arguments.folder, console);
        return exit_success;
    }
    const CLI::App& command = arguments.command.empty() ? app : command_named(app, arguments.command);
    console.out << (arguments.man ? manual_page(app, command) : help_of(app, command));
    return exit_success;
}

int completion_command(const CompletionArguments& arguments, const Console& console) {
    const std::string script = completion_script(*arguments.app, arguments.shell);
    if (arguments.file.empty())
        console.out << script;
    else
        write_file(arguments.file, script);
    return exit_success;
}

} // namespace graze
