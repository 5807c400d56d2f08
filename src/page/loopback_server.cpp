#include "page/loopback_server.hpp"

#include "graze/base/input_error.hpp"
#include "graze/base/printable.hpp"
#include "page/error_answer.hpp"
#include "page/timed_connection.hpp"

#include <fcntl.h>
#include <strings.h>
#include <sys/socket.h>
#include <unistd.h>

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <charconv>
#include <csignal>
#include <list>
#include <mutex>
#include <set>
#include <thread>

namespace graze {

namespace {

/// httplib's server ignores SIGPIPE in the whole process; here the signal cannot come, and others may want it.
class SignalKept {
public:
    SignalKept() { sigaction(SIGPIPE, nullptr, &before_); }
    ~SignalKept() { sigaction(SIGPIPE, &before_, nullptr); }
    SignalKept(const SignalKept&) = delete;
    SignalKept& operator=(const SignalKept&) = delete;

private:
    struct sigaction before_ {};
};

/// A header that must not be given twice.
std::optional<std::string> only_header(const httplib::Request& request, const char* name) {
    return request.get_header_value_count(name) == 1 ? std::optional(request.get_header_value(name)) : std::nullopt;
}

/// What a connection is good for. A dropped one ends.
enum class Standing { unknown, accepted, dropped };

/// One connection, as long as its thread lives.
struct Connection {
    int socket = -1;
    std::thread thread{};
    std::atomic<Standing> standing = Standing::unknown;
    std::atomic<bool> ended = false;
    TimedConnection* stream = nullptr; ///< used by its thread
    std::size_t held = 0;              ///< bytes of its answer, if that is long; used by its thread
};

/// That of this thread.
thread_local Connection* own_connection = nullptr;

HttpRequest read_request(const httplib::Request& request) {
    HttpRequest result{request.method, request.path};
    for (const auto& [name, value] : request.params)
        result.query.emplace(name, value);
    result.origin.host = only_header(request, "Host");
    // A second one is no reason to take the request for one without.
    if (request.has_header("Origin"))
        result.origin.origin = only_header(request, "Origin").value_or("");
    result.origin.authorization = only_header(request, "Authorization");
    if (const auto token = result.query.find("token"); token != result.query.end())
        result.origin.token = token->second;
    result.body = request.body;
    result.has_left = [stream = own_connection->stream] { return !stream->is_writable(); };
    return result;
}

/// Refuses an address of which one reader could take another part than the next one.
std::optional<HttpAnswer> refuse_repeated(const httplib::Request& request) {
    // httplib drops a part that is there twice with the same value.
    std::multiset<std::string> parts;
    for (std::size_t begin = request.target.find('?'); begin != std::string::npos;) {
        const std::size_t end = request.target.find('&', ++begin);
        parts.insert(request.target.substr(begin, end == std::string::npos ? end : end - begin));
        begin = end;
    }
    const auto repeated =
        std::ranges::find_if(parts, [&](const std::string& part) { return !part.empty() && parts.count(part) > 1; });
    std::string name = repeated == parts.end() ? "" : repeated->substr(0, repeated->find('='));
    for (const auto& [one, value] : request.params)
        if (request.params.count(one) > 1)
            name = one;
    if (name.empty())
        return std::nullopt;
    return error_answer(400, fmt::format("the address has '{}' twice", printable_line(shortened(name, 100))),
                        "give it once");
}

/// Whether a header Content-Type says that a body is JSON, which is in UTF-8 if it says more.
bool is_json_type(const std::string& type) {
    const auto trimmed = [](std::string_view text) {
        const auto begin = text.find_first_not_of(" \t");
        return begin == std::string_view::npos
                   ? std::string()
                   : std::string(text.substr(begin, text.find_last_not_of(" \t") - begin + 1));
    };
    const auto is = [](const std::string& text, const char* other) { return ::strcasecmp(text.c_str(), other) == 0; };
    const auto end = type.find(';');
    if (!is(trimmed(type.substr(0, end)), "application/json"))
        return false;
    const std::string more = end == std::string::npos ? "" : trimmed(type.substr(end + 1));
    return more.empty() || is(more, "charset=utf-8") || is(more, "charset=\"utf-8\"");
}

/// Refuses bodies that could be longer than they seem, and those of forms, which pages of other origins may send.
std::optional<HttpAnswer> refuse_body(const httplib::Request& request, std::size_t most) {
    const std::optional<std::string> length = only_header(request, "Content-Length");
    const bool wants_body = request.method == "POST" || request.method == "PUT";
    if (request.has_header("Transfer-Encoding") || request.has_header("Content-Encoding"))
        return error_answer(411, "the body is sent in parts or compressed", "send it as it is, with its length");
    if (!length && (wants_body || request.has_header("Content-Length")))
        return error_answer(411, "the request does not say how long its body is", "send a header Content-Length");
    if (!length)
        return std::nullopt;
    std::size_t bytes = 0;
    const auto [end, error] = std::from_chars(length->data(), length->data() + length->size(), bytes);
    if (error == std::errc::invalid_argument || end != length->data() + length->size())
        return error_answer(400, "the header Content-Length is no number", "send the number of bytes");
    if (error != std::errc() || bytes > most)
        return error_answer(413, fmt::format("the body is longer than {} MiB", most >> 20), "send less at once");
    if (bytes > 0 && !wants_body)
        return error_answer(400, "the request has a body", "send it without");
    if (wants_body && !is_json_type(only_header(request, "Content-Type").value_or("")))
        return error_answer(415, "the body is not declared as JSON in UTF-8",
                            "send one header Content-Type: application/json");
    return std::nullopt;
}

/// What httplib refuses itself, with no more than a status.
HttpAnswer refusal_of(int status, const TimedConnection& stream) {
    constexpr std::size_t longest_line = CPPHTTPLIB_HEADER_MAX_LENGTH;
    if (stream.is_late())
        return error_answer(408, "the request was not there as a whole in time", "send it at once");
    if (status == 414)
        return error_answer(414, "the address is longer than 8 KiB", "send a shorter one");
    if (stream.is_overrun() || stream.longest_line() > longest_line)
        return error_answer(431, "the address and the headers are too long",
                            "send at most 32 KiB of them, and 8 KiB in one line");
    if (status == 416)
        return error_answer(416, "the header Range is not understood", "leave it out: answers are given as a whole");
    return error_answer(status, "the request is not understood", "send plain HTTP/1.1");
}

void give_answer(HttpAnswer answer, httplib::Response& response) {
    response.status = answer.status;
    for (const auto& [name, value] : answer.headers)
        response.set_header(name, value);
    if (!answer.more) {
        response.set_content("", answer.type);
        response.body = std::move(answer.body);
        return;
    }
    response.set_chunked_content_provider(answer.type, [more = answer.more](std::size_t, httplib::DataSink& given) {
        bool taken = true;
        const AnswerSink sink{[&](std::string_view part) { return taken = given.write(part.data(), part.size()); },
                              [&] { return given.is_writable(); }};
        if (!more(sink) && taken)
            given.done();
        return taken;
    });
}

HttpAnswer too_many_connections() {
    return error_answer(503, "there are too many connections", "close other windows of the page, and try again");
}

/// An answer without the help of httplib, to what never became a request.
std::string plain_text_of(std::string_view status, const HttpAnswer& answer) {
    return fmt::format("HTTP/1.1 {}\r\nContent-Type: {}\r\nContent-Length: {}\r\nConnection: close\r\n\r\n{}", status,
                       answer.type, answer.body.size(), answer.body);
}

/// Takes one of unknown standing for something else. @return false: it was something else before
bool become(std::atomic<Standing>& standing, Standing other) {
    Standing unknown = Standing::unknown;
    return standing.compare_exchange_strong(unknown, other);
}

} // namespace

class LoopbackServer::Implementation : private httplib::Server {
public:
    Implementation(int port, const LoopbackLimits& limits) : limits_(limits) {
        set_address_family(AF_INET);
        // The default would let another process take the same port.
        set_socket_options([](int socket) {
            const int yes = 1;
            setsockopt(socket, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes);
        });
        set_tcp_nodelay(true);
        port_ = port == 0 ? bind_to_any_port("127.0.0.1") : bind_to_port("127.0.0.1", port) ? port : -1;
        if (port_ <= 0)
            throw InputError(port == 0 ? std::string("no port of 127.0.0.1 is free")
                                       : fmt::format("port {} cannot be taken: another program may have it", port),
                             "choose another port");
        ::listen(svr_sock_, static_cast<int>(limits.connections)); // a longer queue than that of httplib
        set_payload_max_length(limits.body);
        // Connections have threads, but this one decides whether there are too many.
        new_task_queue = [this] { return new AtOnce(*this); };
    }

