#include "identify/common_units.hpp"

#include "graze/base/input_error.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace graze {

namespace {

std::string unit_or_none(const std::string& unit) {
    return unit.empty() ? "without a unit" : "in " + unit;
}

} // namespace

CommonUnits::Conversion CommonUnits::take(Channel& column, const std::string& role) {
    const auto found = std::find_if(units_.begin(), units_.end(), [&](const auto& one) { return one.first == role; });
    if (found == units_.end()) {
        units_.emplace_back(role, column.unit);
        return {};
    }
    const std::string& common = found->second;
    if (column.unit == common)
        return {};
    const auto from = told_unit(column.unit), to = told_unit(common);
    const std::string what = role.empty() ? "its time" : fmt::format("channel '{}'", role);
    if (!from || !to || from->dimension != to->dimension)
        throw InputError(fmt::format("{} is {}, and that of the first record {}", what, unit_or_none(column.unit),
                                     unit_or_none(common)),
                         role.empty() ? "give records whose times have units of one kind, as s, ms and min"
                                      : fmt::format("give records of one kind of unit, as mm and m, or say it by "
                                                    "scale: {}=FACTOR:UNIT",
                                                    role));
    column.unit = common;
    return {from, to};
}

CommonUnits::Conversion CommonUnits::take_time(RecordHeader& header) {
    return take(header.time, "");
}

CommonUnits::Conversion CommonUnits::take_channel(RecordHeader& header, std::size_t channel) {
    return take(header.channels[channel], header.channels[channel].name);
}

CommonUnitSource::CommonUnitSource(SampleSource& source, CommonUnits& units, const std::vector<std::size_t>& channels,
                                   Times times)
    : source_(&source), header_(source.header()) {
    if (times == Times::common)
        time_ = units.take_time(header_);
    for (const std::size_t channel : channels)
        channels_.emplace_back(channel, units.take_channel(header_, channel));
}

bool CommonUnitSource::read(Samples& samples) {
    const bool more = source_->read(samples);
    if (time_.from)
        for (double& time : samples.times)
            time = time_(time);
    for (const auto& [channel, conversion] : channels_)
        if (conversion.from)
            for (double& value : samples.values[channel])
                value = conversion(value);
    return more;
}

} // namespace graze
