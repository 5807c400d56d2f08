#include "page/timed_connection.hpp"

#include <poll.h>
#include <sys/socket.h>

#include <algorithm>
#include <cerrno>
#include <cstring>

namespace graze {

namespace {

constexpr std::size_t least_progress = std::size_t{64} << 10; ///< bytes that a client takes in the time for writing

} // namespace

TimedConnection::TimedConnection(int socket, const ConnectionLimits& limits)
    : socket_(socket), limits_(limits), read_until_(Clock::now() + limits.reading), left_(limits.header), buffer_() {}

bool TimedConnection::wait_for(short event, Clock::time_point until) const {
    for (;;) {
        const auto left = std::chrono::ceil<std::chrono::milliseconds>(until - Clock::now()).count();
        if (left <= 0)
            return false;
        pollfd one{socket_, event, 0};
        const int found = ::poll(&one, 1, static_cast<int>(left));
        if (found > 0)
            return true;
        if (found < 0 && errno != EINTR)
            return false;
    }
}

bool TimedConnection::is_readable() const {
    return next_ < buffered_ || wait_for(POLLIN, Clock::now() + std::chrono::milliseconds(1));
}

bool TimedConnection::is_writable() const {
    pollfd one{socket_, POLLRDHUP, 0};
    return ::poll(&one, 1, 0) == 0;
}

ssize_t TimedConnection::read(char* to, std::size_t size) {
    if (left_ == 0)
        return -1;
    if (next_ == buffered_) {
        if (!wait_for(POLLIN, read_until_)) {
            is_late_ = true;
            return -1;
        }
        const ssize_t count = ::recv(socket_, buffer_.data(), buffer_.size(), 0);
        if (count <= 0)
            return count;
        next_ = 0;
        buffered_ = static_cast<std::size_t>(count);
    }
    const std::size_t count = std::min({size, buffered_ - next_, left_});
    std::memcpy(to, buffer_.data() + next_, count);
    for (std::size_t i = 0; is_header_ && i < count; ++i) {
        line_ = to[i] == '\n' ? 0 : line_ + 1;
        longest_line_ = std::max(longest_line_, line_);
    }
    next_ += count;
    left_ -= count;
    return static_cast<ssize_t>(count);
}

ssize_t TimedConnection::write(const char* from, std::size_t size) {
    auto until = Clock::now() + limits_.writing;
    std::size_t written = 0, since = 0;
    has_written_ = true;
    while (written < size) {
        const ssize_t count = ::send(socket_, from + written, size - written, MSG_NOSIGNAL | MSG_DONTWAIT);
        if (count < 0 && errno != EAGAIN && errno != EINTR)
            return -1;
        if (count < 0 && !wait_for(POLLOUT, until))
            return -1;
        written += static_cast<std::size_t>(std::max<ssize_t>(count, 0));
        since += static_cast<std::size_t>(std::max<ssize_t>(count, 0));
        if (since >= least_progress) {
            since = 0;
            until = Clock::now() + limits_.writing;
        }
    }
    return static_cast<ssize_t>(written);
}

void TimedConnection::get_remote_ip_and_port(std::string& ip, int& port) const {
    ip = "127.0.0.1";
    port = 0;
}

void TimedConnection::get_local_ip_and_port(std::string& ip, int& port) const {
    get_remote_ip_and_port(ip, port);
}

void TimedConnection::finish() {
    ::shutdown(socket_, SHUT_WR);
    const auto until = Clock::now() + std::chrono::milliseconds(500);
    std::size_t most = 2 * limits_.body;
    while (most > 0 && wait_for(POLLIN, until)) {
        const ssize_t count = ::recv(socket_, buffer_.data(), buffer_.size(), 0);
        if (count <= 0)
            return;
        most -= std::min(most, static_cast<std::size_t>(count));
    }
}

} // namespace graze
