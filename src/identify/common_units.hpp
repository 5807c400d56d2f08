#pragma once

#include "graze/base/physical_unit.hpp"
#include "graze/record/samples.hpp"

#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace graze {

/// Units in which records that are put together are taken: those of the first.
class CommonUnits {
public:
    /// How the numbers of a column become those of the first record's.
    struct Conversion {
        std::optional<PhysicalUnit> from{}, to{}; ///< none: they stay
        double operator()(double value) const { return from ? converted(value, *from, *to) : value; }
    };
    /// Of a record's time, whose unit in the header becomes the common one.
    /// @throws InputError here and below for units of different kinds, for different ones of which one is not known,
    /// and where one of two records says none
    Conversion take_time(RecordHeader& header);
    /// Of a channel, in the same way.
    Conversion take_channel(RecordHeader& header, std::size_t channel);

private:
    Conversion take(Channel& column, const std::string& role);

    std::vector<std::pair<std::string, std::string>> units_; ///< of the time (under no name) and channels, so far
};

/// A record in common units.
class CommonUnitSource : public SampleSource {
public:
    enum class Times { common, as_they_are }; ///< whether what is found depends on them
    /// @param channels that are used; others stay as they are
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
