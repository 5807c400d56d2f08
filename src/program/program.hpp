#pragma once

#include "program/wrapped_text.hpp"

#include <cstddef>
#include <ostream>
#include <span>
#include <string>

namespace graze {

/// Where the program writes.
struct Console {
    std::ostream& out;     ///< results only
    std::ostream& err;     ///< messages, outcome, progress
    bool terminal = false; ///< whether `err` is a terminal, on which progress can be shown
    /// The same as `err`, but what moves the cursor stays; for progress only. None: `err`.
    std::ostream* cursor = nullptr;
    std::size_t width = common_line_width; ///< letters in a line of `out`

    std::ostream& progress() const { return cursor ? *cursor : err; }
};

/// Codes with which the program exits; see docs/errors.md. They do not change between versions.
enum ExitCode : int {
    exit_success = 0,
    exit_internal_error = 1,
    exit_bad_input = 2,
    exit_irregular = 3,     ///< the trajectory ended where it should not have; what was computed is written
    exit_interrupted = 130, ///< by Ctrl-C, SIGINT
    exit_terminated = 143,  ///< by SIGTERM
};

/// The whole program, without a process around it.
/// @param arguments without the program's name
/// @return the exit code
int run_program(std::span<const std::string> arguments, const Console& console);

} // namespace graze
