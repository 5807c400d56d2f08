#pragma once

#include "graze/bench/virtual_bench.hpp"

#include <cstddef>
#include <deque>
#include <limits>
#include <string>
#include <string_view>

namespace graze {

/// The virtual bench as a sample device: it answers lines with lines (docs/experiment.md).
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
/// A request that cannot be met is answered by ERROR and a reason.
class SampleProtocol {
public:
    /// @param bench must outlive this object
    explicit SampleProtocol(VirtualBench& bench) : bench_(&bench) {}

    /// Receives a line without its terminator. While rows are sent only STOP and MORE act at once; other lines are
    /// queued.
    /// @return false when the queue is full, and the device gives up
    bool receive(std::string_view line);
    /// Returns the next text to send; empty when there is none.
    /// @param rows largest number of rows, of those available until a simulated time
    std::string next(std::size_t rows, double until = std::numeric_limits<double>::infinity());
    bool is_reading() const { return reading_; }
    /// Forgets all requests, as the client has disconnected.
    void forget();

    static constexpr std::size_t longest_line = 256;
    static constexpr std::size_t rows_at_once = 1024; ///< block size, on which the last bits of samples may depend
    static constexpr std::size_t most_rows = 1'000'000'000;

private:
    std::string answer(std::string_view line);
    std::string rows(std::size_t count);

    VirtualBench* bench_;
    std::deque<std::string> waiting_;
    bool reading_ = false;
    std::size_t wanted_ = 0, given_ = 0;
    std::size_t block_ = 0, allowed_ = 0; ///< allowed_: rows that may be sent before the next MORE
    Samples samples_;
};

} // namespace graze
