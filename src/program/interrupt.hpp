#pragma once

#include <memory>
#include <string_view>

namespace graze {

/// During its lifetime Ctrl-C (SIGINT) and SIGTERM set a flag instead of ending the process; a second signal of the
/// same kind ends it. Signals that were ignored when the process started stay ignored. A nested guard changes nothing.
class InterruptGuard {
public:
    InterruptGuard();
    ~InterruptGuard();
    InterruptGuard(const InterruptGuard&) = delete;
    InterruptGuard& operator=(const InterruptGuard&) = delete;

    static bool requested();
    /// The exit code by the convention of shells: 130 after Ctrl-C, 143 after SIGTERM; 0 without a signal.
    static int exit_code();

private:
    struct Handlers;
    std::unique_ptr<Handlers> before_; ///< null: an outer guard has them
};

/// True for commands that finish in order when they are interrupted. Others end at once, without half-written files.
bool ends_in_order(std::string_view command);

} // namespace graze
