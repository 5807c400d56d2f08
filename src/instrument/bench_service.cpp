#include "instrument/bench_service.hpp"

#include "base/random_number.hpp"
#include "instrument/sample_protocol.hpp"
#include "instrument/terminal.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <arpa/inet.h>
#include <array>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <fcntl.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <optional>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

namespace graze {

namespace {

/// Splits received text into lines, which end with carriage returns or line feeds.
class LineCutter {
public:
    explicit LineCutter(std::size_t longest) : longest_(longest) {}
    /// @param take called with each line, and whether it was too long, in which case it is truncated
    template <class Take>
    void add(std::string_view text, const Take& take) {
        for (const char letter : text) {
            if (letter == '\n' || letter == '\r') {
                if (!line_.empty())
                    take(line_, too_long_);
                line_.clear();
                too_long_ = false;
            } else if (line_.size() > longest_) {
                too_long_ = true;
            } else {
                line_ += letter;
            }
        }
    }
    /// Whether the present, incomplete line is already too long.
    bool is_too_long() const { return too_long_; }
    void clear() {
        line_.clear();
        too_long_ = false;
    }

private:
    std::size_t longest_;
    std::string line_;
    bool too_long_ = false;
};

constexpr std::size_t most_to_send = std::size_t{1} << 18; ///< bytes buffered for the client
constexpr std::size_t most_on_line = 4096;                 ///< as a serial line, it drops what exceeds this

void require_between(double value, double least, double most, const char* what) {
    if (!(value >= least && value <= most))
        throw InputError(fmt::format("{} is {}", what, value), fmt::format("give from {} to {}", least, most));
}

int listener(std::uint16_t port) {
    const int file = socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0), yes = 1;
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_port = htons(port);
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    if (file >= 0)
        setsockopt(file, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes);
    if (file < 0 || bind(file, reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0 ||
        listen(file, 4) != 0) {
        const int reason = errno;
        if (file >= 0)
            close(file);
        throw InputError(Place{"tcp", 0, 0},
                         fmt::format("port {} cannot be listened at ({})", port, std::strerror(reason)),
                         "choose another one, or 0 for one that is free");
    }
    return file;
}

} // namespace

void ServiceSettings::validate() const {
    require_between(speed, 1e-6, 1e6, "the speed");
    require_between(drop, 0, 1, "the probability of a lost character");
    require_between(delay, 0, 3600, "the delay");
    require_between(broken, 0, 3600, "the time for which the line is broken");
}

struct BenchService::State {
    using Clock = std::chrono::steady_clock;

    State(ScpiBench& b, const ServiceSettings& s)
        : bench(b), settings(s), terminal(std::in_place, s.port), listening(listener(s.tcp)), protocol(b) {}

    ScpiBench& bench;
    ServiceSettings settings;
    std::optional<Terminal> terminal;
    Descriptor listening, client{};
    SampleProtocol protocol;
    LineCutter serial_lines{FunctionGenerator::longest_line}, client_lines{SampleProtocol::longest_line};
    std::string to_serial{}, to_client{};
    Clock::time_point serial_due{}, back_at{}, began = Clock::now();
    double began_at = 0; ///< simulated time at `began`
    std::size_t drawn_letters = 0, line_count = 0, row_count = 0;
    bool has_broken = false;

    static double seconds(Clock::duration duration) { return std::chrono::duration<double>(duration).count(); }
    static Clock::duration duration(double seconds) {
        return std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(seconds));
    }
    double now_of_bench() const { return began_at + settings.speed * seconds(Clock::now() - began); }

    bool is_lost() { return settings.drop > 0 && drawn(settings.seed, 0, drawn_letters++) < settings.drop; }
    void lose_some(std::string& text) {
        std::erase_if(text, [&](char) { return is_lost(); });
    }

    void serial_line(const std::string& line, bool too_long) {
        if (too_long)
            return bench.generator().note_error(521);
        if (!settings.on_demand) // a setting acts from now on
            bench.pass(std::min(now_of_bench() - bench.time(), 1.0));
        std::string answer = bench.command(line);
        if (!answer.empty()) {
            answer += "\r\n";
            lose_some(answer);
            if (to_serial.size() + answer.size() <= most_on_line)
                to_serial += answer;
            serial_due = Clock::now() + duration(settings.delay);
        }
        if (++line_count == settings.lines && !has_broken) {
            has_broken = true;
            terminal.reset();
            to_serial.clear();
            back_at = Clock::now() + duration(settings.broken);
        }
    }

    void read_serial() {
        std::array<char, 1024> buffer{};
        const ssize_t count = read(terminal->file(), buffer.data(), buffer.size());
        if (count <= 0)
            return;
        std::string text(buffer.data(), static_cast<std::size_t>(count));
        lose_some(text);
        serial_lines.add(text, [&](const std::string& line, bool too_long) {
            if (terminal)
                serial_line(line, too_long);
        });
    }

