#pragma once

#include <string>

namespace graze {

/// The list of temporary files that are being written, so that they are removed when a signal ends the process. Code
/// that makes a temporary file adds it, and takes it out when it is renamed or removed. A process has one list.
class TemporaryFiles {
public:
    /// @return false if the list is full or the path is too long: the file may then remain after a signal
    static bool add(const std::string& path) noexcept;
    static void take_out(const std::string& path) noexcept;
    /// Removes all files of the list. Safe in signal handlers.
    static void remove_all() noexcept;
    /// Removes all files of the list and ends the process by the signal, as if it had no handler. For signal handlers.
    static void end_process(int signal) noexcept;
    /// Makes signals that end the process remove the files first (all but SIGKILL and those of crashes). Signals that
    /// were ignored when the process started stay ignored. SIGXFSZ, for a file beyond the size limit, is ignored:
    /// writing fails instead, as on a full disk.
    static void watch_signals() noexcept;
};

} // namespace graze
