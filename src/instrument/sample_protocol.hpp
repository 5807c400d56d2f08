#pragma once

#include "graze/bench/virtual_bench.hpp"

#include <cstddef>
#include <deque>
#include <limits>
#include <string>
#include <string_view>

namespace graze {

/// The virtual bench as a device of samples: lines that ask, lines that answer (docs/experiment.md).
///
///     CHANNELS   t [s], V [V], q [m]            names and units, as the first line of a record
///     RATE 1000  OK 1000                        samples in a second, as they will be
///     READ 3     0,0.1,0.2 ... END 3            rows, with times from the first of them, and how many there were
///     READ 9 4   4 rows, and 4 more whenever it is told
///     MORE
///     STOP       END 2                          ends a READ before its time
///     MARK 7     OK                             keeps how all is now, and
///     RETURN 7   OK                             makes it so again; devices of hardware know neither
///
/// What cannot be done is answered by ERROR and a reason.
class SampleProtocol {
public:
    /// @param bench must outlive this
    explicit SampleProtocol(VirtualBench& bench) : bench_(&bench) {}

    /// A line without its terminator. While rows are given only STOP and MORE are heeded at once; the rest waits.
    /// @return false when too many wait, and the device gives up
    bool receive(std::string_view line);
    /// What is to be sent next; empty when there is nothing.
    /// @param rows at most, of those that there are up to a time of the bench
    std::string next(std::size_t rows, double until = std::numeric_limits<double>::infinity());
    bool is_reading() const { return reading_; }
    /// Whoever asked is gone: nothing is owed any more.
    void forget();

    static constexpr std::size_t longest_line = 256;
    static constexpr std::size_t rows_at_once = 1024; ///< of which the samples' last bits may depend
    static constexpr std::size_t most_rows = 1'000'000'000;

private:
    std::string answer(std::string_view line);
    std::string rows(std::size_t count);

    VirtualBench* bench_;
    std::deque<std::string> waiting_;
    bool reading_ = false;
    std::size_t wanted_ = 0, given_ = 0;
    std::size_t block_ = 0, allowed_ = 0; ///< rows that may be given before MORE
    Samples samples_;
};

} // namespace graze
