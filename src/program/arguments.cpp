#include "program/arguments.hpp"

#include "graze/base/name_list.hpp"
#include "graze/symbolic/parser.hpp"
#include "program/branch_arguments.hpp"
#include "program/commands.hpp"
#include "program/declared_option.hpp"
#include "program/design_arguments.hpp"
#include "program/experiment_arguments.hpp"
#include "program/help_arguments.hpp"
#include "program/identify_arguments.hpp"
#include "program/layout_arguments.hpp"
#include "program/record_arguments.hpp"
#include "program/study_arguments.hpp"

#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <map>
#include <memory>
#include <sstream>
#include <string>
#include <thread>
#include <type_traits>

namespace graze {

namespace {

constexpr const char* general_text =
    R"(Simulates hybrid dynamical systems: smooth motion interrupted by impacts, switches, stick and slip,
sweeps their parameters, and follows branches of periodic orbits. A model is a text file of equations. A study is a text
file that lists computations with models. Several of both come with graze.)";

constexpr const char* general_examples = R"(Start here:
  graze models                                     what comes with graze
  graze simulate bouncing-ball --plot ball.svg     a picture of one of them
  graze models bouncing-ball --write my-ball.toml  a model file to change
  graze check my-ball.toml                         is it right?
  graze run --list                                 studies that come with graze: bifurcation diagrams and more
  graze run mems-switch --output switch            run one; results and pictures go to the folder switch
  graze points results                             special points of branches of periodic orbits
  graze grazing results GR1                        does the attractor survive this grazing, or is it lost?
  graze trip results GR1                           how fast it is lost
  graze COMMAND --help                             all options of a command)";

constexpr const char* check_text = R"(Check a model and list its contents.
Warnings go to standard error. They name what is allowed but
probably a mistake, such as an event that no mode watches.)";

constexpr const char* check_examples = R"(Examples:
  graze check my-model.toml
  graze check impact-microactuator --graph modes.svg)";

constexpr const char* models_text = R"(List the shipped models, describe one, or write its file.
The microbeam is a family of models: --beam-modes
is the number of eigenmodes in which its motion is expanded.)";

constexpr const char* models_examples = R"(Examples:
  graze models
  graze models mems-switch
  graze models mems-switch --write my-switch.toml
  graze models microbeam --beam-modes 9 --write beam9.toml)";

constexpr const char* simulate_text = R"(Compute a trajectory.
Follows one trajectory from contact to contact without missing any, and prints a table: the states at equally spaced
times, unless --section, --contacts, --extrema, --minima or --derivatives asks for another table.
Values are numbers or expressions in the model's parameters, such as --time 2*pi/omega.)";

constexpr const char* simulate_examples = R"(Examples:
  graze simulate bouncing-ball --plot ball.svg
  graze simulate electromagnetic-testbed --set V0=4.833 --from I=0.1 --periods 20 --section phase0 --format csv
  graze simulate mems-switch --contacts --event stop --format csv
  graze simulate impact-oscillator --skip 100 --periods 5 --quantity energy --samples 1000 --output run.csv)";

void declare_check(CLI::App& app, CheckArguments& arguments) {
    CLI::App& command = *app.add_subcommand("check", check_text);
    command.footer(check_examples);
    command.add_option("MODEL", arguments.model, "Name of a shipped model, or a file")->type_name("")->required();
    command
        .add_option(
            "--graph", arguments.graph,
            "Draw the modes and the transitions between them (.svg, .png or .pdf by Graphviz; .dot needs no Graphviz)")
        ->type_name("FILE");
    declare_output(command, arguments.output);
}

