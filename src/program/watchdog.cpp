#include "program/watchdog.hpp"

#include "graze/acquire/acquisition.hpp"

#include <fmt/format.h>

#include <cerrno>
#include <csignal>
#include <cstring>
#include <exception>
#include <fcntl.h>
#include <string>
#include <sys/wait.h>
#include <system_error>
#include <unistd.h>

namespace graze {

namespace {

void say(const std::string& text) {
    const ssize_t ignored = write(STDERR_FILENO, text.data(), text.size());
    static_cast<void>(ignored);
}

void make_safe_and_say(const Experiment& experiment) {
    const SafeOutput output = make_safe(experiment);
    say(output.safe
            ? fmt::format("graze: acquire was killed; the generator is off, or at its safe amplitude, {} V\n",
                          experiment.safe)
            : fmt::format("graze: acquire was killed, and the generator could not be brought to its safe amplitude "
                          "({}): {}\n",
                          output.problem,
                          output.off ? "its output is switched off, as it tells itself" : "switch it off by hand"));
}

/// Reads words from the pipe until its other end is closed, by disarming or because the process there has ended.
[[noreturn]] void watch(int pipe, const Experiment& experiment, RecordFolder& folder) {
    for (const int signal : {SIGINT, SIGTERM, SIGHUP, SIGPIPE, SIGQUIT})
        std::signal(signal, SIG_IGN); // a terminal sends them to all its processes
    setpgid(0, 0);                    // survives when the process group of `graze acquire` is killed
    close(STDIN_FILENO);
    close(STDOUT_FILENO);
    bool armed = false;
    for (;;) {
        char word = 0;
        const ssize_t count = read(pipe, &word, 1);
        if (count == 1)
            armed = word == 'a';
        else if (count == 0 || errno != EINTR)
            break;
    }
    if (armed) {
        make_safe_and_say(experiment);
        try {
            folder.finish();
        } catch (const std::exception& error) {
            say(fmt::format("graze: the records could not be finished ({}): call it again\n", error.what()));
        }
    }
    _exit(0);
}

} // namespace

Watchdog::Watchdog(const Experiment& experiment, RecordFolder& folder) {
    int ends[2] = {-1, -1};
    if (pipe2(ends, O_CLOEXEC) != 0)
        throw std::system_error(errno, std::generic_category(), "no pipe can be made");
    process_ = fork();
    if (process_ == 0) {
        close(ends[1]);
        watch(ends[0], experiment, folder);
    }
    const int reason = errno;
    close(ends[0]);
    pipe_ = ends[1];
    if (process_ < 0) {
        close(pipe_);
        throw std::system_error(reason, std::generic_category(), "no process can be started");
    }
}

Watchdog::~Watchdog() {
    close(pipe_);
    while (waitpid(process_, nullptr, 0) < 0 && errno == EINTR)
        continue;
}

void Watchdog::tell(char word) const {
    while (write(pipe_, &word, 1) < 0 && errno == EINTR)
        continue;
}

} // namespace graze
