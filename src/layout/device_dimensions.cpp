#include "graze/layout/device_dimensions.hpp"

#include "graze/base/input_error.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>

namespace graze {

namespace {

using DeviceLength = LengthField<DeviceDimensions>;
constexpr std::array device_table{
    DeviceLength{"electrode_length", &DeviceDimensions::electrode_length, "length of the fixed electrode's face"},
    DeviceLength{"electrode_width", &DeviceDimensions::electrode_width, "from the electrode's face to its pad"},
    DeviceLength{"gap", &DeviceDimensions::gap, "between the electrodes"},
    DeviceLength{"pad_length", &DeviceDimensions::pad_length, "of the electrode's contact pad, along the motion"},
    DeviceLength{"pad_width", &DeviceDimensions::pad_width, "of the electrode's contact pad, across the motion"},
    DeviceLength{"moat", &DeviceDimensions::moat, "between the fixed electrode and the frame"},
    DeviceLength{"base_inset", &DeviceDimensions::base_inset, "by which the electrode hangs over its base"},
    DeviceLength{"bar_width", &DeviceDimensions::bar_width, "of each upright bar of the H"},
    DeviceLength{"bridge_width", &DeviceDimensions::bridge_width, "of the bar between them"},
    DeviceLength{"clearance", &DeviceDimensions::clearance, "between what moves and what it moves along"},
    DeviceLength{"flexure_width", &DeviceDimensions::flexure_width, "of a beam of the flexures"},
    DeviceLength{"flexure_length", &DeviceDimensions::flexure_length, "of a beam of the flexures"},
    DeviceLength{"flexure_spacing", &DeviceDimensions::flexure_spacing, "between neighbouring beams"},
    DeviceLength{"flexure_middle", &DeviceDimensions::flexure_middle, "between the first beams of both sides"},
    DeviceLength{"truss_width", &DeviceDimensions::truss_width, "of what joins beams"},
    DeviceLength{"stop_gap", &DeviceDimensions::stop_gap, "between the stops and the mass"},
    DeviceLength{"stop_width", &DeviceDimensions::stop_width, "of a stop"},
    DeviceLength{"channel_width", &DeviceDimensions::channel_width, "of the channel between the stops"},
    DeviceLength{"chamber_margin", &DeviceDimensions::chamber_margin,
                 "of the chamber around what is etched from the front", true},
    DeviceLength{"die_length", &DeviceDimensions::die_length, "of the die, along the motion"},
    DeviceLength{"die_width", &DeviceDimensions::die_width, "of the die, across the motion"},
    DeviceLength{"frame_width", &DeviceDimensions::frame_width, "least distance of the chamber from the die's edge"},
    DeviceLength{"mark_size", &DeviceDimensions::mark_size, "of an alignment mark; 0: none", true},
    DeviceLength{"label_height", &DeviceDimensions::label_height, "of the letters on the die; 0: none", true},
};

using Process = LengthField<ProcessData>;
constexpr std::array process_table{
    Process{"wafer_thickness", &ProcessData::wafer_thickness, "of the wafer with the devices"},
    Process{"chamber_depth", &ProcessData::chamber_depth, "of the chambers etched into its back"},
};

} // namespace

std::span<const LengthField<DeviceDimensions>> device_fields() {
    return device_table;
}

std::span<const LengthField<ProcessData>> process_fields() {
    return process_table;
}

double length_on_grid(double value, const std::string& what, bool may_be_zero) {
    if (!std::isfinite(value))
        throw InputError(fmt::format("{} is not a finite number", what), "give a length in micrometres");
    if (value < 0 || (value == 0 && !may_be_zero))
        throw InputError(fmt::format("{} is {:.6g} um, not positive", what, value),
                         may_be_zero ? "give zero or a positive length" : "give a positive length");
    if (value > greatest_length)
        throw InputError(fmt::format("{} is {:.6g} um, more than a metre", what, value),
                         "give a length in micrometres, at most 1e6");
    const double rounded = std::round(value * grid_per_micrometre) / grid_per_micrometre;
    if (value > 0 && rounded == 0)
        throw InputError(
            fmt::format("{} is {:.6g} um, less than the grid of 1 nm on which masks are drawn", what, value),
            "give a greater length");
    return rounded;
}

} // namespace graze