    int port() const { return port_; }

    void start(Examine examine, Answer answer) {
        set_pre_routing_handler(
            [this, examine = std::move(examine)](const httplib::Request& request, httplib::Response& response) {
                std::optional<HttpAnswer> refusal = examine(read_request(request));
                // Only who is accepted with a token keeps its place when there are too many connections.
                if (!refusal && request.has_header("Authorization") &&
                    !become(own_connection->standing, Standing::accepted))
                    refusal = too_many_connections();
                if (!refusal)
                    refusal = refuse_repeated(request);
                if (!refusal)
                    refusal = refuse_body(request, limits_.body);
                if (!refusal)
                    return HandlerResponse::Unhandled;
                give_answer(std::move(*refusal), response);
                return HandlerResponse::Handled;
            });
        const Handler handler = [this, answer = std::move(answer)](const httplib::Request& request,
                                                                   httplib::Response& response) {
            give_answer(held(answer(read_request(request))), response);
        };
        // Paths that are not known, as long ones, have been refused before.
        Get(".*", handler).Post(".*", handler).Put(".*", handler).Delete(".*", handler);
        // Of requests that httplib refuses itself.
        set_error_handler(Handler([](const httplib::Request& request, httplib::Response& response) {
            // Of ranges that are wrong httplib would still cut the first ones out of this answer. It is its own
            // request, which is not constant.
            const_cast<httplib::Request&>(request).ranges.clear(); // NOLINT(cppcoreguidelines-pro-type-const-cast)
            if (response.body.empty())
                give_answer(refusal_of(response.status, *own_connection->stream), response);
        }));
        listener_ = std::thread([this] { listen_after_bind(); });
        while (!is_running()) // until then it could not be stopped
            std::this_thread::yield();
    }

