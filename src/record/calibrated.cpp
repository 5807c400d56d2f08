#include "graze/record/calibrated.hpp"

#include "graze/base/input_error.hpp"
#include "graze/base/require.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace graze {

Calibrated::Calibrated(std::shared_ptr<SampleSource> source, CalibratedSettings settings)
    : source_(required(std::move(source), "a source")), settings_(std::move(settings)), header_(source_->header()) {
    for (const Calibration& one : settings_.calibrations) {
        require_index(one.channel, header_.channels.size(), "channel");
        require_finite(one.factor, "the factor of a channel");
        require_finite(one.offset, "the offset of a channel");
        if (one.unit)
            header_.channels[one.channel].unit = *one.unit;
    }
    if (!(settings_.begin < settings_.end))
        throw InputError(fmt::format("nothing lies between the times {} and {}", settings_.begin, settings_.end),
                         "give the earlier one first");
}

bool Calibrated::read(Samples& samples) {
    std::size_t first = 0, last = 0;
    while (first == last) {
        if (!source_->read(samples) || samples.times.front() > settings_.end) {
            samples.clear(header_.channels.size());
            return false;
        }
        const std::vector<double>& times = samples.times;
        first = static_cast<std::size_t>(std::lower_bound(times.begin(), times.end(), settings_.begin) - times.begin());
        last = static_cast<std::size_t>(std::upper_bound(times.begin(), times.end(), settings_.end) - times.begin());
    }
    if (first > 0 || last < samples.rows()) {
        Samples part;
        part.append(samples, first, last);
        samples = std::move(part);
    }
    for (const Calibration& one : settings_.calibrations)
        for (double& value : samples.values[one.channel]) {
            value = one.factor * value + one.offset;
            if (!std::isfinite(value))
                throw InputError(fmt::format("a value of channel '{}' becomes too large for a number",
                                             header_.channels[one.channel].name),
                                 "choose another factor or unit");
        }
    return true;
}

} // namespace graze
