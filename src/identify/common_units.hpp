#pragma once

#include "graze/base/physical_unit.hpp"
#include "graze/record/samples.hpp"

#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace graze {

/// Converts channels of several records to the units of the first record.
class CommonUnits {
public:
    /// Conversion of a column's numbers to the unit of the first record.
    struct Conversion {
        std::optional<PhysicalUnit> from{}, to{}; ///< both empty: numbers stay unchanged
        double operator()(double value) const { return from ? converted(value, *from, *to) : value; }
    };
    /// Returns the conversion of a record's time, and replaces its unit in the header by the common one.
    /// @throws InputError here and below when the units have different dimensions, when they differ and one is unknown,
    /// or when only one of the records states a unit
    Conversion take_time(RecordHeader& header);
    /// Does the same for a channel.
    Conversion take_channel(RecordHeader& header, std::size_t channel);

private:
    Conversion take(Channel& column, const std::string& role);

    /// Units so far by channel name; the time has an empty name.
    std::vector<std::pair<std::string, std::string>> units_;
};

/// A record converted to common units while it is read.
class CommonUnitSource : public SampleSource {
public:
    enum class Times { common, as_they_are }; ///< whether times are converted too (when the estimate depends on them)
    /// @param channels to convert; others stay unchanged
    CommonUnitSource(SampleSource& source, CommonUnits& units, const std::vector<std::size_t>& channels,
                     Times times = Times::common);
    const RecordHeader& header() const override { return header_; }
    bool read(Samples& samples) override;

private:
    SampleSource* source_;
    RecordHeader header_;
    CommonUnits::Conversion time_;
    std::vector<std::pair<std::size_t, CommonUnits::Conversion>> channels_;
};

} // namespace graze
