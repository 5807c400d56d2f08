#pragma once

#include <algorithm>
#include <chrono>
#include <ctime>
#include <limits>

/// The clock of a measurement: wall time, or CPU time, which other users of the machine affect little but which adds up
/// over threads.
enum class Clock { wall, processor };

/// Returns the reading of a clock, in seconds.
inline double read_clock(Clock clock) {
    if (clock == Clock::wall)
        return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
    timespec time{};
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &time);
    return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

/// Returns the seconds that a run takes.
template <class Run>
double seconds(Run&& run, Clock clock = Clock::wall) {
    const double start = read_clock(clock);
    run();
    return read_clock(clock) - start;
}

/// Measures the smallest times of two implementations that alternate, so that other load on the machine affects both
/// equally.
class PairedTiming {
public:
    explicit PairedTiming(Clock clock = Clock::wall) : clock_(clock) {}

    /// @return the time of the first one, for Google Benchmark
    template <class Own, class Peer>
    double round(Own&& own, Peer&& peer) {
        const double time = seconds(own, clock_);
        own_ = std::min(own_, time);
        peer_ = std::min(peer_, seconds(peer, clock_));
        return time;
    }
    double own() const { return own_; }
    double peer() const { return peer_; }

private:
    Clock clock_;
    double own_ = std::numeric_limits<double>::infinity(), peer_ = own_;
};
