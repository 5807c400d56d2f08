#pragma once

#include <arpa/inet.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <cstdlib>
#include <string>
#include <string_view>
#include <utility>

namespace graze::testing {

/// A connection to a port of this machine that sends whatever it is told to.
class RawClient {
public:
    explicit RawClient(int port) : socket_(::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0)) {
        sockaddr_in address{};
        address.sin_family = AF_INET;
        address.sin_port = htons(static_cast<std::uint16_t>(port));
        address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
        connected_ = ::connect(socket_, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0;
    }
    ~RawClient() { ::close(socket_); }
    RawClient(const RawClient&) = delete;
    RawClient& operator=(const RawClient&) = delete;

    bool connected() const { return connected_; }

    /// @return false when the server takes no more
    bool send(std::string_view text) const {
        while (!text.empty()) {
            const ssize_t count = ::send(socket_, text.data(), text.size(), MSG_NOSIGNAL);
            if (count <= 0)
                return false;
            text.remove_prefix(static_cast<std::size_t>(count));
        }
        return true;
    }
    void end_sending() const { ::shutdown(socket_, SHUT_WR); }

    /// What the server has sent up to this text, or until it closes, or for at most the given time.
    std::string read_until(std::string_view end, std::chrono::milliseconds most = std::chrono::seconds(20)) {
        const auto until = std::chrono::steady_clock::now() + most;
        for (;;) {
            if (const auto found = received_.find(end); !end.empty() && found != std::string::npos) {
                std::string text = received_.substr(0, found + end.size());
                received_.erase(0, found + end.size());
                return text;
            }
            const auto left =
                std::chrono::ceil<std::chrono::milliseconds>(until - std::chrono::steady_clock::now()).count();
            pollfd one{socket_, POLLIN, 0};
            char buffer[4096];
            const ssize_t count = left > 0 && ::poll(&one, 1, static_cast<int>(left)) == 1
                                      ? ::recv(socket_, buffer, sizeof buffer, 0)
                                      : 0;
            if (count <= 0)
                return std::exchange(received_, {});
            received_.append(buffer, static_cast<std::size_t>(count));
        }
    }
    /// All that the server sends until it closes.
    std::string read_all(std::chrono::milliseconds most = std::chrono::seconds(20)) { return read_until("", most); }

private:
    int socket_;
    bool connected_ = false;
    std::string received_;
};

/// Sends a text and returns the whole answer.
inline std::string raw_answer(int port, std::string_view request) {
    RawClient client(port);
    client.send(request);
    return client.read_all();
}

/// The status of an answer; 0 if there was none.
inline int status_of(const std::string& answer) {
    return answer.starts_with("HTTP/1.1 ") ? std::atoi(answer.c_str() + 9) : 0;
}

inline std::string body_of(const std::string& answer) {
    const auto end = answer.find("\r\n\r\n");
    return end == std::string::npos ? "" : answer.substr(end + 4);
}

} // namespace graze::testing