void declare_models(CLI::App& app, ModelsArguments& arguments) {
    CLI::App& command = *app.add_subcommand("models", models_text);
    command.footer(models_examples);
    command.add_option("NAME", arguments.name, "The model to describe; without it all are listed")->type_name("");
    command.add_flag("--show", arguments.show, "Print the model file");
    command.add_option("--write", arguments.file, "Write the model file to FILE")->type_name("FILE");
    command
        .add_option("--beam-modes", arguments.beam_modes,
                    "Number of eigenmodes of the microbeam (1); more are more accurate and slower")
        ->type_name("N")
        ->group("Microbeam");
    command
        .add_option("--quadrature", arguments.quadrature,
                    "Quadrature rule of the electrostatic force: simpson (default) or gauss")
        ->type_name("RULE")
        ->group("Microbeam");
    command.add_option("--points", arguments.points, "Number of Simpson's intervals (even) or of Gauss's nodes (20)")
        ->type_name("N")
        ->group("Microbeam");
    declare_digits(command, arguments.output);
}

/// Shows only the first line of each command's description in the list of commands.
class BriefFormatter : public CLI::Formatter {
public:
    std::string make_subcommand(const CLI::App* command) const override {
        const std::string text = command->get_description();
        std::ostringstream line;
        CLI::detail::format_help(line, command->get_name(), text.substr(0, text.find('\n')), get_column_width());
        return line.str();
    }
};

void declare_length(CLI::App& command, SimulateArguments& arguments) {
    const char* group = "How long (default: 20 periods)";
    declare_option(command, group, "--time", arguments.time, "T", "Simulate this time, in the model's unit");
    declare_option(command, group, "--periods", arguments.periods, "N", "Simulate N periods of the cyclic state");
    declare_option(command, group, "--contacts", arguments.contact_count, "[N]",
                   "With a number: simulate until N contacts; without: print the table of contacts");
    declare_option(command, group, "--phase", arguments.phase, "STATE",
                   "Cyclic state whose periods are counted, if the model has several");
    declare_option(command, group, "--skip", arguments.skip, "N",
                   "Simulate N periods before the output begins, as to skip a transient (0)");
    declare_option(command, group, "--after", arguments.after, "T",
                   "Simulate this time before the output begins, as to skip a transient (0)");
}

void declare_tables(CLI::App& command, SimulateArguments& arguments) {
    const char* group = "What to show";
    declare_option(command, group, "--section", arguments.sections, "NAME",
                   "Print the states at each passage of these sections");
    declare_option(command, group, "--extrema", arguments.extrema, "EXPR",
                   "Print the states at maxima and minima of these expressions");
    declare_option(command, group, "--event", arguments.events, "NAME",
                   "Show and count only the contacts at these events (all)");
    declare_option(command, group, "--quantity", arguments.quantities, "EXPR",
                   "More columns: quantities of the model, or any expressions in its names");
    command
        .add_flag("--minima", arguments.minima,
                  "Print the least value of each watched event function in each arc, with a guaranteed lower bound")
        ->group(group);
    declare_option(
        command, group, "--derivatives", arguments.derivatives, "NAME",
        "Print derivatives of the final state with respect to these initial states and parameters, or `all`");
    declare_option(command, group, "--samples", arguments.samples, "N", "Number of rows at equally spaced times (500)");
    declare_option(command, group, "--every", arguments.every, "DT",
                   "Time between these rows, instead of their number");
    declare_option(command, group, "--table", arguments.table, "TABLE",
                   "samples, contacts, sections, extrema, minima, derivatives or summary; needed only if the options "
                   "above ask for several");
}

void declare_plot(CLI::App& command, SimulateArguments& arguments) {
    const char* group = "Picture";
    declare_option(command, group, "--plot", arguments.plot, "FILE",
                   "Draw time histories and phase portraits as svg, png, pdf or eps, by gnuplot; --quantity chooses "
                   "the histories");
    declare_option(command, group, "--portrait", arguments.portraits, "X,Y",
                   "Axes of phase portraits, a pair for each (a state and its velocity)")
        ->expected(1, -1);
    declare_option(command, group, "--size", arguments.style.size, "W[xH]",
                   "Width of the picture in mm, such as 85 or 170 for the columns of a journal, and its height "
                   "(chosen by the contents)");
    declare_option(command, group, "--font", arguments.style.font, "FONT",
                   "Font size in points, font name, or NAME,SIZE (9)");
    command.add_flag("--grey", arguments.style.grey, "Draw in grey, for print without colours")->group(group);
    declare_option(command, group, "--data,--plot-data", arguments.plot_data, "FILE",
                   "Keep the data and commands of the picture; `gnuplot FILE` draws it again after changes");
}

