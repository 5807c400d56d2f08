#include "program/slurm_script.hpp"

#include "base/number_ranges.hpp"
#include "graze/base/input_error.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>

namespace graze {

namespace {

/// A path in a line #SBATCH, which no shell reads: SLURM replaces what follows %, and reads quotes and backslashes.
std::string directive_path(const std::string& path) {
    if (path.find_first_of("\n\\") != std::string::npos)
        throw InputError({"--output", 0, 0}, "the name of the folder contains a line feed or a backslash",
                         "choose another folder: scripts for SLURM cannot name this one");
    std::string text;
    for (const char c : path)
        text += c == '"' ? "\\\"" : std::string(1, c);
    return '"' + text + '"';
}

std::string doubled_percents(const std::string& text) {
    std::string result;
    for (const char c : text)
        result += c == '%' ? "%%" : std::string(1, c);
    return result;
}

} // namespace

std::string shell_word(std::string_view text) {
    constexpr std::string_view plain = "/._-=,:@%+";
    if (!text.empty() && std::ranges::all_of(text, [&](unsigned char c) {
            return c < 0x80 && (std::isalnum(c) != 0 || plain.find(static_cast<char>(c)) != std::string_view::npos);
        }))
        return std::string(text);
    std::string word = "'";
    for (const char c : text)
        word += c == '\'' ? "'\\''" : std::string(1, c);
    return word + "'";
}

std::string messages_of_part(const SlurmArray& array, const std::string& number) {
    const std::string folder = number == "%a" ? doubled_percents(array.folder) : array.folder;
    return fmt::format("{}/{}-of-{}.log", folder, number, array.count);
}

std::string slurm_script(const SlurmArray& array) {
    std::string command;
    for (const std::string& word : array.command)
        command += (command.empty() ? "" : " ") + shell_word(word);
    return fmt::format(R"(#!/bin/sh
#SBATCH --job-name=graze-{}
#SBATCH --array={}
#SBATCH --output={}
#SBATCH --open-mode=append
#SBATCH --requeue
# Each task computes one of {} parts of a study; graze merge puts them together. Because of exec SLURM's signals reach the
# program: it then ends after the point that it computes, and goes on from there when the task is begun again.
exec {} \
    --part "$SLURM_ARRAY_TASK_ID/{}" --jobs "${{SLURM_CPUS_PER_TASK:-1}}" --quiet
)",
                       array.name, number_ranges(array.numbers, ","), directive_path(messages_of_part(array, "%a")),
                       array.count, command, array.count);
}

} // namespace graze
