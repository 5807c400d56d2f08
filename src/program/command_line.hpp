#pragma once

#include "program/arguments.hpp"
#include "program/program.hpp"

#include <CLI/App.hpp>

#include <cstddef>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <type_traits>
#include <vector>

namespace graze {

/// Accepts only whole numbers within these bounds.
CLI::Validator whole_number(long least, long most);
/// These four accept only finite numbers: all, those above zero, those not below zero, and those within bounds.
CLI::Validator finite_number();
CLI::Validator positive_number();
CLI::Validator non_negative_number();
CLI::Validator number_between(double least, double most);
/// Accepts only these words.
CLI::Validator one_of(const std::vector<std::string>& words);

/// What `--data` does.
inline constexpr const char* kept_data_text =
    "Keep the data and commands of the picture; `gnuplot FILE` draws it again after changes";

/// Declares the options of one command, in the order of its help.
class CommandOptions {
public:
    explicit CommandOptions(CLI::App& command) : command_(&command) {}

    /// Puts the options that follow into a group of the help.
    void in(const char* group) { group_ = group; }
    /// Declares one option, whose value goes to `target`. Numbers that are not finite are refused.
    /// @param usage the option with the word for its value, as "--time T"; a flag without such a word, as "--quiet"; an
    /// argument as "MODEL", or as "[MODEL]" if it may be left out. The word FILE means a file that the option writes
    /// (KeptInputs compares it with inputs); PATH and `FILE:...` are read
    /// @param check refuses values
    template <class Target>
    CLI::Option* add(const std::string& usage, Target& target, const std::string& text,
                     const CLI::Validator& check = {}) {
        const std::size_t blank = usage.find(' ');
        if constexpr (std::is_same_v<Target, bool>) {
            return command_->add_flag(usage, target, text)->group(group_);
        } else {
            const bool may_lack = usage.starts_with('[');
            const std::string name = may_lack ? usage.substr(1, usage.size() - 2) : usage.substr(0, blank);
            CLI::Option* option = command_->add_option(name, target, text)->group(group_);
            option->type_name(blank == std::string::npos ? "" : usage.substr(blank + 1));
            option->required(!may_lack && !usage.starts_with('-'));
            if constexpr (std::is_same_v<Target, double> || std::is_same_v<Target, std::optional<double>> ||
                          std::is_same_v<Target, std::vector<double>>)
                option->check(finite_number());
            return option->check(check);
        }
    }

    /// Declares `--format`.
    CLI::Option* format(OutputArguments& output);
    /// These three declare, in a group of their own: `--format` and `--digits`; `--output` too; and `--all` too, for
    /// tables that may be wider than a terminal.
    void digits(OutputArguments& output);
    void output(OutputArguments& output);
    void table(OutputArguments& output);
    /// Declares, in a group of their own, `--plot` and `--data`, the file that keeps the picture's data and commands.
    void picture(std::string& plot, std::string& data, const std::string& text);
    /// Declares `--size`, `--font` and `--grey`.
    void style(StyleArguments& style);
    void seed(std::size_t& seed, const std::string& text);
    void jobs(int& jobs);
    void progress(bool& shown);

private:
    CLI::App* command_;
    std::string group_ = "Options";
};

/// All commands with their options, and what the commands do. Empty values are refused, except for options declared as
/// TEXT: an unset variable of a script would otherwise silently count as an option not given.
class CommandLine {
public:
    CommandLine();
    CommandLine(const CommandLine&) = delete;
    CommandLine& operator=(const CommandLine&) = delete;

    /// A command without options yet, and where their values go.
    template <class Own>
    struct Declared {
        CommandOptions options;
        Own& arguments;
    };
    /// Declares a command. @param run what it does, with its exit code
    template <class Own>
    Declared<Own> command(const char* name, const std::string& text, const char* examples,
                          int (*run)(const Own&, const Console&)) {
        const auto own = std::make_shared<Own>();
        commands[name] = [run, own](const Console& console) { return run(*own, console); };
        CLI::App& declared = *app.add_subcommand(name, text);
        declared.footer(examples);
        return {CommandOptions(declared), *own};
    }

    CLI::App app{"", "graze"};
    std::map<std::string, std::function<int(const Console&)>> commands; ///< by name; each returns the exit code
};

/// Each declares the commands about its subject, which CommandLine has.
void declare_model_commands(CommandLine& line);
void declare_study_commands(CommandLine& line);
void declare_branch_commands(CommandLine& line);
void declare_design_command(CommandLine& line);
void declare_layout_command(CommandLine& line);
void declare_record_command(CommandLine& line);
void declare_identify_command(CommandLine& line);
void declare_experiment_commands(CommandLine& line);
void declare_help_commands(CommandLine& line);

/// Declares the options that say what is read of a record.
void declare_reading(CommandOptions& options, RecordArguments& record);
/// Values of `graze identify fit --table`.
std::vector<std::string> fit_table_names();

/// Joins `--contacts 4` into one word, since `--contacts` may also stand alone before the model's name; and, of
/// `graze run`, what follows `--`, which is for sbatch, into words `--sbatch=WORD`.
std::vector<std::string> with_joined_words(std::vector<std::string> arguments);

/// One line about what is wrong with a command line, and what to do.
std::string explain(const CLI::ParseError& error, const CLI::App& app);

} // namespace graze
