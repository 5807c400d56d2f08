#pragma once

#include "graze/acquire/experiment.hpp"
#include "graze/acquire/sample_device.hpp"

#include <cstddef>
#include <functional>
#include <vector>

namespace graze {

/// Whether sections repeat, one after the other as they come: with every period from 1 to some number of them it is
/// looked whether the last ones differ from those a period before by no more than a tolerance.
class RepeatWatch {
public:
    /// @param tolerances of each value of a section; @param repeats so many in a row have to; @param period the longest
    /// @throws InputError for none of them, for more than 100,000 sections, and for tolerances that are negative or no
    ///         numbers
    RepeatWatch(std::vector<double> tolerances, std::size_t repeats, std::size_t period);
    /// @param section as many values as there are tolerances. @throws InputError for another number of them, or what is
    ///        no number
    void add(std::vector<double> section);
    /// After how many sections they repeat; 0: they do not.
    std::size_t period() const;

private:
    bool close(const std::vector<double>& one, const std::vector<double>& other) const;

    std::vector<double> tolerances_;
    std::size_t repeats_, longest_;
    std::vector<std::vector<double>> last_; ///< so many as the longest period has, the newest at the end
    std::vector<std::size_t> runs_;         ///< for each period: how many in a row have repeated
};

struct Settled {
    bool settled = false; ///< or was given up after the longest time
    double time = 0;      ///< s
};

/// Waits, by reading samples and passing them over.
/// @param progress told how many seconds have passed; may be empty
/// @throws InstrumentError of the device; InputError for channels that it does not have
Settled settle(SampleDevice& device, const SettlingOptions& options, double rate,
               const std::function<void(double)>& progress);

} // namespace graze