    void stop_serving() {
        if (listener_.joinable()) {
            stop();
            listener_.join();
        } else if (const int socket = svr_sock_.exchange(INVALID_SOCKET); socket != INVALID_SOCKET) {
            ::close(socket);
        }
    }

private:
    /// Runs what httplib hands over in the thread that accepts connections.
    class AtOnce : public httplib::TaskQueue {
    public:
        explicit AtOnce(Implementation& server) : server_(&server) {}
        void enqueue(std::function<void()> work) override { work(); }
        void shutdown() override { server_->end_connections(); }

    private:
        Implementation* server_;
    };

    bool process_and_close_socket(int socket) override {
        ::fcntl(socket, F_SETFD, FD_CLOEXEC);
        forget_ended();
        if (connections_.size() >= limits_.connections && !make_room()) {
            refuse(socket);
            return false;
        }
        try {
            Connection& connection = connections_.emplace_back();
            connection.socket = socket;
            connection.thread = std::thread([this, &connection] { serve(connection); });
        } catch (const std::exception&) { // no memory or no thread is left for it
            connections_.pop_back();
            refuse(socket);
        }
        return true;
    }

    /// Drops the oldest connection that has no accepted request: those who know no token cannot keep others out by
    /// sending nothing, or by not reading what refuses them.
    bool make_room() {
        const auto oldest =
            std::ranges::find_if(connections_, [](Connection& one) { return become(one.standing, Standing::dropped); });
        if (oldest == connections_.end())
            return false;
        {
            const std::lock_guard lock(mutex_);
            if (oldest->socket >= 0)
                ::shutdown(oldest->socket, SHUT_RDWR);
        }
        oldest->thread.join();
        connections_.erase(oldest);
        return true;
    }

