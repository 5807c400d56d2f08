#pragma once

#include "graze/study/messages.hpp"
#include "graze/study/part_exchange.hpp"
#include "graze/study/part_sizes.hpp"

#include <cstddef>
#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

namespace graze {

/// Deals parts of open work out to other processes, which `compute_parts` (part_computer.hpp), and hands on what they
/// send back. Of process 0; for one thread.
class PartDealer {
public:
    /// @param threads of each of the other processes
    PartDealer(Messages& messages, PartExchange& exchange, std::size_t threads);

    /// Takes what has come and deals out more. @return whether there was anything to do
    bool look();

private:
    struct Work {
        std::string text;
        PartSizes sizes;
        std::set<std::size_t> told; ///< processes that know the text
    };
    bool take();
    bool deal();
    bool deal_to(std::size_t process);
    void forget_what_is_closed();

    Messages* messages_;
    PartExchange* exchange_;
    std::size_t threads_;
    /// By their numbers, but runs that are computed as a whole first: they may take long, and others may need them.
    std::map<std::pair<bool, std::size_t>, Work> works_;
    std::vector<std::size_t> tasks_; ///< that each process has; this one has none
};

/// Lets the other processes end, and waits until they do.
void end_workers(Messages& messages);

} // namespace graze
