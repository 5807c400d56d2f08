#pragma once

#include <cstddef>
#include <optional>
#include <string>

namespace graze {

/// Carries messages between processes, which are numbered from 0 on, for one thread of each. Messages from one process
/// to another come in the order in which they were sent.
class Messages {
public:
    struct Message {
        std::size_t from = 0;
        std::string bytes;
    };

    Messages() = default;
    virtual ~Messages() = default;
    Messages(const Messages&) = delete;
    Messages& operator=(const Messages&) = delete;

    /// How many processes there are.
    virtual std::size_t processes() const = 0;
    /// Sends a message without waiting for its receiver.
    virtual void send(std::size_t to, std::string bytes) = 0;
    /// The next message that has come; none: at present there is none.
    virtual std::optional<Message> receive() = 0;
};

} // namespace graze
