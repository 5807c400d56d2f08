#include "record/separate_source.hpp"

#include "base/sanitized.hpp"
#include "graze/base/input_error.hpp"

#include <fmt/format.h>

#include <fcntl.h>
#include <poll.h>
#include <sys/resource.h>
#include <sys/time.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <exception>
#include <new>
#include <string_view>
#include <utility>
#include <vector>

namespace graze {

namespace {

// First byte of a message: a header, rows, the end, or an InputError.
constexpr char kind_header = 'H', kind_part = 'P', kind_end = 'E', kind_refusal = 'R';
/// Larger numbers mean that the other process is corrupted.
constexpr std::uint64_t longest_text = std::uint64_t{1} << 20, most_channels = 100'000, most_rows = 10'000'000;
constexpr int pipe_size = 1 << 20; ///< bytes: a few parts fit, so that both processes work at once
constexpr const char* remedy_of_damage = "it is damaged, or has been cut off; make it again";

/// Bytes of address space of this process; 0 if unknown.
std::size_t address_space() {
    unsigned long pages = 0;
    std::FILE* file = std::fopen("/proc/self/statm", "re");
    if (file == nullptr)
        return 0;
    const bool known = std::fscanf(file, "%lu", &pages) == 1;
    std::fclose(file);
    return known ? pages * static_cast<std::size_t>(sysconf(_SC_PAGESIZE)) : 0;
}

/// The reading process. No function returns to the caller's code: this process is a copy that shares nothing with the
/// caller but the pipe.
class Reader {
public:
    Reader(int pipe, const ReadingLimits& limits) : limits_(&limits) {
        become_quiet(pipe);
        restrict_resources();
    }

    [[noreturn]] void run(const SeparateSource::Make& make) {
        try {
            begin_work();
            const std::unique_ptr<SampleSource> source = make();
            send_header(source->header());
            for (Samples samples;;) {
                begin_work();
                if (!source->read(samples))
                    break;
                send_part(samples);
            }
            send(&kind_end, 1);
        } catch (const InputError& error) {
            refuse(error.place(), error.problem(), error.remedy());
        } catch (const std::bad_alloc&) {
            refuse({}, fmt::format("reading it takes more than {} MiB of memory", limits_->memory >> 20),
                   "it is damaged, or has more channels than that");
        } catch (const std::exception& error) {
            refuse({}, fmt::format("it cannot be read ({})", error.what()), remedy_of_damage);
        }
        _exit(0); // no destructors or buffers of the copied process may run
    }

private:
    static constexpr int pipe_here = 3, first_free = 4, most_files = 8;

    /// Closes the caller's files, resets signals, and discards output.
    static void become_quiet(int pipe) {
        for (const int deadly : {SIGPROF, SIGPIPE, SIGSEGV, SIGBUS, SIGABRT, SIGFPE, SIGILL, SIGXCPU, SIGXFSZ})
            std::signal(deadly, SIG_DFL);
        for (const int of_terminal : {SIGINT, SIGTERM, SIGHUP, SIGQUIT, SIGTSTP})
            std::signal(of_terminal, SIG_IGN); // it ends when its pipe closes
        sigset_t none;
        sigemptyset(&none);
        sigprocmask(SIG_SETMASK, &none, nullptr);
        constexpr int above = 16; // above the standard descriptors
        const int kept = fcntl(pipe, F_DUPFD, above), nothing = open("/dev/null", O_RDWR);
        for (const int standard : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO})
            if (nothing < 0 || (nothing != standard && dup2(nothing, standard) < 0))
                close(standard);
        if (kept < 0 || dup2(kept, pipe_here) < 0)
            _exit(1);
#if defined(__GLIBC__) && __GLIBC_PREREQ(2, 34)
        if (close_range(first_free, ~0U, 0) == 0)
            return;
#endif
        for (int file = first_free; file < 1024; ++file)
            close(file);
    }

    void restrict_resources() const {
        const auto restrict = [](auto what, std::size_t most) {
            rlimit limit{};
            getrlimit(what, &limit);
            limit.rlim_cur = std::min<rlim_t>(limit.rlim_max, most);
            limit.rlim_max = limit.rlim_cur;
            setrlimit(what, &limit);
        };
        if (const std::size_t present = sanitized ? 0 : address_space(); present != 0)
            restrict(RLIMIT_AS, present + limits_->memory);
        restrict(RLIMIT_CORE, 0);
        restrict(RLIMIT_FSIZE, 0);
        restrict(RLIMIT_NOFILE, most_files);
    }

    /// Starts the timer for one part; SIGPROF ends the process.
    void begin_work() const {
        const double whole = std::floor(limits_->work);
        itimerval timer{};
        timer.it_value.tv_sec = static_cast<time_t>(whole);
        timer.it_value.tv_usec = static_cast<suseconds_t>((limits_->work - whole) * 1e6);
        setitimer(ITIMER_PROF, &timer, nullptr);
    }

