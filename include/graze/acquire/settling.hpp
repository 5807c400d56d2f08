#pragma once

#include "graze/acquire/experiment.hpp"
#include "graze/acquire/sample_device.hpp"

#include <cstddef>
#include <functional>
#include <vector>

namespace graze {

/// Detects whether a sequence of sections has become periodic: for each period from 1 to a longest one it compares the
/// latest sections with those one period before, within tolerances.
class RepeatWatch {
public:
    /// @param tolerances one for each value of a section; @param repeats number of consecutive repetitions required;
    /// @param period the longest
    /// @throws InputError for no repeats or periods, for more than 100,000 sections, and for tolerances that are
    /// negative or not finite
    RepeatWatch(std::vector<double> tolerances, std::size_t repeats, std::size_t period);
    /// @param section one value for each tolerance. @throws InputError for another number of them, or values that are
    /// not finite
    void add(std::vector<double> section);
    /// Returns the period, in sections; 0: they do not repeat.
    std::size_t period() const;

private:
    bool close(const std::vector<double>& one, const std::vector<double>& other) const;

    std::vector<double> tolerances_;
    std::size_t repeats_, longest_;
    std::vector<std::vector<double>> last_; ///< the latest sections, as many as the longest period, newest last
    std::vector<std::size_t> runs_;         ///< for each period: number of consecutive repetitions
};

/// Result of `settle`.
struct Settled {
    bool settled = false; ///< false: given up after the longest time
    double time = 0;      ///< time waited, in s
};

/// Waits until the system has settled, while reading samples and discarding them.
/// @param progress called with the time passed, in s; may be empty
/// @throws InstrumentError of the device; InputError for unknown channels
Settled settle(SampleDevice& device, const SettlingOptions& options, double rate,
               const std::function<void(double)>& progress);

} // namespace graze
