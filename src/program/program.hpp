#pragma once

#include "program/wrapped_text.hpp"

#include <cstddef>
#include <ostream>
#include <span>
#include <string>

namespace graze {

/// The streams that the program writes to.
struct Console {
    std::ostream& out;     ///< results only
    std::ostream& err;     ///< messages, outcome, progress
    bool terminal = false; ///< `err` is a terminal, on which progress is shown
    /// The stream of `err` without the replacement of control characters; only for progress. Null: `err`.
    std::ostream* cursor = nullptr;
    std::size_t width = common_line_width; ///< characters in a line of `out`

    std::ostream& progress() const { return cursor ? *cursor : err; }
};

/// Exit codes of the program, see docs/errors.md. They do not change between versions.
enum ExitCode : int {
    exit_success = 0,
    exit_internal_error = 1,
    exit_bad_input = 2,
    exit_irregular = 3,     ///< a trajectory or run did not end regularly; the results up to there are written
    exit_interrupted = 130, ///< by Ctrl-C, SIGINT
    exit_terminated = 143,  ///< by SIGTERM
};

/// Runs the program inside the calling process, as tests do.
/// @param arguments without the program's name
/// @return the exit code
int run_program(std::span<const std::string> arguments, const Console& console);

} // namespace graze
