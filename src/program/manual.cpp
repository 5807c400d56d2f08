#include "program/manual.hpp"

#include "base/letter_case.hpp"
#include "graze/base/input_error.hpp"
#include "graze/results/name_advice.hpp"

#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <fmt/format.h>

#include <sstream>

namespace graze {

namespace {

/// The text in roff, the language of manual pages: escapes backslashes, hyphens, and dots and quotes that begin a line.
std::string in_roff(std::string_view text) {
    std::string result;
    bool line_begins = true;
    for (const char c : text) {
        if (line_begins && (c == '.' || c == '\''))
            result += "\\&";
        result += c == '\\' ? "\\e" : c == '-' ? "\\-" : std::string(1, c);
        line_begins = c == '\n';
    }
    return result;
}

std::string bold(const std::string& text) {
    return text.empty() ? "" : "\\fB" + in_roff(text) + "\\fR";
}

std::string italic(const std::string& text) {
    return text.empty() ? "" : " \\fI" + in_roff(text) + "\\fR";
}

/// All but the first line of a description.
std::string details_of(const CLI::App& command) {
    const std::string text = command.get_description();
    const std::size_t end = text.find('\n');
    return end == std::string::npos ? "" : text.substr(end + 1);
}

std::string synopsis_of(const CLI::App& app, const CLI::App& command) {
    if (&command == &app)
        return bold("graze") + italic("COMMAND") + " [options]";
    std::string text = bold("graze " + command.get_name());
    for (const DeclaredOption& option : declared_options(command))
        if (option.is_argument)
            text += option.required ? italic(option.name) : " [" + italic(option.name).substr(1) + "]";
    return text + " [options]";
}

std::string options_section(const CLI::App& command) {
    std::string text, group;
    for (const DeclaredOption& option : declared_options(command)) {
        const std::string heading = option.is_argument ? "Arguments" : option.group;
        if (text.empty() || heading != group)
            text += fmt::format(".SS {}\n", in_roff(heading));
        group = heading;
        text += ".TP\n";
        if (option.is_argument)
            text += italic(option.name).substr(1) + "\n";
        else
            text += (option.short_name.empty() ? "" : bold(option.short_name) + ", ") + bold(option.name) +
                    italic(option.value) + "\n";
        text += in_roff(option.text) + "\n";
    }
    return text.empty() ? "" : ".SH OPTIONS\n" + text;
}

} // namespace

std::vector<DeclaredOption> declared_options(const CLI::App& command) {
    std::vector<DeclaredOption> all;
    for (const CLI::Option* option : command.get_options()) {
        if (option->get_group().empty()) // not for users
            continue;
        DeclaredOption one;
        one.is_argument = option->get_positional() && option->get_lnames().empty();
        one.name = one.is_argument ? option->get_name(true) : "--" + option->get_lnames().front();
        if (!option->get_snames().empty())
            one.short_name = "-" + option->get_snames().front();
        one.value = option->get_type_size() == 0 ? "" : option->get_type_name();
        one.text = option->get_description();
        one.group = option->get_group();
        one.required = option->get_required();
        all.push_back(std::move(one));
    }
    std::stable_partition(all.begin(), all.end(), [](const DeclaredOption& one) { return one.is_argument; });
    return all;
}

std::vector<const CLI::App*> declared_commands(const CLI::App& app) {
    return app.get_subcommands([](const CLI::App*) { return true; });
}

std::string summary_of(const CLI::App& command) {
    const std::string text = command.get_description();
    return text.substr(0, text.find('\n'));
}

const CLI::App& command_named(const CLI::App& app, const std::string& name) {
    std::vector<std::string> names;
    for (const CLI::App* command : declared_commands(app)) {
        names.push_back(command->get_name());
        if (command->get_name() == name)
            return *command;
    }
    throw InputError(fmt::format("there is no command '{}'", name), name_advice(name, names, ""));
}

std::string help_of(const CLI::App& app, const CLI::App& command) {
    return app.get_formatter()->make_help(&command,
                                          page_name(app, command) == "graze" ? "graze" : "graze " + command.get_name(),
                                          CLI::AppFormatMode::Normal);
}

std::string page_name(const CLI::App& app, const CLI::App& command) {
    return &command == &app ? "graze" : "graze-" + command.get_name();
}

std::string manual_page(const CLI::App& app, const CLI::App& command) {
    const std::string name = page_name(app, command);
    const bool whole = &command == &app;
    std::string text = fmt::format(
        ".TH {} 1 \"\" \"graze {}\" \"graze\"\n.SH NAME\n{} \\- {}\n.SH SYNOPSIS\n{}\n", in_capitals(name),
        GRAZE_VERSION, in_roff(name),
        in_roff(whole ? "hybrid dynamical systems: simulation and bifurcation analysis" : summary_of(command)),
        synopsis_of(app, command));
    const std::string details = whole ? command.get_description() : details_of(command);
    if (!details.empty()) // without filling, so that lists in it keep their lines
        text += ".SH DESCRIPTION\n.nf\n" + in_roff(details) + "\n.fi\n";
    if (whole) {
        text += ".SH COMMANDS\n";
        for (const CLI::App* one : declared_commands(app))
            text +=
                fmt::format(".TP\n\\fBgraze\\-{}\\fR(1)\n{}\n", in_roff(one->get_name()), in_roff(summary_of(*one)));
    }
    text += options_section(command);
    if (const std::string examples = command.get_footer(); !examples.empty()) {
        const std::size_t begin = examples.find('\n');
        text +=
            ".SH EXAMPLES\n.nf\n" + in_roff(examples.substr(begin == std::string::npos ? 0 : begin + 1)) + "\n.fi\n";
    }
    text +=
        ".SH EXIT STATUS\n0 on success, 2 when an option or an input file cannot be used, 3 when a trajectory or a run "
        "did not end as it should, 130 when it was interrupted (143 by SIGTERM), 1 for an internal error.\n.SH "
        "SEE ALSO\n";
    std::string others = whole ? "" : "\\fBgraze\\fR(1)";
    for (const CLI::App* one : declared_commands(app))
        if (one != &command)
            others += fmt::format("{}\\fBgraze\\-{}\\fR(1)", others.empty() ? "" : ",\n", in_roff(one->get_name()));
    return text + others + "\n";
}

} // namespace graze
