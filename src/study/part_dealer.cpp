#include "graze/study/part_dealer.hpp"

#include "graze/study/whole_run.hpp"
#include "study/dealt_messages.hpp"

#include <algorithm>
#include <chrono>
#include <thread>
#include <utility>

namespace graze {

using What = DealtMessage::What;

PartDealer::PartDealer(Messages& messages, PartExchange& exchange, std::size_t threads)
    : messages_(&messages), exchange_(&exchange), threads_(threads), tasks_(messages.processes()) {}

bool PartDealer::look() {
    for (PartExchange::Opened& work : exchange_->opened()) {
        const std::pair key(!is_whole_run(work.text), work.number);
        works_.emplace(key, Work{std::move(work.text), PartSizes(work.missing), {}});
    }
    const bool has_taken = take();
    forget_what_is_closed();
    return deal() || has_taken;
}

bool PartDealer::take() {
    bool any = false;
    while (const auto received = messages_->receive()) {
        any = true;
        DealtMessage message = message_of(received->bytes);
        if (message.what == What::piece) {
            exchange_->give_piece(message.work, message.items, std::move(message.bytes));
            continue;
        }
        --tasks_.at(received->from);
        if (message.what == What::failed)
            exchange_->fail(message.work, error_of(message.bytes));
        if (message.what != What::result)
            continue;
        if (const auto work = works_.find({true, message.work}); work != works_.end()) // of a whole run none is left
            work->second.sizes.note(message.items.size(), message.seconds);
        exchange_->give(message.work, message.items, std::move(message.bytes));
    }
    return any;
}

void PartDealer::forget_what_is_closed() {
    std::erase_if(works_, [this](const auto& one) {
        const std::size_t number = one.first.second;
        if (exchange_->is_open(number))
            return false;
        for (const std::size_t process : one.second.told)
            messages_->send(process, bytes_of({.what = What::forget, .work = number}));
        return true;
    });
}

bool PartDealer::deal() {
    // What comes faster than it is stored would fill the memory.
    const std::size_t most_waiting = 2 * threads_ * tasks_.size() + 8;
    bool any = false;
    for (bool dealt = true; dealt && exchange_->waiting() < most_waiting; any = any || dealt) {
        const auto idlest = std::min_element(tasks_.begin() + 1, tasks_.end());
        dealt = deal_to(static_cast<std::size_t>(idlest - tasks_.begin()));
    }
    return any;
}

bool PartDealer::deal_to(std::size_t process) {
    std::size_t& tasks = tasks_[process];
    if (tasks >= 2 * threads_)
        return false;
    for (auto& [key, work] : works_) {
        const std::size_t number = key.second;
        if (!work.sizes.has_more())
            continue;
        if (tasks >= threads_ && !work.sizes.is_brief())
            return false; // it would wait for a thread, and another process may be free before
        const ItemRange items = work.sizes.cut((tasks_.size() - 1) * threads_);
        auto part = exchange_->part(number, items);
        if (!part)
            continue; // it was closed meanwhile
        if (work.told.insert(process).second)
            messages_->send(process, bytes_of({.what = What::work, .work = number, .bytes = work.text}));
        messages_->send(process, bytes_of({What::task, number, items, 0, std::move(*part)}));
        ++tasks;
        return true;
    }
    return false;
}

void end_workers(Messages& messages) {
    for (std::size_t process = 1; process < messages.processes(); ++process)
        messages.send(process, bytes_of({.what = What::end}));
    for (std::size_t going = messages.processes() - 1; going > 0;)
        if (const auto received = messages.receive())
            going -= message_of(received->bytes).what == What::bye ? 1 : 0;
        else
            std::this_thread::sleep_for(std::chrono::milliseconds(1));
}

} // namespace graze
