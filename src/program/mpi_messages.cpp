#include "program/mpi_messages.hpp"

#include "graze/base/input_error.hpp"
#include "program/open_mpi.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <list>
#include <map>
#include <thread>
#include <utility>

namespace graze {

namespace {

using namespace open_mpi;

/// MPI counts bytes by int: a long message is cut, and the tag says whether more follows.
constexpr std::size_t most_bytes = std::size_t{1} << 30;
constexpr int last_tag = 0, more_tag = 1;

class MpiMessages : public Messages {
public:
    explicit MpiMessages(const MpiStart& start) : mpi_(loaded()) {
        if (!start.knows_others)
            refuse(start);
        int provided = 0;
        require(mpi_.init_thread(nullptr, nullptr, thread_funneled, &provided));
        int size = 0, rank = 0;
        require(mpi_.comm_size(mpi_.world, &size));
        require(mpi_.comm_rank(mpi_.world, &rank));
        size_ = static_cast<std::size_t>(size);
        if (size_ == start.processes && static_cast<std::size_t>(rank) == start.number && provided >= thread_funneled)
            return;
        mpi_.finalize();
        refuse(start);
    }
    ~MpiMessages() override {
        while (!sending_.empty()) {
            forget_sent();
            std::this_thread::sleep_for(std::chrono::milliseconds(sending_.empty() ? 0 : 1));
        }
        mpi_.finalize();
    }
    MpiMessages(const MpiMessages&) = delete;
    MpiMessages& operator=(const MpiMessages&) = delete;

    std::size_t processes() const override { return size_; }

    void send(std::size_t to, std::string bytes) override {
        forget_sent();
        Sending& message = sending_.emplace_back();
        message.bytes = std::move(bytes);
        for (std::size_t first = 0; first == 0 || first < message.bytes.size(); first += most_bytes) {
            const std::size_t count = std::min(message.bytes.size() - first, most_bytes);
            const bool is_last = first + count == message.bytes.size();
            require(mpi_.isend(message.bytes.data() + first, static_cast<int>(count), mpi_.byte, static_cast<int>(to),
                               is_last ? last_tag : more_tag, mpi_.world, &message.requests.emplace_back()));
        }
    }

    std::optional<Message> receive() override {
        forget_sent();
        for (;;) {
            int is_there = 0, count = 0;
            ReceivedMessage handle = nullptr;
            Status status{};
            require(mpi_.improbe(any_source, any_tag, mpi_.world, &is_there, &handle, &status));
            if (is_there == 0)
                return std::nullopt;
            require(mpi_.get_count(&status, mpi_.byte, &count));
            std::string& bytes = begun_[status.source];
            const std::size_t before = bytes.size();
            bytes.resize(before + static_cast<std::size_t>(count));
            const int source = status.source, tag = status.tag;
            require(mpi_.mrecv(bytes.data() + before, count, mpi_.byte, &handle, &status));
            if (tag == last_tag)
                return Message{static_cast<std::size_t>(source), std::exchange(bytes, {})};
        }
    }

private:
    /// A message that may not have left yet.
    struct Sending {
        std::string bytes;
        std::list<Request> requests;
    };

    void forget_sent() {
        for (Sending& message : sending_)
            std::erase_if(message.requests, [this](Request& request) {
                int is_done = 0;
                Status status{};
                require(mpi_.test(&request, &is_done, &status));
                return is_done != 0;
            });
        std::erase_if(sending_, [](const Sending& message) { return message.requests.empty(); });
    }

    [[noreturn]] static void refuse(const MpiStart& start) {
        throw InputError(
            fmt::format("this is one of {} processes, which do not find each other by Open MPI", start.processes),
            "start it by the mpirun of Open MPI, or by srun --mpi=pmix; to compute parts by processes that "
            "need not know of each other, give each its --part");
    }

    /// Open MPI itself ends all processes at most errors.
    static void require(int code) {
        if (code != success)
            throw InputError(fmt::format("Open MPI reports error {}", code), "look at what it prints");
    }

    Functions mpi_;
    std::size_t size_ = 0;
    std::list<Sending> sending_;
    std::map<int, std::string> begun_; ///< messages of which more follows, by their senders
};

} // namespace

std::unique_ptr<Messages> mpi_messages(const MpiStart& start) {
    return std::make_unique<MpiMessages>(start);
}

} // namespace graze
