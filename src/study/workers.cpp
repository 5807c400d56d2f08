#include "graze/study/workers.hpp"

#include "graze/study/whole_run.hpp"
#include "graze/study/yield_part.hpp"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <future>

namespace graze {

namespace {

constexpr std::chrono::milliseconds between_deals{1};
constexpr std::size_t most_side_by_side = 256; ///< that go on side by side: each has a thread here, which waits

} // namespace

Workers::Workers(std::unique_ptr<Messages> messages, std::size_t threads)
    : messages_(std::move(messages)), threads_(threads), exchange_(std::make_shared<PartExchange>()),
      dealer_(*messages_, *exchange_, threads) {}

Workers::~Workers() {
    try {
        end_workers(*messages_);
    } catch (const std::exception&) { // they end with this process
    }
}

std::vector<RunReport> Workers::run_study(const Study& study, ResultFile& file, const RunnerOptions& options) {
    RunnerOptions own = options;
    // One more run than can be computed, so that its tasks are there when those of another become few.
    own.jobs = static_cast<int>(std::min((messages_->processes() - 1) * threads_ + 1, most_side_by_side));
    const Elsewhere elsewhere{
        .points = points_by(exchange_), .results = results_by(exchange_, study, file.path()), .only_waits = true};
    std::vector<RunReport> reports;
    carry_out(
        [&](const std::function<bool()>& interrupted) {
            own.interrupted = interrupted;
            reports = graze::run_study(study, file, own, elsewhere);
        },
        options.interrupted);
    return reports;
}

DevicesElsewhere Workers::devices() const {
    return devices_by(exchange_);
}

void Workers::carry_out(const std::function<void(const std::function<bool()>& interrupted)>& work,
                        const std::function<bool()>& interrupted) {
    std::atomic<bool> is_broken_off = false;
    std::future<void> done =
        std::async(std::launch::async, [&] { work([&] { return is_broken_off || (interrupted && interrupted()); }); });
    try {
        while (done.wait_for(std::chrono::seconds(0)) != std::future_status::ready)
            if (!dealer_.look())
                done.wait_for(between_deals);
        dealer_.look(); // so that what is not wanted any more is not computed
    } catch (...) {
        is_broken_off = true;
        done.wait();
        throw;
    }
    done.get();
}

} // namespace graze
