#pragma once

#include "graze/branch/yield.hpp"
#include "graze/study/messages.hpp"
#include "graze/study/part_dealer.hpp"
#include "graze/study/part_exchange.hpp"
#include "graze/study/runner.hpp"

#include <cstddef>
#include <functional>
#include <memory>
#include <vector>

namespace graze {

/// Other processes that compute for this one, process 0, until this is destroyed; each of them has to `compute_parts`
/// (part_computer.hpp).
class Workers {
public:
    /// @param messages to them; there is one at least
    /// @param threads of each of them
    Workers(std::unique_ptr<Messages> messages, std::size_t threads);
    /// Lets them end, and waits until they do.
    ~Workers();
    Workers(const Workers&) = delete;
    Workers& operator=(const Workers&) = delete;

    /// The same as graze::run_study, but they compute. This process alone writes the file, which is the same, too.
    /// @param options `jobs` has no effect
    std::vector<RunReport> run_study(const Study& study, ResultFile& file, const RunnerOptions& options);

    /// Has them solve for the devices of yields, for settings of these; only while `carry_out` goes on.
    DevicesElsewhere devices() const;
    /// Carries out work in another thread, while this one exchanges messages with them.
    /// @param work given whether it has to end soon
    /// @param interrupted lets the work end
    /// @throws what the work throws
    void carry_out(const std::function<void(const std::function<bool()>& interrupted)>& work,
                   const std::function<bool()>& interrupted);

private:
    std::unique_ptr<Messages> messages_;
    std::size_t threads_;
    std::shared_ptr<PartExchange> exchange_;
    PartDealer dealer_;
};

} // namespace graze
