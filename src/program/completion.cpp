#include "program/completion.hpp"

#include "graze/atlas/atlas_tables.hpp"
#include "graze/base/input_error.hpp"
#include "graze/branch/special_point.hpp"
#include "graze/design/design.hpp"
#include "graze/model/catalogue.hpp"
#include "graze/picture/record_table.hpp"
#include "graze/results/name_advice.hpp"
#include "graze/results/result_table.hpp"
#include "graze/results/run_kind.hpp"
#include "graze/results/table_recorder.hpp"
#include "graze/study/study_catalogue.hpp"
#include "program/command_line.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

namespace graze {

namespace {

/// The words of both lists, sorted, each once.
std::vector<std::string> united(std::vector<std::string> one, const std::vector<std::string>& other) {
    one.insert(one.end(), other.begin(), other.end());
    std::sort(one.begin(), one.end());
    one.erase(std::unique(one.begin(), one.end()), one.end());
    return one;
}

std::string joined(const std::vector<std::string>& words) {
    return fmt::format("{}", fmt::join(words, " "));
}

/// The text in single quotes for a shell. @param quote replacement of a single quote inside the text
std::string quoted(const std::string& text, const char* quote = "'\\''") {
    std::string result = "'";
    for (const char c : text)
        result += c == '\'' ? std::string(quote) : std::string(1, c);
    return result + "'";
}

std::string option_words(const CLI::App& command) {
    std::vector<std::string> words;
    for (const DeclaredOption& option : declared_options(command))
        if (!option.is_argument)
            words.push_back(option.name);
    return joined(words);
}

/// Values that any of the arguments of a command may have.
Choices argument_choices(const CLI::App& app, const CLI::App& command) {
    Choices all;
    for (const DeclaredOption& option : declared_options(command))
        if (option.is_argument) {
            const Choices one = choices_for(app, command, option);
            all.words = united(all.words, one.words);
            all.files = all.files || one.files;
        }
    return all;
}

std::string bash_script(const CLI::App& app) {
    std::string values, options, arguments;
    std::vector<std::string> names;
    for (const CLI::App* command : declared_commands(app)) {
        const std::string& name = command->get_name();
        names.push_back(name);
        for (const DeclaredOption& option : declared_options(*command)) {
            if (option.is_argument || option.value.empty())
                continue;
            const Choices choices = choices_for(app, *command, option);
            values += fmt::format("    '{} {}') words={} files={} ;;\n", name, option.name,
                                  quoted(joined(choices.words)), choices.files ? "yes" : "no");
        }
        options += fmt::format("        {}) words={} ;;\n", name, quoted(option_words(*command)));
        const Choices choices = argument_choices(app, *command);
        arguments += fmt::format("        {}) words={} files={} ;;\n", name, quoted(joined(choices.words)),
                                 choices.files ? "yes" : "no");
    }
    return fmt::format(R"sh(# Completion of graze for bash: source it, or put it where bash-completion looks.
_graze() {{
    local current="${{COMP_WORDS[COMP_CWORD]}}" before="${{COMP_WORDS[COMP_CWORD-1]}}" command='' words='' files=no known=no i
    for ((i = 1; i < COMP_CWORD; ++i)); do
        if [[ ${{COMP_WORDS[i]}} != -* ]]; then
            command="${{COMP_WORDS[i]}}"
            break
        fi
    done
    case "$command $before" in
{}    *) known=yes ;;
    esac
    if [[ $known == yes && $current == -* ]]; then
        case "$command" in
        '') words='--help --version' ;;
{}        esac
    elif [[ $known == yes ]]; then
        case "$command" in
        '') words='{}' ;;
{}        esac
    fi
    local IFS=$'\n'
    COMPREPLY=($(IFS=' ' compgen -W "$words" -- "$current"))
    if [[ $files == yes ]]; then
        compopt -o filenames 2>/dev/null
        COMPREPLY+=($(compgen -f -- "$current"))
    fi
}}
complete -F _graze 'graze'
)sh",
                       values, options, joined(names), arguments);
}

/// The text with the characters escaped that are special in a completion specification of zsh.
std::string in_zsh(const std::string& text) {
    std::string result;
    for (const char c : text)
        result += (c == '[' || c == ']' || c == ':' || c == '\\' ? "\\" : "") + std::string(1, c == '\n' ? ' ' : c);
    return result;
}

/// The action of a completion specification of zsh that offers these choices.
std::string zsh_action(const Choices& choices) {
    if (choices.words.empty())
        return choices.files ? "_files" : " ";
    return choices.files ? fmt::format("_graze_words {}", joined(choices.words))
                         : fmt::format("({})", joined(choices.words));
}

