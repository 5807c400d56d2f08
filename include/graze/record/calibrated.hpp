#pragma once

#include "graze/record/samples.hpp"

#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace graze {

/// What a channel's readings mean: factor * reading + offset.
struct Calibration {
    std::size_t channel = 0;
    double factor = 1, offset = 0;
    std::optional<std::string> unit{}; ///< of the result; none: the channel keeps its own
};

struct CalibratedSettings {
    std::vector<Calibration> calibrations{};
    double begin = -std::numeric_limits<double>::infinity(); ///< rows before are left out,
    double end = std::numeric_limits<double>::infinity();    ///< and so are those behind
};

/// A part of a source, with its readings turned into what they mean.
class Calibrated : public SampleSource {
public:
    /// @param source is shared. @throws InputError for settings without meaning
    Calibrated(std::shared_ptr<SampleSource> source, CalibratedSettings settings);
    const RecordHeader& header() const override { return header_; }
    /// @throws InputError when a result is too large for a number
    bool read(Samples& samples) override;

private:
    std::shared_ptr<SampleSource> source_;
    CalibratedSettings settings_;
    RecordHeader header_;
};

} // namespace graze
