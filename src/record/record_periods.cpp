#include "graze/record/record_periods.hpp"

#include "graze/base/input_error.hpp"
#include "graze/record/harmonic.hpp"

#include <fmt/format.h>

namespace graze {

RecordPeriods each_period(SampleSource& source, const PeriodSettings& settings,
                          const std::function<void(const Period&)>& take) {
    PeriodSplitter splitter(borrowed(source), settings);
    RecordPeriods found;
    double sum = 0;
    for (Period period; splitter.next(period); ++found.count) {
        sum += amplitude(period, settings.reference);
        take(period);
    }
    if (found.count == 0)
        throw InputError(fmt::format("'{}' does not rise through {} twice",
                                     source.header().channels[settings.reference].name, settings.level),
                         "choose another reference or level, or record more periods");
    found.amplitude = sum / static_cast<double>(found.count);
    return found;
}

} // namespace graze