    static void send(const void* from, std::size_t size) {
        const char* at = static_cast<const char*>(from);
        while (size > 0) {
            const ssize_t count = write(pipe_here, at, size);
            if (count < 0 && errno != EINTR)
                _exit(1);
            at += std::max<ssize_t>(count, 0);
            size -= static_cast<std::size_t>(std::max<ssize_t>(count, 0));
        }
    }
    static void send_number(std::uint64_t number) {
        send(&number, sizeof number);
    }
    static void send_text(std::string_view text) {
        text = text.substr(0, longest_text);
        send_number(text.size());
        send(text.data(), text.size());
    }
    static void send_header(const RecordHeader& header) {
        send(&kind_header, 1);
        send_text(header.time.name);
        send_text(header.time.unit);
        send_number(header.channels.size());
        for (const Channel& channel : header.channels) {
            send_text(channel.name);
            send_text(channel.unit);
        }
    }
    static void send_part(const Samples& samples) {
        send(&kind_part, 1);
        send_number(samples.rows());
        send(samples.times.data(), samples.rows() * sizeof(double));
        for (const std::vector<double>& column : samples.values)
            send(column.data(), samples.rows() * sizeof(double));
    }
    static void refuse(const Place& place, const std::string& problem, const std::string& remedy) {
        send(&kind_refusal, 1);
        send_text(place.file);
        send_number(static_cast<std::uint64_t>(place.line));
        send_number(static_cast<std::uint64_t>(place.column));
        send_text(problem);
        send_text(remedy);
    }

    const ReadingLimits* limits_;
};

} // namespace

SeparateSource::SeparateSource(std::string path, const Make& make, const ReadingLimits& limits)
    : path_(std::move(path)), limits_(limits) {
    int ends[2] = {-1, -1};
    if (pipe(ends) == 0) {
        for (const int end : ends)
            fcntl(end, F_SETFD, FD_CLOEXEC);
#ifdef F_SETPIPE_SZ
        fcntl(ends[1], F_SETPIPE_SZ, pipe_size); // if refused, it is only slower
#endif
        process_ = fork();
    }
    if (process_ < 0) {
        const int reason = errno;
        close(ends[0]);
        close(ends[1]);
        throw FileError(path_, fmt::format("no process can be started to read it ({})", std::strerror(reason)),
                        "end other programs");
    }
    if (process_ == 0)
        Reader(ends[1], limits_).run(make);
    close(ends[1]);
    pipe_ = ends[0];
    try {
        if (const char kind = next_kind(); kind == kind_refusal)
            pass_on_refusal();
        else if (kind != kind_header)
            tell_nonsense();
        header_.time.name = next_text();
        header_.time.unit = next_text();
        for (std::uint64_t channels = next_number(most_channels); channels > 0; --channels) {
            std::string name = next_text(), unit = next_text();
            header_.channels.push_back({std::move(name), std::move(unit)});
        }
    } catch (...) {
        end(true);
        throw;
    }
}

SeparateSource::~SeparateSource() {
    end(true);
}

bool SeparateSource::read(Samples& samples) {
    samples.clear(header_.channels.size());
    if (complete_)
        return false;
    const char kind = next_kind();
    complete_ = kind == kind_end;
    if (complete_)
        return end(true), false;
    if (kind == kind_refusal)
        pass_on_refusal();
    if (kind != kind_part)
        tell_nonsense();
    const std::uint64_t rows = next_number(most_rows);
    const auto take = [&](std::vector<double>& column) {
        column.resize(rows);
        fill(column.data(), rows * sizeof(double));
    };
    take(samples.times);
    for (std::vector<double>& column : samples.values)
        take(column);
    return true;
}

/// Receives the next bytes from the other process.
void SeparateSource::fill(void* to, std::size_t size) {
    for (char* at = static_cast<char*>(to); size > 0;) {
        pollfd ready{pipe_, POLLIN, 0};
        const int found = poll(&ready, 1, static_cast<int>(limits_.silence * 1e3));
        if (found == 0)
            tell_end(true);
        const ssize_t count = found < 0 ? -1 : ::read(pipe_, at, size);
        if (count < 0 && errno == EINTR)
            continue;
        if (count <= 0)
            tell_end(false);
        at += count;
        size -= static_cast<std::size_t>(count);
    }
}

char SeparateSource::next_kind() {
    if (process_ < 0) // the reason has been reported
        tell_nonsense();
    char kind = 0;
    fill(&kind, 1);
    return kind;
}

std::uint64_t SeparateSource::next_number(std::uint64_t most) {
    std::uint64_t number = 0;
    fill(&number, sizeof number);
    if (number > most)
        tell_nonsense();
    return number;
}

std::string SeparateSource::next_text() {
    std::string text(next_number(longest_text), '\0');
    fill(text.data(), text.size());
    return text;
}

void SeparateSource::pass_on_refusal() {
    Place place;
    place.file = next_text();
    place.line = static_cast<int>(next_number());
    place.column = static_cast<int>(next_number());
    if (place.file.empty())
        place.file = path_;
    const std::string problem = next_text(), remedy = next_text();
    end(true);
    throw InputError(place, problem, remedy);
}

void SeparateSource::tell_end(bool silent) {
    const int status = end(silent);
    if (silent || (WIFSIGNALED(status) && WTERMSIG(status) == SIGPROF))
        throw InputError(
            Place{path_, 0, 0},
            fmt::format("reading one part of it takes more than {:g} s", silent ? limits_.silence : limits_.work),
            "it is damaged, or its chunks are too large: write it in chunks of at most 1 MiB");
    throw InputError(Place{path_, 0, 0}, "this file cannot be read", remedy_of_damage);
}

void SeparateSource::tell_nonsense() {
    end(true);
    tell_end(false);
}

/// Ends the other process. @param at_once kills it instead of waiting. @return its exit status
int SeparateSource::end(bool at_once) {
    int status = 0;
    if (pipe_ >= 0)
        close(std::exchange(pipe_, -1));
    if (process_ < 0)
        return status;
    if (at_once)
        kill(process_, SIGKILL);
    while (waitpid(process_, &status, 0) < 0 && errno == EINTR)
        ;
    process_ = -1;
    return status;
}

} // namespace graze
