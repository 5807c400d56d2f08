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

/// Content of the sections [device], [process], [rules], [spread] and [wafer] of a design file; the other sections
/// belong to the design itself.
struct DeviceFile {
    std::string name, text, file;
    /// Shipped model or path of a model, whose parameters the device determines.
    std::string model = "mems-switch-device";
    DeviceDimensions device;
    ProcessData process;
    ProcessConditions conditions; ///< also from [process]
    RuleLimits rules;
    ProcessSpread spread;
    WaferPlan wafer;
    std::map<std::string, Place, std::less<>> places; ///< places of all given keys, such as "device.gap"

    /// Place of a key, or else of its section, or the first line of the file.
    Place place(const std::string& key) const;
};

/// Lengths in micrometres that override those of the file: of [device] by name, of [process] as "process.NAME".
using GivenLengths = std::vector<std::pair<std::string, double>>;
/// The place of such a length, "given NAME".
Place given_place(const std::string& name);
bool is_given_place(const Place& place);

/// Parses such a number with or without a unit, such as "12 um" or "2*8 GPa", and returns it in its own unit.
/// @throws InputError with the place
double dimension_of_text(const std::string& name, const std::string& text, const Place& place);

/// Reads the sections from a design's TOML text, whose format docs/layout.md describes. A length is a number in
/// micrometres, an expression, or either followed by nm, um, mm, cm or m; it is rounded to the grid. Missing dimensions
/// have the defaults of DeviceDimensions.
/// @param file name for messages
/// @throws InputErrors with places for several errors, InputError for a single one
DeviceFile parse_device_file(std::string_view text, const std::string& file, const GivenLengths& given = {});
/// Loads the sections of a shipped design by name, or of a design file. @throws InputError when neither exists, or it
/// is invalid
DeviceFile load_device_file(const std::string& name_or_path, const GivenLengths& given = {});

} // namespace graze
