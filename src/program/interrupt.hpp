#pragma once

#include <memory>

namespace graze {

/// While it lives, Ctrl-C (SIGINT) sets a flag instead of ending the process; the second one does end it.
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
