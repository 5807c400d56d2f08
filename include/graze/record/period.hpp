#pragma once

#include "graze/record/samples.hpp"

#include <cstddef>
#include <functional>
#include <memory>
#include <span>
#include <string>

namespace graze {

/// One period of the reference channel, from one of its upward crossings of a level to the next, with all channels.
struct Period {
    std::size_t number = 0; ///< in the record, from 0
    double begin = 0, end = 0;
    Samples samples; ///< rows of the period, and a few before and after it

    double duration() const { return end - begin; }
};

/// Options of `PeriodSplitter`.
struct PeriodSettings {
    std::size_t reference = 0; ///< reference channel
    double level = 0;          ///< level whose upward crossings separate periods
    /// A crossing counts only if the reference was this far below the level and then rises this far above it, so that
    /// noise makes no crossings. 0: a tenth of its range at the beginning of the record. In the unit of the reference.
    double hysteresis = 0;
};

/// Cuts a record into periods, at the upward crossings of a level by a reference channel. The time of a crossing is the
/// root of a cubic polynomial fitted to the nearby samples by least squares. Memory holds one period and the samples
/// read with it.
class PeriodSplitter {
public:
    /// @param source is shared. @throws InputError for invalid settings
    PeriodSplitter(std::shared_ptr<SampleSource> source, const PeriodSettings& settings);
    /// Finds the next whole period. @return false when there are no more
    /// @throws InputError when the reference does not cross its level for 4 million samples
    bool next(Period& period);

private:
    struct Crossing {
        double time = 0;
        std::size_t row = 0; ///< the last row of the buffer before it
    };
    bool read_more();
    bool next_crossing(Crossing& crossing);
    double locate(std::size_t below, std::size_t above) const;

    std::shared_ptr<SampleSource> source_;
    PeriodSettings settings_;
    Samples buffer_, part_;
    std::size_t scanned_ = 0; ///< rows of the buffer that have been searched
    std::size_t below_ = 0;   ///< the last of them that was far enough below the level
    bool armed_ = false;      ///< whether there is such a row since the last crossing
    bool begun_ = false, has_last_ = false;
    Crossing last_;
    std::size_t number_ = 0;
};

/// A straight line fitted to the times of crossings, which are one period apart.
struct PeriodFit {
    std::size_t crossings = 0;
    double period = 0, period_error = 0; ///< period with standard error
    double begin = 0, begin_error = 0;   ///< beginning of the first period, with standard error
    double jitter = 0;                   ///< standard deviation of the crossings about the line
};

/// Fits the line by least squares. Errors are 0 for two crossings. @throws InputError for fewer than two
PeriodFit fit_period(std::span<const double> crossings);

/// Summary of all periods of a record.
struct RecordPeriods {
    std::size_t count = 0;
    double amplitude = 0; ///< amplitude of the reference, averaged over the periods: the abscissa of diagrams
};

/// Calls `take` for each period of a record in turn.
/// @throws InputError as PeriodSplitter does, and if there is no whole period
RecordPeriods each_period(SampleSource& source, const PeriodSettings& settings,
                          const std::function<void(const Period&)>& take);

} // namespace graze
