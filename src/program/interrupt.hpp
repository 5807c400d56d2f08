#pragma once

#include <memory>

namespace graze {

/// While it lives, Ctrl-C (SIGINT) and SIGTERM set a flag instead of ending the process; the second one of a kind does
/// end it. Those that the process was started to ignore stay ignored.
class InterruptGuard {
public:
    InterruptGuard();
    ~InterruptGuard();
    InterruptGuard(const InterruptGuard&) = delete;
    InterruptGuard& operator=(const InterruptGuard&) = delete;

    static bool requested();

private:
    struct Handlers;
    std::unique_ptr<Handlers> before_;
};

} // namespace graze
