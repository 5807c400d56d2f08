#pragma once

#include "base/sanitized.hpp"
#include "program/interrupt.hpp"
#include "run_graze.hpp"

#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <optional>
#include <string>
#include <thread>
#include <vector>

namespace graze::testing {

/// Limits of the process of run_separately.
struct SeparateRunLimits {
    std::size_t memory = std::size_t{3} << 30; ///< bytes of address space; not applied under sanitizers, which use all
    double time = 60;                          ///< seconds until it is killed; generous, for a busy machine
    double end_after = 0;                      ///< seconds until it gets SIGTERM; 0: never
    std::size_t file_size = 0;                 ///< largest size of a file in bytes, as on a full disk; 0: no limit
};

/// Result of run_separately.
struct SeparateRun {
    int code = -1, signal = 0; ///< exit code (-1: a signal ended it) and signal (0: none)
    bool timed_out = false, was_ended = false;
    double seconds = 0;     ///< processor time
    std::size_t memory = 0; ///< largest resident size in bytes
    std::string out, err;
};

namespace separate_run {

/// The work of the other process. Its output goes into files, which need no reader; the size limit does not apply to
/// them.
[[noreturn]] inline void act(const std::vector<std::string>& words, const SeparateRunLimits& limits, std::FILE* out,
                             std::FILE* err) {
    const rlimit memory{limits.memory, limits.memory};
    if (!sanitized)
        setrlimit(RLIMIT_AS, &memory);
    rlimit all_sizes{};
    getrlimit(RLIMIT_FSIZE, &all_sizes);
    if (limits.file_size > 0) {
        rlimit size{limits.file_size, all_sizes.rlim_max};
        setrlimit(RLIMIT_FSIZE, &size);
        std::signal(SIGXFSZ, SIG_IGN); // writing fails, as it does on a full disk
    }
    rlimit core{0, 0};
    setrlimit(RLIMIT_CORE, &core);
    std::optional<InterruptGuard> guard; // as main does
    if (!words.empty() && ends_in_order(words.front()))
        guard.emplace();
    const Printed printed = run_graze(words);
    setrlimit(RLIMIT_FSIZE, &all_sizes);
    std::fwrite(printed.out.data(), 1, printed.out.size(), out);
    std::fwrite(printed.err.data(), 1, printed.err.size(), err);
    std::fflush(out);
    std::fflush(err);
    _exit(printed.code);
}

inline std::string contents_of(std::FILE* file) {
    std::string text;
    std::rewind(file);
    char block[65536];
    while (const std::size_t count = std::fread(block, 1, sizeof block, file))
        text.append(block, count);
    std::fclose(file);
    return text;
}

} // namespace separate_run

/// Runs the program in another process, which may crash, hang or use too much memory.
inline SeparateRun run_separately(const std::vector<std::string>& words, const SeparateRunLimits& limits = {}) {
    std::FILE *out = std::tmpfile(), *err = std::tmpfile();
    SeparateRun run;
    const pid_t child = fork();
    if (child == 0)
        separate_run::act(words, limits, out, err);
    const auto begun = std::chrono::steady_clock::now();
    int status = 0;
    rusage used{};
    for (int wait = 0; wait4(child, &status, WNOHANG, &used) == 0; ++wait) {
        const double elapsed = std::chrono::duration<double>(std::chrono::steady_clock::now() - begun).count();
        if (limits.end_after > 0 && elapsed > limits.end_after && !run.was_ended) {
            run.was_ended = true;
            kill(child, SIGTERM);
        }
        if (elapsed > limits.time) {
            run.timed_out = true;
            kill(child, SIGKILL);
        }
        std::this_thread::sleep_for(std::chrono::microseconds(wait < 20 ? 500 : 5000));
    }
    run.code = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
    run.signal = WIFSIGNALED(status) ? WTERMSIG(status) : 0;
    const auto seconds_of = [](const timeval& time) { return static_cast<double>(time.tv_sec) + time.tv_usec * 1e-6; };
    run.seconds = seconds_of(used.ru_utime) + seconds_of(used.ru_stime);
    run.memory = static_cast<std::size_t>(used.ru_maxrss) * 1024;
    run.out = separate_run::contents_of(out);
    run.err = separate_run::contents_of(err);
    return run;
}

} // namespace graze::testing