    /// Counts a long answer, which is in memory until its client has read it.
    HttpAnswer held(HttpAnswer answer) {
        constexpr std::size_t shortest_counted = std::size_t{16} << 10;
        const std::size_t size = answer.body.size();
        if (size < shortest_counted)
            return answer;
        // One long answer is always given, whatever its length.
        if (held_.fetch_add(size) >= limits_.answers) {
            held_ -= size;
            return error_answer(503, "clients have not read the answers that they asked for",
                                "read them, or close their connections, and ask again");
        }
        own_connection->held = size;
        return answer;
    }

    void serve(Connection& connection) {
        own_connection = &connection;
        try {
            TimedConnection stream(connection.socket,
                                   {ConnectionLimits{}.header, limits_.body, limits_.patience, limits_.patience});
            connection.stream = &stream;
            bool closed = false;
            process_request(stream, true, closed, [&](httplib::Request& request) {
                stream.expect_body();
                // Within one machine, compressing takes longer than sending.
                request.headers.erase("Accept-Encoding");
                request.headers.erase("Range");
                request.ranges.clear();
            });
            if (stream.is_overrun()) { // httplib reads no line that is longer
                const std::string text = plain_text_of("431 Request Header Fields Too Large", refusal_of(431, stream));
                stream.write(text.data(), text.size());
            }
            stream.finish();
        } catch (...) { // NOLINT(bugprone-empty-catch): as without memory; this connection ends, others go on
        }
        held_ -= connection.held;
        const std::lock_guard lock(mutex_);
        ::close(connection.socket);
        connection.socket = -1;
        connection.ended = true;
    }

    static void refuse(int socket) {
        const std::string text = plain_text_of("503 Service Unavailable", too_many_connections());
        [[maybe_unused]] const ssize_t sent = ::send(socket, text.data(), text.size(), MSG_NOSIGNAL | MSG_DONTWAIT);
        ::shutdown(socket, SHUT_RDWR);
        ::close(socket);
    }

    void forget_ended() {
        connections_.remove_if([](Connection& connection) {
            if (!connection.ended)
                return false;
            connection.thread.join();
            return true;
        });
    }

    /// Clients of accepted requests get the answers that are being made, if they read them at once.
    void end_connections() {
        const auto until = std::chrono::steady_clock::now() + std::chrono::seconds(1);
        const auto is_answered = [](const Connection& one) { return one.standing == Standing::accepted && !one.ended; };
        while (std::chrono::steady_clock::now() < until && std::ranges::any_of(connections_, is_answered))
            std::this_thread::sleep_for(std::chrono::milliseconds(5));
        {
            const std::lock_guard lock(mutex_);
            for (const Connection& connection : connections_)
                if (connection.socket >= 0)
                    ::shutdown(connection.socket, SHUT_RDWR);
        }
        for (Connection& connection : connections_)
            connection.thread.join();
        connections_.clear();
    }

    LoopbackLimits limits_;
    std::atomic<std::size_t> held_ = 0; ///< bytes of long answers that are in memory
    int port_ = -1;
    std::thread listener_;
    std::list<Connection> connections_; ///< used by the thread that accepts them only, but for their sockets
    std::mutex mutex_;                  ///< of sockets, which must not be closed while they are shut down
};

LoopbackServer::LoopbackServer(int port, const LoopbackLimits& limits) {
    const SignalKept kept;
    implementation_ = std::make_unique<Implementation>(port, limits);
}

LoopbackServer::~LoopbackServer() {
    stop();
}

int LoopbackServer::port() const {
    return implementation_->port();
}

void LoopbackServer::start(Examine examine, Answer answer) {
    implementation_->start(std::move(examine), std::move(answer));
}

void LoopbackServer::stop() {
    implementation_->stop_serving();
}

} // namespace graze
