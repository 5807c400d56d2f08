#include "page/loopback_server.hpp"

#include "graze/base/input_error.hpp"
#include "page/raw_client.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <csignal>
#include <memory>
#include <thread>
#include <vector>

namespace graze {
namespace {

using testing::body_of;
using testing::raw_answer;
using testing::RawClient;
using testing::status_of;

constexpr const char* simple_get = "GET /known HTTP/1.1\r\nHost: a\r\n\r\n";

/// A server that knows one path, and answers with what it was asked.
class EchoServer {
public:
    explicit EchoServer(const LoopbackLimits& limits = {}) : server_(0, limits) {
        server_.start(
            [](const HttpRequest& request) -> std::optional<HttpAnswer> {
                if (request.path == "/known")
                    return std::nullopt;
                HttpAnswer answer;
                answer.status = 404;
                answer.body = "unknown";
                return answer;
            },
            [this](const HttpRequest& request) {
                ++answered;
                HttpAnswer answer;
                answer.type = "text/plain";
                answer.body = request.method + " " + request.body;
                answer.headers = {{"X-Extra", "yes"}};
                return answer;
            });
    }
    int port() const { return server_.port(); }
    LoopbackServer& server() { return server_; }
    bool lives() const { return body_of(raw_answer(port(), simple_get)) == "GET "; }