void declare_method(CLI::App& command, SimulateArguments& arguments) {
    const char* group = "Method";
    declare_option(command, group, "--tolerance", arguments.tolerance, "TOL",
                   "Relative error of each step, 1e-16 to 1e-2 (1e-12)");
    declare_option(command, group, "--order", arguments.order, "N",
                   "Order of the Taylor polynomials (chosen by the tolerance)");
    declare_option(command, group, "--largest-step", arguments.largest_step, "T",
                   "Largest step in time (unbounded); contacts are found without it");
    declare_option(command, group, "--steps", arguments.steps, "N", "End after N steps (100 million)")
        ->check(whole_number(1, 1'000'000'000'000));
    command.add_flag("--progress", arguments.progress, "Show progress even if standard error is no terminal")
        ->group(group);
    command.add_flag("--quiet", arguments.quiet, "Report how the trajectory ended only if it broke off")->group(group);
}

void declare_simulate(CLI::App& app, SimulateArguments& arguments) {
    CLI::App& command = *app.add_subcommand("simulate", simulate_text);
    command.footer(simulate_examples);
    command.add_option("MODEL", arguments.model, "Name of a shipped model, or a file")->type_name("")->required();
    const char* group = "Parameters and initial state";
    declare_option(command, group, "--set", arguments.set, "NAME=VALUE", "Values of parameters (the model's)");
    declare_option(command, group, "--from", arguments.from, "NAME=VALUE", "Initial values of states (the model's)");
    declare_option(command, group, "--mode", arguments.mode, "NAME", "Initial mode (the model's)");
    declare_length(command, arguments);
    command.add_flag("--contact-table", arguments.contacts)->group(""); // see with_joined_counts
    declare_tables(command, arguments);
    declare_plot(command, arguments);
    declare_output(command, arguments.output);
    command
        .add_flag("--all", arguments.output.all, "Show all columns of a table, even if they do not fit the terminal")
        ->group("Output");
    declare_method(command, arguments);
}

bool is_integer(const std::string& text) {
    const std::size_t start = !text.empty() && (text[0] == '-' || text[0] == '+') ? 1 : 0;
    return text.size() > start && std::all_of(text.begin() + static_cast<std::ptrdiff_t>(start), text.end(),
                                              [](unsigned char c) { return std::isdigit(c) != 0; });
}

/// The command in which the parser failed; the program itself if it had not reached one.
const CLI::App& innermost(const CLI::App& app) {
    const auto commands = app.get_subcommands();
    return commands.empty() ? app : *commands.front();
}

std::vector<std::string> option_names(const CLI::App& command) {
    std::vector<std::string> names;
    for (const CLI::Option* option : command.get_options())
        for (const std::string& name : option->get_lnames())
            if (!option->get_group().empty())
                names.push_back(name);
    return names;
}

std::string explain_extra(const std::string& word, const CLI::App& command, const std::string& help) {
    if (word.starts_with("-")) {
        const std::string name = word.substr(std::min(word.find_first_not_of('-'), word.size()));
        const std::string nearest = nearest_name(name.substr(0, name.find('=')), option_names(command));
        return fmt::format("unknown option '{}'; {}", word,
                           nearest.empty() ? help : fmt::format("did you mean '--{}'?", nearest));
    }
    std::vector<std::string> commands;
    for (const CLI::App* other : command.get_subcommands({}))
        commands.push_back(other->get_name());
    if (commands.empty())
        return fmt::format("'{}' is one argument too many; {}", word, help);
    const std::string nearest = nearest_name(word, commands);
    return fmt::format("unknown command '{}'; {}", word,
                       nearest.empty() ? help : fmt::format("did you mean '{}'?", nearest));
}

