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

/// How a record is processed before it is used, in this order: scaling, selection of a part, filter, derivative.
/// Channels are given by name, since the record may not have been opened yet.
struct RecordProcessing {
    /// Calibration of a channel: factor * reading + offset.
    struct Scale {
        std::string channel{};
        double factor = 1, offset = 0;
        std::optional<std::string> unit{}; ///< empty: the channel keeps its own
    };
    RecordLayout layout{};
    std::vector<Scale> scales{};
    double begin = -std::numeric_limits<double>::infinity(), end = std::numeric_limits<double>::infinity();
    double pass = 0, stop = 0;  ///< filter, see LowPassSettings; both 0 and `every` 1: no filter
    std::size_t every = 1;      ///< decimation, see LowPassSettings
    std::string derivative{};   ///< channel whose derivative is added; empty: none
    std::size_t half_width = 0; ///< see DerivativeSettings

    static constexpr std::size_t most_every = 1'000'000, least_half_width = 4, most_half_width = 100'000;
};

/// A source with all its processing. Reading it to the end throws if it has no rows.
class ProcessedRecord {
public:
    /// @throws InputError for unknown channels, and invalid settings
    ProcessedRecord(std::shared_ptr<SampleSource> source, const RecordProcessing& processing);
    /// The record of a file. @throws InputError also when it cannot be read
    ProcessedRecord(const std::string& path, const RecordProcessing& processing)
        : ProcessedRecord(open_record(path, processing.layout), processing) {}
    /// Its last stage, which exists as long as this object.
    SampleSource& source() { return *source_; }
    const RecordHeader& header() const { return source_->header(); }

private:
    std::shared_ptr<SampleSource> source_; ///< the last stage, which reads from the one before it, and so on
};

} // namespace graze
