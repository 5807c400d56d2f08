#pragma once

#include <httplib.h>

#include <array>
#include <chrono>
#include <cstddef>
#include <string>

namespace graze {

/// What one connection may take.
struct ConnectionLimits {
    std::size_t header = std::size_t{32} << 10, body = std::size_t{4} << 20; ///< bytes
    std::chrono::milliseconds reading{10'000};                               ///< for a whole request
    std::chrono::milliseconds writing{10'000};                               ///< for each 64 KiB of an answer
};

/// A connection whose client cannot keep it open by being slow: a request must be there as a whole after some time, and
/// an answer must be taken at a least speed. It does not close the socket.
class TimedConnection : public httplib::Stream {
public:
    TimedConnection(int socket, const ConnectionLimits& limits);

    /// To be called between header and body of a request: the body has a limit of its own.
    void expect_body() {
        left_ = limits_.body + buffered_ - next_;
        is_header_ = false;
    }
    /// Whether more was sent than may be read, and nobody has been told so.
    bool is_overrun() const { return left_ == 0 && !has_written_; }
    /// Whether the request was not there in time.
    bool is_late() const { return is_late_; }
    /// Length of the longest line of the header that was read.
    std::size_t longest_line() const { return longest_line_; }

    bool is_readable() const override;
    /// Whether the client is still there.
    bool is_writable() const override;
    /// @return number of bytes; 0: the client has closed; -1: too late or too much
    ssize_t read(char* to, std::size_t size) override;
    /// Writes all, or returns -1.
    ssize_t write(const char* from, std::size_t size) override;
    void get_remote_ip_and_port(std::string& ip, int& port) const override;
    void get_local_ip_and_port(std::string& ip, int& port) const override;
    int socket() const override { return socket_; }

    /// Says that nothing follows, and takes what the client still sends for a short time: closing at once would make
    /// the system throw the answer away.
    void finish();

private:
    using Clock = std::chrono::steady_clock;
    bool wait_for(short event, Clock::time_point until) const;

    int socket_;
    ConnectionLimits limits_;
    Clock::time_point read_until_;
    std::size_t left_;              ///< bytes that may still be read
    std::array<char, 4096> buffer_; ///< read ahead, since lines are read byte by byte
    std::size_t next_ = 0, buffered_ = 0;
    bool has_written_ = false, is_late_ = false, is_header_ = true;
    std::size_t line_ = 0, longest_line_ = 0; ///< characters of the line of the header that is read, and most of one
};

} // namespace graze
