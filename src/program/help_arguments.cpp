#include "program/command_line.hpp"

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

void declare_help_commands(CommandLine& line) {
    auto [of_help, help] = line.command("help", help_text, help_examples, help_command);
    help.app = &line.app;
    of_help.add("[COMMAND]", help.command, "The command to explain (the program)");
    of_help.add("--man", help.man, "Print a manual page for man");
    of_help.add("--write FOLDER", help.folder, "Write the manual pages of all commands into this folder");
    auto [options, completion] = line.command("completion", completion_text, completion_examples, completion_command);
    completion.app = &line.app;
    options.add("SHELL", completion.shell, "bash, zsh or fish");
    options.add("--output FILE", completion.file, "Write the script to FILE instead of to standard output");
}

} // namespace graze