    void write_serial() {
        if (!terminal || to_serial.empty() || Clock::now() < serial_due)
            return;
        const ssize_t count = write(terminal->file(), to_serial.data(), to_serial.size());
        if (count > 0)
            to_serial.erase(0, static_cast<std::size_t>(count));
    }

    void accept_client() {
        const int file = accept4(listening.get(), nullptr, nullptr, SOCK_CLOEXEC | SOCK_NONBLOCK);
        if (file < 0)
            return;
        if (client.get() >= 0) {
            constexpr std::string_view busy = "ERROR somebody else is connected\n";
            send(file, busy.data(), busy.size(), MSG_NOSIGNAL);
            close(file);
            return;
        }
        const int yes = 1;
        setsockopt(file, IPPROTO_TCP, TCP_NODELAY, &yes, sizeof yes);
        client.reset(file);
        row_count = 0;
    }

    void drop_client() {
        client.reset();
        client_lines.clear();
        to_client.clear();
        protocol.forget();
    }

    void read_client() {
        std::array<char, 4096> buffer{};
        const ssize_t count = recv(client.get(), buffer.data(), buffer.size(), 0);
        if (count == 0 || (count < 0 && errno != EAGAIN && errno != EINTR))
            return drop_client();
        if (count < 0)
            return;
        bool good = true;
        client_lines.add({buffer.data(), static_cast<std::size_t>(count)}, [&](const std::string& line, bool too_long) {
            good = good && !too_long && protocol.receive(line);
        });
        if (!good || client_lines.is_too_long())
            drop_client();
    }

    void write_client() {
        if (client.get() < 0 || to_client.empty())
            return;
        const ssize_t count = send(client.get(), to_client.data(), to_client.size(), MSG_NOSIGNAL);
        if (count > 0)
            to_client.erase(0, static_cast<std::size_t>(count));
        else if (errno != EAGAIN && errno != EINTR)
            drop_client();
    }

    /// Fills the client's buffer with available data.
    void fill() {
        while (client.get() >= 0 && to_client.size() < most_to_send) {
            const bool reading = protocol.is_reading();
            std::string text = settings.on_demand ? protocol.next(SampleProtocol::rows_at_once)
                                                  : protocol.next(SampleProtocol::rows_at_once, now_of_bench());
            if (reading && settings.rows > 0) {
                row_count += static_cast<std::size_t>(std::count(text.begin(), text.end(), '\n'));
                if (row_count > settings.rows)
                    return drop_client();
            }
            to_client += text;
            if (text.empty() && protocol.is_reading() == reading)
                break;
        }
        if (!settings.on_demand && !protocol.is_reading())
            bench.pass(std::min(now_of_bench() - bench.time(), 1.0));
    }

    void wait() {
        // The first is the terminal, which may be missing; poll ignores negative files.
        std::array<pollfd, 3> files{
            {{terminal ? terminal->file() : -1, POLLIN, 0}, {listening.get(), POLLIN, 0}, {client.get(), POLLIN, 0}}};
        if (!to_client.empty())
            files[2].events |= POLLOUT;
        constexpr int idle = 50, ticking = 5; // ms
        const bool busy = settings.on_demand && protocol.is_reading() && to_client.size() < most_to_send;
        const bool ticks = !settings.on_demand || !to_serial.empty() || !terminal;
        if (poll(files.data(), files.size(), busy ? 0 : ticks ? ticking : idle) <= 0)
            return;
        if (terminal && (files[0].revents & POLLIN) != 0)
            read_serial();
        if (client.get() >= 0 && (files[2].revents & (POLLIN | POLLHUP | POLLERR)) != 0)
            read_client();
        if ((files[1].revents & POLLIN) != 0)
            accept_client();
    }

    void turn() {
        if (!terminal && Clock::now() >= back_at) {
            terminal.emplace(settings.port);
            serial_lines.clear();
        }
        wait();
        fill();
        write_serial();
        write_client();
    }
};

BenchService::BenchService(ScpiBench& bench, const ServiceSettings& settings) {
    settings.validate();
    state_ = std::make_unique<State>(bench, settings);
    state_->began_at = bench.time();
}

BenchService::~BenchService() = default;

std::uint16_t BenchService::tcp_port() const {
    sockaddr_in address{};
    socklen_t size = sizeof address;
    getsockname(state_->listening.get(), reinterpret_cast<sockaddr*>(&address), &size);
    return ntohs(address.sin_port);
}

void BenchService::run(const std::function<bool()>& stop) {
    state_->began = State::Clock::now();
    state_->began_at = state_->bench.time();
    while (!stop())
        state_->turn();
}

} // namespace graze
