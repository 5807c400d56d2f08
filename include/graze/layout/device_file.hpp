#pragma once

#include "graze/base/input_error.hpp"
#include "graze/layout/device_dimensions.hpp"
#include "graze/layout/process_conditions.hpp"
#include "graze/layout/process_spread.hpp"
#include "graze/layout/wafer_plan.hpp"

#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace graze {

/// What the sections [device], [process], [rules], [spread] and [wafer] of a design file say; the other sections are
/// the designer's.
struct DeviceFile {
    std::string name, text, file;
    std::string model = "mems-switch-device"; ///< a shipped one, or a path: whose parameters the device has
    DeviceDimensions device;
    ProcessData process;
    ProcessConditions conditions; ///< of [process], too
    RuleLimits rules;
    ProcessSpread spread;
    WaferPlan wafer;
    std::map<std::string, Place, std::less<>> places; ///< of all that is given, as "device.gap"

    /// Where a key is given, or else its section, or the file's first line.
    Place place(const std::string& key) const;
};

/// Lengths in micrometres in the place of those of the file: of [device], of [process] as "process.NAME".
using GivenLengths = std::vector<std::pair<std::string, double>>;
/// The place of such a length, "given NAME".
Place given_place(const std::string& name);
bool is_given_place(const Place& place);

/// The value of such a number from a text with or without a unit, "12 um" or "2*8 GPa", in its own unit.
/// @throws InputError with the place
double dimension_of_text(const std::string& name, const std::string& text, const Place& place);

/// Reads the sections from a design's TOML text; docs/layout.md describes them. A length is a number in micrometres, an
/// expression, or either with nm, um, mm, cm or m behind it, and is rounded to the grid. What is not given is as in a
/// default-constructed DeviceDimensions.
/// @param file the name to use in messages
/// @throws InputErrors with the places of all that is wrong, or InputError for the only one
DeviceFile parse_device_file(std::string_view text, const std::string& file, const GivenLengths& given = {});
/// The design of this name or in this file. @throws InputError when there is neither, or something is wrong with it
DeviceFile load_device_file(const std::string& name_or_path, const GivenLengths& given = {});

} // namespace graze
