#pragma once

#include "graze/record/record_file.hpp"
#include "graze/record/samples.hpp"

#include <cstddef>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace graze {

/// What is done to a record before anything is made of it, in this order: units, the part that is wanted, filter,
/// derivative. Channels go by their names, since no record may have been opened yet.
struct RecordProcessing {
    struct Scale {
        std::string channel{};
        double factor = 1, offset = 0;
        std::optional<std::string> unit{}; ///< none: the channel keeps its own
    };
    RecordLayout layout{};
    std::vector<Scale> scales{};
    double begin = -std::numeric_limits<double>::infinity(), end = std::numeric_limits<double>::infinity();
    double pass = 0, stop = 0;  ///< of the filter; 0: see LowPassSettings
    std::size_t every = 1;      ///< of how many samples one is kept
    std::string derivative{};   ///< channel; empty: none is added
    std::size_t half_width = 0; ///< of the derivative
    std::string asked_as{};     ///< what stands before `scale` and `derivative` in messages, such as "--"

    static constexpr std::size_t most_every = 1'000'000, least_half_width = 4, most_half_width = 100'000;
};

/// A source with all that is done to it. Reading it to its end is refused where it has given no rows.
class ProcessedRecord {
public:
    /// @throws InputError for channels that are not there, and settings without meaning
    ProcessedRecord(std::unique_ptr<SampleSource> source, const RecordProcessing& processing);
    /// The record of a file. @throws InputError also when it cannot be read
    ProcessedRecord(const std::string& path, const RecordProcessing& processing)
        : ProcessedRecord(open_record(path, processing.layout), processing) {}
    SampleSource& source() { return *stages_.back(); }
    const RecordHeader& header() const { return stages_.back()->header(); }

private:
    std::vector<std::unique_ptr<SampleSource>> stages_; ///< each reads from the one before
};

} // namespace graze
