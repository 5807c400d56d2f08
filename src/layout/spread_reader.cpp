#include "layout/spread_reader.hpp"

#include "layout/quantity_reader.hpp"

#include <algorithm>

namespace graze {

namespace {

constexpr double largest_spread = 1e3; // um or degrees

double spread_number(const StudyReader& reader, const TomlEntry& entry, const char* unit, double least,
                     double greatest) {
    const double value = read_quantity(reader, entry, unit);
    try {
        require_within(value, entry.path, unit, least, greatest);
    } catch (const InputError& error) {
        reader.fail(entry, error.problem(), error.remedy());
    }
    return value;
}

SpreadParts read_parts(const StudyReader& reader, const TomlEntry& entry, const char* unit) {
    SpreadParts parts;
    reader.each_of(entry, {"wafer", "radial", "device"}, [&](const TomlEntry& item) {
        if (item.name == "radial")
            parts.radial = spread_number(reader, item, unit, -largest_spread, largest_spread);
        else
            (item.name == "wafer" ? parts.wafer : parts.device) = spread_number(reader, item, unit, 0, largest_spread);
    });
    return parts;
}

} // namespace

ProcessSpread read_spread(const StudyReader& reader, const TomlEntry& entry) {
    ProcessSpread spread;
    reader.each_of(
        entry, {"bias", "thickness", "taper", "stop_gap", "correlation", "drive"}, [&](const TomlEntry& item) {
            const auto fields = departure_fields();
            const auto field = std::find_if(fields.begin(), fields.end(),
                                            [&](const DepartureField& one) { return item.name == one.name; });
            if (field != fields.end())
                spread.*field->spread = read_parts(reader, item, field->unit);
            else if (item.name == "correlation")
                spread.correlation = spread_number(reader, item, "um", 0, 1e7);
            else
                spread.tuned = reader.choice(item, {"fixed", "tuned"}) == 1;
        });
    return spread;
}

} // namespace graze
