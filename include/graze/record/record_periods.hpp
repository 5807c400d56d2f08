#pragma once

#include "graze/record/period.hpp"

#include <cstddef>
#include <functional>
#include <string>

namespace graze {

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