/// @param message of CLI11, as "Could not convert: --order = x"
std::string explain_conversion(const std::string& message, const std::string& help) {
    const std::size_t start = message.find("--"), equals = message.find(" = ");
    if (start == std::string::npos || equals == std::string::npos || equals < start)
        return fmt::format("{}; {}", message, help);
    const std::string option = message.substr(start, equals - start);
    return fmt::format("{}: '{}' is no value for it; {}", option, message.substr(equals + 3),
                       option == "--format" ? "choose table, csv or json" : help);
}

/// @param message of CLI11, as "--time: 1 required T missing"
std::string explain_missing(const std::string& message, const std::string& help) {
    const std::size_t colon = message.find(": "), required = message.find(" required ");
    const std::size_t missing = message.rfind(" missing");
    if (const std::size_t end = message.find(" was given a disallowed flag"); end != std::string::npos) {
        const std::size_t begin = std::min(end, message.find_first_not_of('-'));
        return fmt::format("--{}: it takes no value; leave out what follows it", message.substr(begin, end - begin));
    }
    if (colon == std::string::npos || required == std::string::npos || missing == std::string::npos)
        return fmt::format("{}; {}", message, help);
    const std::string option = message.substr(0, colon), type = message.substr(required + 10, missing - required - 10);
    return fmt::format("{}: its value is missing; write {} {}", option, option, type);
}

/// @param message of CLI11, as "MODEL is required"
std::string explain_required(const std::string& message, const CLI::App& command, const std::string& name) {
    std::string all;
    for (const CLI::Option* option : command.get_options())
        if (option->get_positional() && option->get_required())
            all += ' ' + option->get_name();
    const std::string missing = message.substr(0, message.find(' '));
    return fmt::format("{} is missing; write {}{}, then the options",
                       missing == "MODEL"   ? "the model"
                       : missing == "POINT" ? "the point"
                       : missing == "FILE"  ? "the file"
                       : missing == "SHELL" ? "the shell"
                       : missing == "WHAT"  ? "what to find"
                                            : missing,
                       name, all);
}

/// Refuses texts that are not finite numbers for which `allowed` is true. @param words description of allowed numbers
template <class Allowed>
CLI::Validator checked_number(const Allowed& allowed, const std::string& words) {
    return CLI::Validator(
        [=](std::string& text) {
            double value = 0;
            const std::size_t sign = text.starts_with('+') ? 1 : 0; // which from_chars does not take
            const auto [end, error] = std::from_chars(text.data() + sign, text.data() + text.size(), value);
            const bool whole = error == std::errc() && end == text.data() + text.size();
            return whole && std::isfinite(value) && allowed(value) ? std::string()
                                                                   : fmt::format("'{}' is not {}", text, words);
        },
        "");
}

CLI::Validator not_empty() {
    return CLI::Validator([](std::string& text) { return text.empty() ? "its value is empty" : std::string(); }, "");
}

} // namespace

CLI::Validator whole_number(long least, long most) {
    return CLI::Validator(
        [=](std::string& text) {
            long value = 0;
            const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
            const bool whole = error == std::errc() && end == text.data() + text.size();
            return whole && value >= least && value <= most
                       ? std::string()
                       : fmt::format("'{}' is not a whole number from {} to {}", text, least, most);
        },
        "");
}

CLI::Validator finite_number() {
    return checked_number([](double) { return true; }, "a finite number");
}

CLI::Validator positive_number() {
    return checked_number([](double value) { return value > 0; }, "a finite number above 0");
}

CLI::Validator non_negative_number() {
    return checked_number([](double value) { return value >= 0; }, "a finite number from 0 on");
}

