#pragma once

#include <algorithm>
#include <chrono>
#include <limits>

/// Seconds that something takes.
template <class Run>
double seconds(Run&& run) {
    using Clock = std::chrono::steady_clock;
    const auto start = Clock::now();
    run();
    return std::chrono::duration<double>(Clock::now() - start).count();
}

/// Least times of two rivals that take turns, so that whatever else the machine does meets both alike.
class Duel {
public:
    /// @return the time of the first, for Google Benchmark
    template <class Own, class Peer>
    double round(Own&& own, Peer&& peer) {
        const double time = seconds(own);
        own_ = std::min(own_, time);
        peer_ = std::min(peer_, seconds(peer));
        return time;
    }
    double own() const { return own_; }
    double peer() const { return peer_; }

private:
    double own_ = std::numeric_limits<double>::infinity(), peer_ = own_;
};
