#include "page/event_stream.hpp"

#include "page/error_answer.hpp"

#include <nlohmann/json.hpp>

#include <gtest/gtest.h>

#include <thread>
#include <vector>

namespace graze {
namespace {

/// Keeps what a listener is sent.
struct Received {
    std::string text{};
    bool open = true;
    AnswerSink sink{[this](std::string_view part) {
                        text += part;
                        return open;
                    },
                    [this] { return open; }};
};

TEST(EventStream, TellsAllListeners) {
    EventStream stream;
    const HttpAnswer one = stream.listen(), other = stream.listen();
    EXPECT_EQ(one.type, "text/event-stream");
    EXPECT_EQ(stream.listeners(), 2U);
    Received first, second;
    EXPECT_TRUE(one.more(first.sink));
    EXPECT_EQ(first.text, ":\n\n"); // at once
    stream.tell("job", {{"id", 1}, {"text", "two\nlines"}});
    stream.tell("study", {{"revision", 2}});
    EXPECT_TRUE(one.more(first.sink));
    EXPECT_TRUE(other.more(second.sink));
    const std::string events =
        "event: job\ndata: {\"id\":1,\"text\":\"two\\nlines\"}\n\nevent: study\ndata: {\"revision\":2}\n\n";
    EXPECT_EQ(first.text, ":\n\n" + events);
    EXPECT_EQ(second.text, ":\n\n" + events);
}

TEST(EventStream, WakesAListenerThatWaits) {
    EventStream stream;
    const HttpAnswer answer = stream.listen();
    Received received;
    answer.more(received.sink);
    std::thread teller([&] {
        std::this_thread::sleep_for(std::chrono::milliseconds(10));
        stream.tell("job", {});
    });
    const auto begun = std::chrono::steady_clock::now();
    EXPECT_TRUE(answer.more(received.sink));
    EXPECT_LT(std::chrono::steady_clock::now() - begun, std::chrono::milliseconds(900));
    EXPECT_NE(received.text.find("event: job"), std::string::npos);
    teller.join();
}

TEST(EventStream, SaysThatItIsThereWhenNothingHappens) {
    EventStream stream(1, std::chrono::milliseconds(10));
    const HttpAnswer answer = stream.listen();
    Received received;
    answer.more(received.sink);
    for (int i = 0; i < 5; ++i)
        EXPECT_TRUE(answer.more(received.sink));
    EXPECT_NE(received.text.find(":\n\n:\n\n"), std::string::npos);
}

TEST(EventStream, ForgetsListenersThatHaveLeft) {
    EventStream stream(1, std::chrono::milliseconds(5));
    Received received;
    {
        const HttpAnswer answer = stream.listen();
        EXPECT_THROW(stream.listen(), RefusedRequest);
        answer.more(received.sink);
        received.open = false;
        EXPECT_FALSE(answer.more(received.sink));
    }
    EXPECT_EQ(stream.listeners(), 0U);
    EXPECT_NO_THROW(stream.listen());
}

TEST(EventStream, DropsAListenerThatDoesNotRead) {
    EventStream stream(1, std::chrono::seconds(10), 1000);
    const HttpAnswer answer = stream.listen();
    const nlohmann::json much(std::string(200, 'x'));
    for (int i = 0; i < 10; ++i)
        stream.tell("much", much);
    Received received;
    EXPECT_FALSE(answer.more(received.sink));
    EXPECT_EQ(received.text, "");
}

TEST(EventStream, TellsItsEndLast) {
    EventStream stream;
    const HttpAnswer answer = stream.listen();
    stream.tell("job", {});
    stream.close();
    Received received;
    EXPECT_FALSE(answer.more(received.sink));
    EXPECT_TRUE(received.text.ends_with("event: end\ndata: {}\n\n")) << received.text;
    EXPECT_NE(received.text.find("event: job"), std::string::npos);
    EXPECT_THROW(stream.listen(), RefusedRequest);
}

} // namespace
} // namespace graze
