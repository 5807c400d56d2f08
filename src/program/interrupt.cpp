#include "program/interrupt.hpp"

#include <csignal>

namespace graze {

namespace {

// A signal handler can reach nothing but what has static lifetime.
volatile std::sig_atomic_t interrupted = 0;

void note_interrupt(int /*signal*/) {
    interrupted = 1;
}

} // namespace

struct InterruptGuard::Handlers {
    struct sigaction interrupt;
};

InterruptGuard::InterruptGuard() : before_(std::make_unique<Handlers>()) {
    interrupted = 0;
    struct sigaction action {};
    action.sa_handler = note_interrupt;
    action.sa_flags = static_cast<int>(SA_RESETHAND);
    sigemptyset(&action.sa_mask);
    sigaction(SIGINT, &action, &before_->interrupt);
}

InterruptGuard::~InterruptGuard() {
    sigaction(SIGINT, &before_->interrupt, nullptr);
}

bool InterruptGuard::requested() {
    return interrupted != 0;
}

} // namespace graze
