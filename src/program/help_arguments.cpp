#include "program/help_arguments.hpp"

#include "program/commands.hpp"

namespace graze {

namespace {

constexpr const char* help_text = R"(Explain how to use graze, or one of its commands.
The same as graze COMMAND --help. An installation also has manual pages, such as man graze-run.)";

constexpr const char* help_examples = R"(Examples:
  graze help
  graze help run
  graze help run --man > graze-run.1     a manual page
  graze help --write man1                manual pages of all commands)";

constexpr const char* completion_text = R"(Print a script with which a shell completes commands, options and names.
SHELL is bash, zsh or fish. An installation has these scripts already.)";

constexpr const char* completion_examples = R"(Examples:
  graze completion bash > ~/.local/share/bash-completion/completions/graze
  graze completion zsh --output _graze                      into a folder of fpath
  graze completion fish > ~/.config/fish/completions/graze.fish)";

} // namespace

void declare_help_commands(CLI::App& app, Arguments& arguments) {
    CLI::App& help = *app.add_subcommand("help", help_text);
    help.footer(help_examples);
    arguments.commands["help"] = [&](const Console& console) { return help_command(app, arguments.help, console); };
    help.add_option("COMMAND", arguments.help.command, "The command to explain (the program)")->type_name("");
    help.add_flag("--man", arguments.help.man, "Print a manual page for man");
    help.add_option("--write", arguments.help.folder, "Write the manual pages of all commands into this folder")
        ->type_name("FOLDER");
    CLI::App& completion = *app.add_subcommand("completion", completion_text);
    completion.footer(completion_examples);
    arguments.commands["completion"] = [&](const Console& console) {
        return completion_command(app, arguments.completion, console);
    };
    completion.add_option("SHELL", arguments.completion.shell, "bash, zsh or fish")->type_name("")->required();
    completion
        .add_option("--output", arguments.completion.file, "Write the script to FILE instead of to standard output")
        ->type_name("FILE");
}

} // namespace graze
