#pragma once

#include "graze/record/samples.hpp"

#include <cstddef>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace graze {

/// One period of the reference channel, from one of its rising crossings to the next, with all that was recorded.
struct Period {
    std::size_t number = 0; ///< in the record, from 0
    double begin = 0, end = 0;
    Samples samples; ///< from a few rows before the beginning to a few after the end

    double duration() const { return end - begin; }
};

struct PeriodSettings {
    std::size_t reference = 0; ///< channel
    double level = 0;          ///< that it crosses
    /// How far below the level and then above it the reference has to be for a crossing to count, so that noise is
    /// none. 0: a tenth of its range at the record's beginning.
    double hysteresis = 0;
};

/// Cuts a record into the periods of a reference channel: its time is counted anew from each rising crossing of a
/// level. Where exactly that is, a cubic polynomial says that fits the samples near the crossing by least squares. In
/// memory there is one period and what was read with it.
class PeriodSplitter {
public:
    /// @param source is shared. @throws InputError for settings without meaning
    PeriodSplitter(std::shared_ptr<SampleSource> source, const PeriodSettings& settings);
    /// The next whole period. @return false when there is none any more
    /// @throws InputError when the reference does not cross its level for 4 million samples
    bool next(Period& period);

private:
    struct Crossing {
        double time = 0;
        std::size_t row = 0; ///< in the buffer, the last one before
    };
    bool read_more();
    bool next_crossing(Crossing& crossing);
    double locate(std::size_t below, std::size_t above) const;

    std::shared_ptr<SampleSource> source_;
    PeriodSettings settings_;
    Samples buffer_, part_;
    std::size_t scanned_ = 0; ///< rows of the buffer
    std::size_t below_ = 0;   ///< of these the last far enough below
    bool armed_ = false;      ///< whether there is one since the last crossing
    bool begun_ = false, has_last_ = false;
    Crossing last_;
    std::size_t number_ = 0;
};

/// A straight line through the times of crossings, which are as far from one another as a period is long.
struct PeriodFit {
    std::size_t crossings = 0;
    double period = 0, period_error = 0; ///< with standard error
    double begin = 0, begin_error = 0;   ///< of the first period
    double jitter = 0;                   ///< standard deviation of the crossings about the line
};

/// Least squares. Errors are 0 for two crossings. @throws InputError for fewer than two
PeriodFit fit_period(std::span<const double> crossings);

} // namespace graze