std::string zsh_script(const CLI::App& app) {
    std::string commands, cases;
    for (const CLI::App* command : declared_commands(app)) {
        commands += "        " + quoted(in_zsh(command->get_name()) + ":" + in_zsh(summary_of(*command))) + "\n";
        cases += fmt::format("    {})\n        _arguments", command->get_name());
        std::size_t arguments = 0;
        for (const DeclaredOption& option : declared_options(*command)) {
            const std::string action = zsh_action(choices_for(app, *command, option));
            const std::string spec =
                option.is_argument ? fmt::format("{}:{}:{}", ++arguments, in_zsh(option.name), action)
                : option.value.empty()
                    ? fmt::format("{}[{}]", option.name, in_zsh(option.text))
                    : fmt::format("*{}[{}]:{}:{}", option.name, in_zsh(option.text), in_zsh(option.value), action);
            cases += " \\\n            " + quoted(spec);
        }
        cases += " ;;\n";
    }
    return fmt::format(R"sh(#compdef graze
# Completion of graze for zsh: put it into a folder of fpath, as _graze.
_graze_words() {{
    compadd -- "$@"
    _files
}}
_graze() {{
    local -a commands
    commands=(
{}    )
    if ((CURRENT == 2)); then
        _describe command commands
        return
    fi
    local command=$words[2]
    shift words
    ((CURRENT--))
    case $command in
{}    esac
}}
_graze "$@"
)sh",
                       commands, cases);
}

std::string fish_script(const CLI::App& app) {
    constexpr const char* quote = "\\'";
    std::string text = "# Completion of graze for fish: put it as graze.fish into a folder of completions.\n"
                       "complete -c graze -f\n"
                       "complete -c graze -n __fish_use_subcommand -l help -d 'Print this help'\n"
                       "complete -c graze -n __fish_use_subcommand -l version -d 'Print the version'\n";
    for (const CLI::App* command : declared_commands(app)) {
        const std::string& name = command->get_name();
        text += fmt::format("complete -c graze -n __fish_use_subcommand -a {} -d {}\n", name,
                            quoted(summary_of(*command), quote));
        const std::string here = fmt::format("complete -c graze -n '__fish_seen_subcommand_from {}'", name);
        for (const DeclaredOption& option : declared_options(*command)) {
            const Choices choices = choices_for(app, *command, option);
            std::string line = here;
            if (!option.is_argument)
                line += " -l " + option.name.substr(2);
            if (choices.files)
                line += " -F";
            if (!option.is_argument && !option.value.empty())
                line += choices.files ? " -r" : " -x";
            if (!choices.words.empty())
                line += " -a " + quoted(joined(choices.words), quote);
            text += fmt::format("{} -d {}\n", line, quoted(option.text, quote));
        }
    }
    return text;
}

} // namespace

Choices choices_for(const CLI::App& app, const CLI::App& command, const DeclaredOption& option) {
    const std::string &of = command.get_name(), &name = option.name, &value = option.value;
    const auto starts = [&](const char* type) { return value.rfind(type, 0) == 0; };
    if (option.is_argument) {
        std::vector<std::string> commands;
        for (const CLI::App* one : declared_commands(app))
            commands.push_back(one->get_name());
        if (name == "MODEL")
            return {shipped_models(), true};
        if (name == "NAME" || name == "SUBJECT")
            return {shipped_models(), true};
        if (name == "STUDY")
            return {shipped_studies(), true};
        if (name == "DESIGN")
            return {shipped_designs(), true};
        if (name == "COMMAND")
            return {commands, false};
        if (name == "WHAT")
            return {kinds_of_estimates(), false};
        if (name == "SHELL")
            return {completion_shells(), false};
        return {of == "info" ? united(shipped_models(), shipped_studies()) : std::vector<std::string>(),
                name == "FILE"};
    }
    if (starts("FILE") || starts("FOLDER"))
        return {{}, true};
    if (starts("FORMAT"))
        return {of == "export" ? std::vector<std::string>{"table", "csv", "json", "hdf5"}
                               : std::vector<std::string>{"table", "csv", "json"},
                false};
    if (starts("KIND_OF_RUN"))
        return {united(kinds_of_runs(), {"all"}), false};
    if (starts("KIND"))
        return {{"bifurcation", "branch", "atlas", "basin", "map", "spectrum", "history", "portrait", "poincare",
                 "regression", "scatter", "residuals"},
                false};
    if (starts("RULE"))
        return {{"simpson", "gauss"}, false};
    if (starts("WAY"))
        return {{"up", "down"}, false};
    if (starts("AXIS"))
        return {{"x", "y"}, false};
    if (starts("TYPE")) {
        std::vector<std::string> names;
        for (const PointKind& kind : point_kinds())
            names.emplace_back(kind.short_name);
        return {names, false};
    }
    if (starts("TABLE") && of == "simulate")
        return {table_kind_names(), false};
    if (starts("TABLE") && of == "record")
        return {record_table_names(), false};
    if (starts("TABLE") && of == "identify")
        return {fit_table_names(), false};
    if (starts("TABLE") && of == "atlas")
        return {atlas_table_names(), false};
    if (starts("TABLE"))
        return {result_table_names(), false};
    return {};
}

std::vector<std::string> completion_shells() {
    return {"bash", "zsh", "fish"};
}

std::string completion_script(const CLI::App& app, const std::string& shell) {
    if (shell == "bash")
        return bash_script(app);
    if (shell == "zsh")
        return zsh_script(app);
    if (shell == "fish")
        return fish_script(app);
    throw InputError(fmt::format("there is no completion for the shell '{}'", shell),
                     name_advice(shell, completion_shells(), ""));
}

} // namespace graze
