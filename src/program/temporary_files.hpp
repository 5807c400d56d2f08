#pragma once

#include <string>

namespace graze {

/// The files that are being written under other names than their own, for a signal that ends the process to remove
/// them. Whoever makes one adds it, and takes it out when it has its name or is gone. There is one list in a process.
class TemporaryFiles {
public:
    /// @return whether there was room; of more, and of longer paths, something may be left behind
    static bool add(const std::string& path) noexcept;
    static void take_out(const std::string& path) noexcept;
    /// Removes them all. To be called by signal handlers, too.
    static void remove_all() noexcept;
    /// Removes them all, and ends the process by a signal, as if it had no handler. For signal handlers.
    static void end_process(int signal) noexcept;
    /// From now on signals that end a process (all but SIGKILL and those of mistakes of its own) remove them before.
    /// Those that the process was started to ignore stay ignored. A file that gets longer than the process may write
    /// (SIGXFSZ) ends nothing: writing fails, as on a full disk.
    static void watch_signals() noexcept;
};

} // namespace graze
