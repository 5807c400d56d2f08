#pragma once

#include "page/http_message.hpp"

#include <nlohmann/json_fwd.hpp>

#include <chrono>
#include <cstddef>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

namespace graze {

/// Tells all listeners what happens, as server-sent events. Any thread may tell; it never waits for a listener. A
/// listener that falls far behind is dropped, and may listen again after it has looked at everything anew.
class EventStream {
public:
    /// @param most listeners at once @param pause after which a listener to whom nothing was told gets a comment, so
    /// that both sides know that the connection holds
    /// @param most_told bytes that may wait for a listener
    explicit EventStream(std::size_t most = 12, std::chrono::milliseconds pause = std::chrono::seconds(10),
                         std::size_t most_told = std::size_t{8} << 20)
        : most_(most), pause_(pause), most_told_(most_told) {}
    ~EventStream() { close(); }
    EventStream(const EventStream&) = delete;
    EventStream& operator=(const EventStream&) = delete;

    void tell(const std::string& event, const nlohmann::json& data);
    /// The answer to one more listener, which goes on until it leaves, or the stream is closed.
    /// @throws RefusedRequest when there are too many
    HttpAnswer listen();
    std::size_t listeners() const;
    /// Tells all listeners the event `end`, after which they have to leave.
    void close();

private:
    class Listener;
    std::vector<std::shared_ptr<Listener>> present() const;

    std::size_t most_;
    std::chrono::milliseconds pause_;
    std::size_t most_told_;
    mutable std::mutex mutex_;
    std::vector<std::weak_ptr<Listener>> listeners_;
    bool closed_ = false;
};

} // namespace graze
