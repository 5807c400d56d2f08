#include "program/interrupt.hpp"

#include "program/temporary_files.hpp"

#include <algorithm>
#include <array>
#include <csignal>

namespace graze {

namespace {

// Static, since a signal handler can use only objects with static lifetime.
volatile std::sig_atomic_t interrupted = 0; ///< the signal's number
volatile std::sig_atomic_t guarded = 0;
volatile std::sig_atomic_t seen_interrupt = 0, seen_terminate = 0;

void note_interrupt(int signal) {
    volatile std::sig_atomic_t& seen = signal == SIGINT ? seen_interrupt : seen_terminate;
    if (seen != 0)
        return TemporaryFiles::end_process(signal);
    seen = 1;
    interrupted = signal;
}

void catch_signal(int signal, struct sigaction& before) {
    struct sigaction action {};
    action.sa_handler = note_interrupt;
    sigemptyset(&action.sa_mask);
    sigaction(signal, &action, &before);
    if (before.sa_handler == SIG_IGN) // as shells start background processes: stays ignored
        sigaction(signal, &before, nullptr);
}

} // namespace

struct InterruptGuard::Handlers {
    struct sigaction interrupt, terminate;
};

InterruptGuard::InterruptGuard() {
    if (guarded != 0)
        return;
    before_ = std::make_unique<Handlers>();
    guarded = 1;
    interrupted = 0;
    seen_interrupt = 0;
    seen_terminate = 0;
    catch_signal(SIGINT, before_->interrupt);
    catch_signal(SIGTERM, before_->terminate);
}

InterruptGuard::~InterruptGuard() {
    if (!before_)
        return;
    sigaction(SIGINT, &before_->interrupt, nullptr);
    sigaction(SIGTERM, &before_->terminate, nullptr);
    guarded = 0;
}

bool InterruptGuard::requested() {
    return interrupted != 0;
}

int InterruptGuard::exit_code() {
    constexpr int of_shells = 128;
    return interrupted == 0 ? 0 : of_shells + interrupted;
}

bool ends_in_order(std::string_view command) {
    constexpr std::array<std::string_view, 8> commands{"run",    "atlas", "merge",   "simulate",
                                                       "ladder", "bench", "acquire", "view"};
    return std::find(commands.begin(), commands.end(), command) != commands.end();
}

} // namespace graze
