#pragma once

#include "graze/study/messages.hpp"
#include "graze/study/part_computer.hpp"
#include "graze/study/workers.hpp"

#include <deque>
#include <memory>
#include <mutex>
#include <thread>
#include <utility>
#include <vector>

namespace graze::testing {

/// Messages between threads that stand for processes.
class Mail {
public:
    explicit Mail(std::size_t processes) : boxes_(processes) {}

    /// The messages of one of the processes, which end with this.
    std::unique_ptr<Messages> of(std::size_t process) { return std::make_unique<Own>(*this, process); }
    std::size_t bytes() const {
        const std::lock_guard lock(mutex_);
        return bytes_;
    }

private:
    class Own : public Messages {
    public:
        Own(Mail& mail, std::size_t number) : mail_(&mail), number_(number) {}
        std::size_t processes() const override { return mail_->boxes_.size(); }
        void send(std::size_t to, std::string bytes) override {
            const std::lock_guard lock(mail_->mutex_);
            mail_->bytes_ += bytes.size();
            mail_->boxes_.at(to).push_back({number_, std::move(bytes)});
        }
        std::optional<Message> receive() override {
            const std::lock_guard lock(mail_->mutex_);
            auto& box = mail_->boxes_.at(number_);
            if (box.empty())
                return std::nullopt;
            Message message = std::move(box.front());
            box.pop_front();
            return message;
        }

    private:
        Mail* mail_;
        std::size_t number_;
    };

    mutable std::mutex mutex_;
    std::vector<std::deque<Messages::Message>> boxes_;
    std::size_t bytes_ = 0;
};

/// Threads that stand for processes that compute.
class WorkersInThreads {
public:
    explicit WorkersInThreads(std::size_t workers, std::size_t threads = 1) : mail_(workers + 1) {
        for (std::size_t worker = 1; worker <= workers; ++worker)
            threads_.emplace_back([this, worker, threads] { compute_parts(*mail_.of(worker), threads); });
        workers_ = std::make_unique<Workers>(mail_.of(0), threads);
    }
    Workers* operator->() { return workers_.get(); }

private:
    Mail mail_;
    std::vector<std::jthread> threads_;
    std::unique_ptr<Workers> workers_; ///< the last member: the others end when it does
};

} // namespace graze::testing
