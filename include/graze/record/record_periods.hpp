#pragma once

#include "graze/record/period.hpp"

#include <cstddef>
#include <functional>
#include <string>

namespace graze {

/// What all periods of a record tell together.
struct RecordPeriods {
    std::size_t count = 0;
    double amplitude = 0; ///< of the reference, averaged over the periods: what diagrams are drawn over
};

/// Hands out the periods of a record, one after the other.
/// @param asked_as what stands before names of settings in messages, such as "--"
/// @throws InputError as PeriodSplitter does, and where there is no whole period
RecordPeriods each_period(SampleSource& source, const PeriodSettings& settings,
                          const std::function<void(const Period&)>& take, const std::string& asked_as = "");

} // namespace graze
