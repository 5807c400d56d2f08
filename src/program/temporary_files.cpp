#include "program/temporary_files.hpp"

#include <array>
#include <atomic>
#include <csignal>
#include <cstddef>
#include <cstring>
#include <unistd.h>

namespace graze {

namespace {

enum FileState : int { free_place, being_changed, in_use };

struct UnfinishedFile {
    std::atomic<int> state{free_place};
    char path[4096];
};

// Static, since a signal handler can use only objects with static lifetime.
static_assert(std::atomic<int>::is_always_lock_free);
std::array<UnfinishedFile, 16> places;

} // namespace

bool TemporaryFiles::add(const std::string& path) noexcept {
    if (path.size() >= sizeof UnfinishedFile::path)
        return false;
    for (UnfinishedFile& place : places) {
        int expected = free_place;
        if (!place.state.compare_exchange_strong(expected, being_changed))
            continue;
        std::memcpy(place.path, path.c_str(), path.size() + 1);
        place.state = in_use;
        return true;
    }
    return false;
}

void TemporaryFiles::take_out(const std::string& path) noexcept {
    for (UnfinishedFile& place : places) {
        int expected = in_use;
        if (!place.state.compare_exchange_strong(expected, being_changed))
            continue;
        const bool found = path == place.path;
        place.state = found ? free_place : in_use;
        if (found)
            return;
    }
}

void TemporaryFiles::remove_all() noexcept {
    for (UnfinishedFile& place : places)
        if (place.state == in_use)
            unlink(place.path);
}

void TemporaryFiles::end_process(int signal) noexcept {
    remove_all();
    std::signal(signal, SIG_DFL);
    raise(signal); // takes effect when the handler returns
}

void TemporaryFiles::watch_signals() noexcept {
    std::signal(SIGXFSZ, SIG_IGN);
    for (const int signal :
         {SIGINT, SIGTERM, SIGHUP, SIGQUIT, SIGPIPE, SIGALRM, SIGVTALRM, SIGPROF, SIGXCPU, SIGUSR1, SIGUSR2})
        if (std::signal(signal, &TemporaryFiles::end_process) ==
            SIG_IGN) // as shells start background processes: stays ignored
            std::signal(signal, SIG_IGN);
}

} // namespace graze
