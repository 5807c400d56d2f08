#pragma once

#include <memory>
#include <string_view>

namespace graze {

/// While it lives, Ctrl-C (SIGINT) and SIGTERM set a flag instead of ending the process; the second one of a kind does
/// end it. Those that the process was started to ignore stay ignored. One within another changes nothing.
class InterruptGuard {
public:
    InterruptGuard();
    ~InterruptGuard();
    InterruptGuard(const InterruptGuard&) = delete;
    InterruptGuard& operator=(const InterruptGuard&) = delete;

    static bool requested();
    /// As shells tell of a process that a signal has ended: 130 after Ctrl-C, 143 after SIGTERM; 0 when nothing was
    /// requested.
    static int exit_code();

private:
    struct Handlers;
    std::unique_ptr<Handlers> before_; ///< none: another guard has them
};

/// Whether a command of the program ends in order when it is interrupted; others are broken off, and leave nothing half
/// written.
bool ends_in_order(std::string_view command);

} // namespace graze
