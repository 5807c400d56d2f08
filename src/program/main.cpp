#include "program/interrupt.hpp"
#include "program/program.hpp"
#include "program/standard_streams.hpp"
#include "program/temporary_files.hpp"

#include <algorithm>
#include <array>
#include <glog/logging.h>
#include <iostream>
#include <optional>
#include <string>
#include <string_view>
#include <sys/ioctl.h>
#include <unistd.h>
#include <vector>

namespace {

/// Width of the terminal in characters, at least 60: a very narrow terminal is better scrolled.
std::size_t width_of_terminal() {
    constexpr std::size_t least = 60;
    winsize size{};
    if (isatty(STDOUT_FILENO) != 1 || ioctl(STDOUT_FILENO, TIOCGWINSZ, &size) != 0 || size.ws_col == 0)
        return graze::common_line_width;
    return std::max<std::size_t>(size.ws_col, least);
}

} // namespace

int main(int count, char** values) {
    graze::open_standard_streams();
    // Ceres Solver logs failed steps, which fits report themselves. The log belongs to the program, not to the library.
    FLAGS_minloglevel = google::GLOG_FATAL;
    graze::TemporaryFiles::watch_signals();
    std::optional<graze::InterruptGuard> guard; // from the start of the process, not only of the computation
    if (count > 1 && graze::ends_in_order(values[1]))
        guard.emplace();
    std::ios::sync_with_stdio(false);
    const std::vector<std::string> arguments(values + std::min(count, 1), values + count); // count may be 0
    return graze::run_program(arguments,
                              {std::cout, std::cerr, isatty(STDERR_FILENO) == 1, nullptr, width_of_terminal()});
}
