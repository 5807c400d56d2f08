#include "program/command_line.hpp"

#include "base/read_whole.hpp"
#include "graze/base/name_list.hpp"
#include "program/values.hpp"

#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>
#include <sstream>

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
            const std::size_t sign = text.starts_with('+') ? 1 : 0; // which finite_number_in does not take
            const std::optional<double> value = finite_number_in(std::string_view(text).substr(sign));
            return value && allowed(*value) ? std::string() : fmt::format("'{}' is not {}", text, words);
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
            return read_whole(text, value) && value >= least && value <= most
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

CLI::Option* CommandOptions::format(OutputArguments& output) {
    static const std::map<std::string, TableFormat> formats{
        {"table", TableFormat::table}, {"csv", TableFormat::csv}, {"json", TableFormat::json}};
    // CLI11's own conversion to an enumeration would accept any number.
    const auto read = [&output](const std::string& word) { output.format = formats.at(word); };
    return command_->add_option_function<std::string>("--format", read, "table (default), csv or json")
        ->type_name("FORMAT")
        ->check(one_of({"table", "csv", "json"}))
        ->group(group_);
}

void CommandOptions::digits(OutputArguments& output) {
    in("Output");
    format(output);
    add("--digits N", output.digits, "Significant digits of numbers (8 in tables; 17, which is exact, in csv and json)",
        whole_number(1, 17));
}

void CommandOptions::output(OutputArguments& output) {
    digits(output);
    add("--output FILE", output.file, "Write the table to FILE instead of to standard output");
}

void CommandOptions::table(OutputArguments& output) {
    this->output(output);
    add("--all", output.all, "Show all columns of a table, even if they do not fit the terminal");
}

void CommandOptions::picture(std::string& plot, std::string& data, const std::string& text) {
    in("Picture");
    add("--plot FILE", plot, text);
    add("--data FILE", data, kept_data_text);
}

void CommandOptions::style(StyleArguments& style) {
    add("--size W[xH]", style.size,
        "Width in mm, such as 85 or 170 for the columns of a journal (170), and height (chosen by the contents)");
    add("--font FONT", style.font, "Font size in points, font name, or NAME,SIZE (9)");
    add("--grey", style.grey, "Draw in grey, for print without colours");
}

void CommandOptions::seed(std::size_t& seed, const std::string& text) {
    add("--seed N", seed, text, whole_number(0, 1'000'000'000));
}

void CommandOptions::jobs(int& jobs) {
    add("--jobs N", jobs, "Number of threads (one for each core); results do not depend on it", whole_number(1, 1024));
}

void CommandOptions::progress(bool& shown) {
    add("--progress", shown, "Show progress even if standard error is no terminal");
}

CommandLine::CommandLine() {
    app.description(general_text)->footer(general_examples);
    app.require_subcommand(1);
    app.set_version_flag("--version", "graze " GRAZE_VERSION, "Print the version");
    app.set_help_flag("-h,--help", "Print this help");
    app.formatter(std::make_shared<BriefFormatter>());
    app.get_formatter()->column_width(26);
    declare_model_commands(*this);
    declare_study_commands(*this);
    declare_branch_commands(*this);
    declare_design_command(*this);
    declare_layout_command(*this);
    declare_record_command(*this);
    declare_identify_command(*this);
    declare_experiment_commands(*this);
    declare_help_commands(*this);
    for (CLI::App* command : app.get_subcommands({}))
        for (CLI::Option* option : command->get_options())
            if (option->get_items_expected_max() == 0)
                option->disable_flag_override();
            else if (option->get_type_name() != "TEXT")
                option->check(not_empty());
}

std::vector<std::string> with_joined_words(std::vector<std::string> arguments) {
    const bool is_run = !arguments.empty() && arguments.front() == "run";
    for (std::size_t i = 0; i < arguments.size(); ++i) {
        if (is_run && arguments[i] == "--" && i + 1 < arguments.size() && arguments[i + 1].starts_with('-')) {
            arguments.erase(arguments.begin() + static_cast<std::ptrdiff_t>(i));
            for (; i < arguments.size(); ++i)
                arguments[i].insert(0, "--sbatch=");
            return arguments;
        }
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
