#pragma once

#include "graze/record/samples.hpp"

#include <cstddef>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace graze {

/// Calibration of a channel: the quantity is factor * reading + offset.
struct Calibration {
    std::size_t channel = 0;
    double factor = 1, offset = 0;
    std::optional<std::string> unit{}; ///< unit of the result; empty: the channel keeps its own
};

/// Calibrations of channels, and the part of the record that is kept.
struct CalibratedSettings {
    std::vector<Calibration> calibrations{};
    double begin = -std::numeric_limits<double>::infinity(); ///< time before which rows are left out
    double end = std::numeric_limits<double>::infinity();    ///< time after which rows are left out
};

/// A part of a source, with its readings converted by calibrations.
class Calibrated : public SampleSource {
public:
    /// @param source is shared. @throws InputError for invalid settings
    Calibrated(std::shared_ptr<SampleSource> source, CalibratedSettings settings);
    const RecordHeader& header() const override { return header_; }
    /// @throws InputError when a result exceeds the range of a double
    bool read(Samples& samples) override;

private:
    std::shared_ptr<SampleSource> source_;
    CalibratedSettings settings_;
    RecordHeader header_;
};

} // namespace graze