CLI::Validator number_between(double least, double most) {
    return checked_number([=](double value) { return value >= least && value <= most; },
                          fmt::format("a number from {} to {}", least, most));
}

CLI::Validator one_of(const std::vector<std::string>& words) {
    return CLI::Validator(
        [words](std::string& text) {
            if (std::find(words.begin(), words.end(), text) != words.end())
                return std::string();
            const std::string nearest = nearest_name(text, words);
            return fmt::format(
                "'{}' is no value for it; {}", text,
                nearest.empty()
                    ? fmt::format("choose {} or {}", fmt::join(words.begin(), words.end() - 1, ", "), words.back())
                    : fmt::format("did you mean '{}'?", nearest));
        },
        "");
}

int threads_for(int jobs) {
    return jobs > 0 ? jobs : static_cast<int>(std::max(1U, std::thread::hardware_concurrency()));
}

void declare_arguments(CLI::App& app, Arguments& arguments) {
    app.description(general_text)->footer(general_examples);
    app.require_subcommand(1);
    app.set_help_flag("-h,--help", "Print this help");
    app.formatter(std::make_shared<BriefFormatter>());
    app.get_formatter()->column_width(26);
    declare_check(app, arguments.check);
    arguments.add_command("check", check_command, arguments.check);
    declare_models(app, arguments.models);
    arguments.add_command("models", models_command, arguments.models);
    declare_simulate(app, arguments.simulate);
    arguments.add_command("simulate", simulate_command, arguments.simulate);
    declare_study_commands(app, arguments);
    declare_branch_commands(app, arguments);
    declare_design_command(app, arguments);
    declare_layout_command(app, arguments);
    declare_record_commands(app, arguments);
    declare_identify_command(app, arguments);
    declare_experiment_commands(app, arguments);
    declare_help_commands(app, arguments);
    for (CLI::App* command : app.get_subcommands({}))
        for (CLI::Option* option : command->get_options())
            if (option->get_items_expected_max() == 0)
                option->disable_flag_override();
            else if (option->get_type_name() != "TEXT")
                option->check(not_empty());
}

std::vector<std::string> with_joined_counts(std::vector<std::string> arguments) {
    for (std::size_t i = 0; i < arguments.size(); ++i) {
        if (arguments[i] != "--contacts")
            continue;
        if (i + 1 < arguments.size() && is_integer(arguments[i + 1])) {
            arguments[i] += "=" + arguments[i + 1];
            arguments.erase(arguments.begin() + static_cast<std::ptrdiff_t>(i) + 1);
        } else {
            arguments[i] = "--contact-table";
        }
    }
    return arguments;
}

std::string explain(const CLI::ParseError& error, const CLI::App& app) {
    const CLI::App& command = innermost(app);
    const std::string name = &command == &app ? "graze" : "graze " + command.get_name();
    const std::string help = fmt::format("see {} --help", name);
    if (dynamic_cast<const CLI::ExtrasError*>(&error) != nullptr)
        if (const std::vector<std::string> extras = app.remaining(true); !extras.empty())
            return explain_extra(extras.front(), command, help);
    if (dynamic_cast<const CLI::RequiredError*>(&error) != nullptr) {
        // The command, or a required argument of it, is missing.
        const std::vector<std::string> extras = app.remaining(true);
        if (!extras.empty())
            return explain_extra(extras.front(), command, help);
        return &command == &app ? "a command is missing; " + help : explain_required(error.what(), command, name);
    }
    if (dynamic_cast<const CLI::ConversionError*>(&error) != nullptr)
        return explain_conversion(error.what(), help);
    if (dynamic_cast<const CLI::ArgumentMismatch*>(&error) != nullptr)
        return explain_missing(error.what(), help);
    const std::string message = error.what();
    return message.find("; ") == std::string::npos ? fmt::format("{}; {}", message, help) : message;
}

} // namespace graze
