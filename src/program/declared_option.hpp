#pragma once

#include "program/arguments.hpp"

#include <CLI/App.hpp>

#include <optional>
#include <string>
#include <type_traits>
#include <vector>

namespace graze {

template <class Target, class... Types>
constexpr bool is_one_of = (std::is_same_v<Target, Types> || ...);

/// Declares an option with the word for its type, in a group of the help. Numbers that are not finite are refused. The
/// type FILE means a file that the option writes (KeptInputs compares it with inputs); PATH and `FILE:...` are read.
template <class Target>
CLI::Option* declare_option(CLI::App& command, const char* group, const char* name, Target& target, const char* type,
                            const char* text) {
    CLI::Option* option = command.add_option(name, target, text)->type_name(type)->group(group);
    if constexpr (is_one_of<Target, double, std::optional<double>, std::vector<double>>)
        return option->check(finite_number());
    else
        return option;
}

/// Declares `--format`.
CLI::Option* declare_format(CLI::App& command, OutputArguments& output);

/// Declares `--format` and `--digits`.
void declare_digits(CLI::App& command, OutputArguments& output);

/// Declares `--format`, `--digits` and `--output`.
void declare_output(CLI::App& command, OutputArguments& output);

/// Declares the same and `--all`, for tables that may be wider than a terminal.
void declare_table(CLI::App& command, OutputArguments& output);

/// Declares `--data`, the file that keeps the data and commands of a picture.
void declare_data(CLI::App& command, std::string& data);

} // namespace graze
