#include "page/event_stream.hpp"

#include "page/error_answer.hpp"
#include "page/json_text.hpp"

#include <condition_variable>

namespace graze {

/// What waits to be sent to one listener.
class EventStream::Listener {
public:
    Listener(std::chrono::milliseconds pause, std::size_t most_told) : pause_(pause), most_told_(most_told) {}

    void add(const std::string& text) {
        {
            const std::lock_guard lock(mutex_);
            if (dropped_)
                return;
            dropped_ = waiting_.size() + text.size() > most_told_;
            if (dropped_)
                waiting_.clear();
            else
                waiting_ += text;
        }
        changed_.notify_one();
    }
    void end() {
        {
            const std::lock_guard lock(mutex_);
            ended_ = true;
        }
        changed_.notify_one();
    }
    /// Sends what waits. @return false when nothing will follow
    bool send(const AnswerSink& sink) {
        std::unique_lock lock(mutex_);
        const auto wait = std::min<std::chrono::milliseconds>(pause_, std::chrono::seconds(1));
        changed_.wait_for(lock, wait, [&] { return dropped_ || ended_ || !waiting_.empty(); });
        if (dropped_)
            return false;
        std::string text = std::exchange(waiting_, {});
        const bool ended = ended_;
        lock.unlock();
        if (ended)
            text += "event: end\ndata: {}\n\n";
        const auto now = std::chrono::steady_clock::now();
        if (text.empty()) {
            if (!sink.is_open())
                return false;
            if (now - sent_ < pause_)
                return true;
            text = ":\n\n";
        }
        sent_ = now;
        return sink.write(text) && !ended;
    }

private:
    std::chrono::milliseconds pause_;
    std::size_t most_told_;
    std::mutex mutex_;
    std::condition_variable changed_;
    std::string waiting_ = ":\n\n"; ///< so that the client knows at once that it is heard
    bool dropped_ = false, ended_ = false;
    std::chrono::steady_clock::time_point sent_ = std::chrono::steady_clock::now(); ///< used by the listener's thread
};

std::vector<std::shared_ptr<EventStream::Listener>> EventStream::present() const {
    std::vector<std::shared_ptr<Listener>> result;
    const std::lock_guard lock(mutex_);
    for (const std::weak_ptr<Listener>& one : listeners_)
        if (auto listener = one.lock())
            result.push_back(std::move(listener));
    return result;
}

void EventStream::tell(const std::string& event, const nlohmann::json& data) {
    // JSON is one line, so that the event has no other lines.
    const std::string text = "event: " + event + "\ndata: " + json_text(data) + "\n\n";
    for (const auto& listener : present())
        listener->add(text);
}

HttpAnswer EventStream::listen() {
    auto listener = std::make_shared<Listener>(pause_, most_told_);
    {
        const std::lock_guard lock(mutex_);
        std::erase_if(listeners_, [](const std::weak_ptr<Listener>& one) { return one.expired(); });
        if (closed_)
            throw RefusedRequest(503, "the server ends", "start it again");
        if (listeners_.size() >= most_)
            throw RefusedRequest(429, "too many pages listen", "close one of them");
        listeners_.push_back(listener);
    }
    HttpAnswer answer;
    answer.type = "text/event-stream";
    answer.more = [listener](const AnswerSink& sink) { return listener->send(sink); };
    return answer;
}

std::size_t EventStream::listeners() const {
    return present().size();
}

void EventStream::close() {
    {
        const std::lock_guard lock(mutex_);
        closed_ = true;
    }
    for (const auto& listener : present())
        listener->end();
}

} // namespace graze