    std::atomic<int> answered = 0;

private:
    LoopbackServer server_;
};

std::string post_of(const std::string& body, const std::string& headers = "") {
    return "POST /known HTTP/1.1\r\nHost: a\r\nContent-Type: application/json\r\nContent-Length: " +
           std::to_string(body.size()) + "\r\n" + headers + "\r\n" + body;
}

TEST(LoopbackServer, AnswersAndClosesTheConnection) {
    const EchoServer server;
    const std::string answer = raw_answer(server.port(), simple_get);
    EXPECT_EQ(status_of(answer), 200);
    EXPECT_EQ(body_of(answer), "GET ");
    EXPECT_NE(answer.find("X-Extra: yes\r\n"), std::string::npos);
    EXPECT_NE(answer.find("Connection: close\r\n"), std::string::npos);
    EXPECT_EQ(body_of(raw_answer(server.port(), post_of("{}"))), "POST {}");
    EXPECT_EQ(body_of(raw_answer(server.port(), post_of("[1]", "Accept-Encoding: gzip, br\r\n"))), "POST [1]");
}

TEST(LoopbackServer, ListensOnTheLoopbackInterfaceOnly) {
    const EchoServer server;
    // The whole network 127/8 leads to this machine; a server on all interfaces would answer there too.
    const int socket = ::socket(AF_INET, SOCK_STREAM, 0);
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_port = htons(static_cast<std::uint16_t>(server.port()));
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK + 1);
    EXPECT_NE(::connect(socket, reinterpret_cast<const sockaddr*>(&address), sizeof address), 0);
    ::close(socket);
}

TEST(LoopbackServer, RefusesAPortThatIsTaken) {
    const EchoServer server;
    EXPECT_THROW(LoopbackServer{server.port()}, InputError);
}

TEST(LoopbackServer, LeavesTheSignalsOfTheProcessAlone) {
    const auto before = std::signal(SIGPIPE, SIG_DFL);
    const EchoServer server;
    EXPECT_EQ(std::signal(SIGPIPE, before), SIG_DFL);
}

TEST(LoopbackServer, RefusesWhatItDoesNotKnowBeforeReadingIt) {
    const EchoServer server;
    EXPECT_EQ(status_of(raw_answer(server.port(), "GET /other HTTP/1.1\r\nHost: a\r\n\r\n")), 404);
    // The body that is announced never comes.
    EXPECT_EQ(status_of(raw_answer(server.port(), "POST /other HTTP/1.1\r\nHost: a\r\nContent-Length: 1000\r\n\r\n")),
              404);
    EXPECT_EQ(server.answered, 0);
}

TEST(LoopbackServer, RefusesBodiesThatAreTooLongOrDisguised) {
    const EchoServer server;
    const auto status = [&](const std::string& headers, const std::string& method = "POST") {
        return status_of(raw_answer(server.port(), method + " /known HTTP/1.1\r\nHost: a\r\n" + headers + "\r\n"));
    };
    const std::string json = "Content-Type: application/json\r\n";
    EXPECT_EQ(status(json + "Content-Length: 4194305\r\n"), 413);
    EXPECT_EQ(status(json + "Content-Length: 99999999999999999999999\r\n"), 413);
    EXPECT_EQ(status(json + "Content-Length: -1\r\n"), 400);
    EXPECT_EQ(status(json + "Content-Length: 1x\r\n"), 400);
    EXPECT_EQ(status(json), 411);
    EXPECT_EQ(status(json + "Content-Length: 1\r\nContent-Length: 2\r\n"), 411);
    EXPECT_EQ(status(json + "Transfer-Encoding: chunked\r\n"), 411);
    EXPECT_EQ(status(json + "Content-Length: 10\r\nContent-Encoding: gzip\r\n"), 411);
    EXPECT_EQ(status("Content-Type: text/plain\r\nContent-Length: 2\r\n"), 415);
    EXPECT_EQ(status("Content-Type: multipart/form-data; boundary=x\r\nContent-Length: 2\r\n"), 415);
    EXPECT_EQ(status("Content-Type: application/jsonx\r\nContent-Length: 2\r\n"), 415);
    EXPECT_EQ(status("Content-Type: application/json; charset=utf-16\r\nContent-Length: 2\r\n"), 415);
    EXPECT_EQ(status(json + json + "Content-Length: 2\r\n"), 415);
    EXPECT_EQ(status("Content-Length: 2\r\n", "GET"), 400);
    EXPECT_EQ(server.answered, 0);
    EXPECT_TRUE(server.lives());
}

TEST(LoopbackServer, TakesTheTypeOfJsonInAnyForm) {
    const EchoServer server;
    for (const std::string type : {"application/json", "Application/JSON", "application/json; charset=UTF-8",
                                   "application/json ;charset=\"utf-8\"", "application/json;"})
        EXPECT_EQ(status_of(raw_answer(server.port(), "POST /known HTTP/1.1\r\nHost: a\r\nContent-Type: " + type +
                                                          "\r\nContent-Length: 2\r\n\r\n{}")),
                  200)
            << type;
}

TEST(LoopbackServer, RefusesAnAddressWithTwoValuesOfOneName) {
    const EchoServer server;
    EXPECT_EQ(status_of(raw_answer(server.port(), "GET /known?a=1&b=1 HTTP/1.1\r\nHost: a\r\n\r\n")), 200);
    const std::string refused = raw_answer(server.port(), "GET /known?a=1&b=1&a=1 HTTP/1.1\r\nHost: a\r\n\r\n");
    EXPECT_EQ(status_of(refused), 400);
    EXPECT_NE(refused.find("the address has 'a' twice"), std::string::npos) << refused;
    EXPECT_EQ(status_of(raw_answer(server.port(), "GET /known?a=1&a=2 HTTP/1.1\r\nHost: a\r\n\r\n")), 400);
    EXPECT_EQ(status_of(raw_answer(server.port(), "GET /known?a=1&%61=2 HTTP/1.1\r\nHost: a\r\n\r\n")), 400);
}

TEST(LoopbackServer, SaysWhatItDoesNotTake) {
    const EchoServer server;
    const auto body = [&](const std::string& text) { return body_of(raw_answer(server.port(), text)); };
    EXPECT_NE(body("GET /" + std::string(9000, 'x') + " HTTP/1.1\r\n\r\n").find("the address is longer"),
              std::string::npos);
    EXPECT_NE(body("GET /known HTTP/1.1\r\nX: " + std::string(9000, 'x') + "\r\n\r\n").find("too long"),
              std::string::npos);
    EXPECT_NE(body("GET /known HTTP/1.1\r\nRange: bytes=x\r\n\r\n").find("Range"), std::string::npos);
}

TEST(LoopbackServer, TakesABodyOfTheGreatestLengthAndAnswersWholeOneThatIsLonger) {
    LoopbackLimits limits;
    limits.body = 100'000;
    const EchoServer server(limits);
    const std::string most(limits.body, 'x');
    EXPECT_EQ(body_of(raw_answer(server.port(), post_of(most))), "POST " + most);
    // The client has sent all of it before it reads the answer.
    EXPECT_EQ(status_of(raw_answer(server.port(), post_of(most + "x"))), 413);
}

TEST(LoopbackServer, SurvivesGarbage) {
    const EchoServer server;
    const auto status = [&](const std::string& text) { return status_of(raw_answer(server.port(), text)); };
    EXPECT_EQ(status("garbage\r\n\r\n"), 400);
    EXPECT_EQ(status("GET /known HTTP/9.9\r\n\r\n"), 400);
    EXPECT_EQ(status("FROB /known HTTP/1.1\r\n\r\n"), 400);
    EXPECT_EQ(status("GET /known extra HTTP/1.1\r\n\r\n"), 400);
    EXPECT_EQ(status(std::string("\x16\x03\x01\x02\x00\x01\x00\r\n\r\n", 11)), 400); // as of a client that wants TLS
    EXPECT_EQ(status("GET /" + std::string(9000, 'x') + " HTTP/1.1\r\nHost: a\r\n\r\n"), 414);
    EXPECT_EQ(status("GET /known HTTP/1.1\r\nX: " + std::string(9000, 'x') + "\r\n\r\n"), 431);
    EXPECT_EQ(status("GET /known HTTP/1.1\r\nRange: bytes=" + std::string(8000, '1') + "-\r\n\r\n"), 416);
    EXPECT_EQ(status("GET /known HTTP/1.1\r\nRange: bytes=0-1,0-1,0-1\r\nHost: a\r\n\r\n"), 200);
    const std::string ranges = raw_answer(server.port(), "GET /known HTTP/1.1\r\nRange: bytes=0-0,1-1,5-2\r\n\r\n");
    EXPECT_EQ(status_of(ranges), 416);
    EXPECT_EQ(ranges.find("multipart"), std::string::npos) << ranges;
    EXPECT_NE(body_of(ranges).find("\"problem\""), std::string::npos) << ranges;
    EXPECT_EQ(status("GET /" + std::string(std::size_t{1} << 20, 'x') + " HTTP/1.1\r\nHost: a\r\n\r\n"), 431);
    std::string many = "GET /known HTTP/1.1\r\n";
    for (int i = 0; i < 5000; ++i)
        many += "X" + std::to_string(i) + ": y\r\n";
    EXPECT_EQ(status(many + "\r\n"), 431);
    EXPECT_EQ(status("GET /known HTTP/1.1\r\nHost: a\r\n\r\nGARBAGE that follows\r\n\r\n"), 200);
    EXPECT_TRUE(server.lives());
}

TEST(LoopbackServer, WaitsForSlowClientsOnlyForAWhile) {
    LoopbackLimits limits;
    limits.patience = std::chrono::milliseconds(150);
    const EchoServer server(limits);
    RawClient silent(server.port()), half(server.port()), halfway(server.port());
    half.send("GET /known HT");
    halfway.send("POST /known HTTP/1.1\r\nHost: a\r\nContent-Type: application/json\r\nContent-Length: 10\r\n\r\n{");
    RawClient slow(server.port());
    const auto begun = std::chrono::steady_clock::now();
    // It never waits for longer than the server does, but for the whole it takes too long.
    for (int i = 0; i < 100 && slow.send("X"); ++i)
        std::this_thread::sleep_for(std::chrono::milliseconds(10));
    EXPECT_LT(std::chrono::steady_clock::now() - begun, std::chrono::seconds(5));
    EXPECT_EQ(silent.read_all(), "");
    half.read_all();
    const std::string late = halfway.read_all();
    EXPECT_EQ(status_of(late), 408);
    EXPECT_NE(late.find("in time"), std::string::npos) << late;
    EXPECT_EQ(server.answered, 0);
    EXPECT_TRUE(server.lives());
}

TEST(LoopbackServer, TakesSoManyConnectionsAndNoMore) {
    LoopbackLimits limits;
    limits.connections = 3;
    std::atomic<int> waiting = 0;
    std::atomic<bool> held = true;
    LoopbackServer server(0, limits);
    server.start([](const HttpRequest&) { return std::nullopt; },
                 [&](const HttpRequest&) {
                     for (++waiting; held;)
                         std::this_thread::sleep_for(std::chrono::milliseconds(1));
                     return HttpAnswer();
                 });
    const std::string accepted = "GET /known HTTP/1.1\r\nHost: a\r\nAuthorization: b\r\n\r\n";
    std::vector<std::unique_ptr<RawClient>> clients;
    for (int i = 0; i < 3; ++i) {
        clients.push_back(std::make_unique<RawClient>(server.port()));
        clients.back()->send(accepted);
    }
    while (waiting < 3)
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
    const std::string refused = raw_answer(server.port(), "");
    EXPECT_EQ(status_of(refused), 503);
    EXPECT_NE(body_of(refused).find("too many connections"), std::string::npos) << refused;
    held = false;
    for (const auto& client : clients)
        EXPECT_EQ(status_of(client->read_all()), 200);
    clients.clear();
    bool lives = false;
    for (int i = 0; i < 200 && !lives; ++i, std::this_thread::sleep_for(std::chrono::milliseconds(5)))
        lives = status_of(raw_answer(server.port(), accepted)) == 200;
    EXPECT_TRUE(lives);
}

TEST(LoopbackServer, CannotBeLockedByThoseWhoSendNothing) {
    LoopbackLimits limits;
    limits.connections = 3;
    const EchoServer server(limits);
    std::vector<std::unique_ptr<RawClient>> clients;
    for (int i = 0; i < 10; ++i) {
        clients.push_back(std::make_unique<RawClient>(server.port()));
        clients.back()->send("GET /kn");
    }
    EXPECT_EQ(clients.front()->read_all(), ""); // the oldest have given way
    EXPECT_TRUE(server.lives());
}

TEST(LoopbackServer, GivesAnAnswerInPartsUntilItsEnd) {
    std::atomic<bool> left = false;
    LoopbackServer server(0);
    server.start([](const HttpRequest&) { return std::optional<HttpAnswer>(); },
                 [&](const HttpRequest& request) {
                     HttpAnswer answer;
                     answer.type = "text/event-stream";
                     const bool endless = request.path == "/endless";
                     auto count = std::make_shared<int>(0);
                     answer.more = [&, count, endless](const AnswerSink& sink) {
                         if (!sink.is_open() || !sink.write("part " + std::to_string(++*count) + "\n")) {
                             left = true;
                             return false;
                         }
                         return endless || *count < 3;
                     };
                     return answer;
                 });
    const std::string answer = raw_answer(server.port(), "GET / HTTP/1.1\r\nHost: a\r\n\r\n");
    EXPECT_NE(answer.find("part 1\n"), std::string::npos);
    EXPECT_TRUE(answer.ends_with("part 3\n\r\n0\r\n\r\n")) << answer;
    EXPECT_FALSE(left);
    {
        RawClient client(server.port());
        client.send("GET /endless HTTP/1.1\r\nHost: a\r\n\r\n");
        EXPECT_NE(client.read_until("part 5\n"), "");
    }
    for (int i = 0; i < 400 && !left; ++i)
        std::this_thread::sleep_for(std::chrono::milliseconds(5));
    EXPECT_TRUE(left) << "it goes on writing to a client that has left";
}

TEST(LoopbackServer, LetsNoClientThatDoesNotReadStayForever) {
    LoopbackLimits limits;
    limits.patience = std::chrono::milliseconds(100);
    std::atomic<bool> ended = false;
    LoopbackServer server(0, limits);
    server.start([](const HttpRequest&) { return std::optional<HttpAnswer>(); },
                 [&](const HttpRequest&) {
                     HttpAnswer answer;
                     answer.more = [&](const AnswerSink& sink) {
                         const bool taken = sink.write(std::string(100'000, 'x'));
                         ended = !taken;
                         return taken;
                     };
                     return answer;
                 });
    RawClient client(server.port());
    client.send("GET / HTTP/1.1\r\nHost: a\r\n\r\n");
    for (int i = 0; i < 1000 && !ended; ++i)
        std::this_thread::sleep_for(std::chrono::milliseconds(5));
    EXPECT_TRUE(ended);
}

TEST(LoopbackServer, KnowsThatAClientHasLeft) {
    std::atomic<int> asked = 0;
    std::atomic<bool> left = false;
    LoopbackServer server(0);
    server.start([](const HttpRequest&) { return std::nullopt; },
                 [&](const HttpRequest& request) {
                     for (int i = 0; i < 2000 && !left; ++i, ++asked) {
                         left = request.has_left();
                         std::this_thread::sleep_for(std::chrono::milliseconds(5));
                     }
                     return HttpAnswer();
                 });
    {
        RawClient client(server.port());
        client.send(simple_get);
        while (asked < 5)
            std::this_thread::sleep_for(std::chrono::milliseconds(1));
        EXPECT_FALSE(left);
    }
    for (int i = 0; i < 1000 && !left; ++i)
        std::this_thread::sleep_for(std::chrono::milliseconds(5));
    EXPECT_TRUE(left);
}

TEST(LoopbackServer, HoldsSoManyUnreadBytesAndNoMore) {
    LoopbackLimits limits;
    limits.answers = 100'000;
    constexpr std::size_t longer_than_what_the_system_holds = std::size_t{30} << 20;
    std::atomic<int> made = 0;
    LoopbackServer server(0, limits);
    server.start([](const HttpRequest&) { return std::nullopt; },
                 [&](const HttpRequest& request) {
                     HttpAnswer answer;
                     answer.body =
                         request.path == "/short" ? "short" : std::string(longer_than_what_the_system_holds, 'x');
                     ++made;
                     return answer;
                 });
    const std::string get_long = "GET /long HTTP/1.1\r\nHost: a\r\n\r\n";
    {
        RawClient unread(server.port());
        unread.send(get_long);
        while (made == 0)
            std::this_thread::sleep_for(std::chrono::milliseconds(1));
        std::this_thread::sleep_for(std::chrono::milliseconds(50));
        const std::string refused = raw_answer(server.port(), get_long);
        EXPECT_EQ(status_of(refused), 503);
        EXPECT_NE(refused.find("have not read the answers"), std::string::npos);
        EXPECT_EQ(body_of(raw_answer(server.port(), "GET /short HTTP/1.1\r\nHost: a\r\n\r\n")), "short");
        EXPECT_EQ(body_of(unread.read_all()).size(), longer_than_what_the_system_holds);
    }
    bool given = false;
    for (int i = 0; i < 200 && !given; ++i, std::this_thread::sleep_for(std::chrono::milliseconds(5)))
        given = status_of(raw_answer(server.port(), get_long)) == 200;
    EXPECT_TRUE(given);
}

TEST(LoopbackServer, AnswersWhatRunsBeforeItEnds) {
    std::atomic<bool> runs = false;
    LoopbackServer server(0);
    server.start([](const HttpRequest&) { return std::nullopt; },
                 [&](const HttpRequest&) {
                     runs = true;
                     std::this_thread::sleep_for(std::chrono::milliseconds(200));
                     return HttpAnswer();
                 });
    RawClient client(server.port());
    client.send("GET /known HTTP/1.1\r\nHost: a\r\nAuthorization: b\r\n\r\n");
    while (!runs)
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
    std::thread stopping([&] { server.stop(); });
    EXPECT_EQ(status_of(client.read_all()), 200);
    stopping.join();
}

TEST(LoopbackServer, StopsWhileClientsWait) {
    EchoServer server;
    RawClient silent(server.port());
    EXPECT_TRUE(server.lives());
    const auto begun = std::chrono::steady_clock::now();
    server.server().stop();
    server.server().stop();
    EXPECT_LT(std::chrono::steady_clock::now() - begun, std::chrono::seconds(3));
    EXPECT_FALSE(RawClient(server.port()).connected());
    const LoopbackServer never_started(0);
}

} // namespace
} // namespace graze
