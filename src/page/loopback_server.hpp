#pragma once

#include "page/http_message.hpp"

#include <chrono>
#include <cstddef>
#include <functional>
#include <memory>
#include <optional>

namespace graze {

struct LoopbackLimits {
    std::size_t body = std::size_t{4} << 20;     ///< bytes of a request
    std::size_t connections = 32;                ///< at once
    std::size_t answers = std::size_t{64} << 20; ///< bytes of long answers that wait for their readers; then no others
    std::chrono::milliseconds patience{10'000};  ///< with slow clients: for a request, and for each 64 KiB of an answer
};

/// A server that only programs of this machine reach (127.0.0.1). Each connection has one request. Whatever a client
/// sends or leaves out, the server lives, and goes on answering others. It does not know whom to trust: see
/// RequestGuard. Where there are too many connections, the oldest one gives way to a new one, but for those with an
/// accepted request that has the header Authorization.
class LoopbackServer {
public:
    /// Called with a request whose body has not been read; an answer refuses it.
    using Examine = std::function<std::optional<HttpAnswer>(const HttpRequest& request)>;
    /// Called by the thread of a connection; should not throw.
    using Answer = std::function<HttpAnswer(const HttpRequest& request)>;

    /// Takes the port, but answers nothing yet. @param port 0: a free one
    /// @throws InputError when another program has the port
    explicit LoopbackServer(int port, const LoopbackLimits& limits = {});
    ~LoopbackServer(); ///< stops
    LoopbackServer(const LoopbackServer&) = delete;
    LoopbackServer& operator=(const LoopbackServer&) = delete;

    int port() const;
    /// Answers requests in threads of its own. To be called once.
    void start(Examine examine, Answer answer);
    /// Ends all connections. Called again it does nothing.
    void stop();

private:
    class Implementation;
    std::unique_ptr<Implementation> implementation_;
};

} // namespace graze
