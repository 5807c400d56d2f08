#include "instrument/generator_unit.hpp"

#include <cmath>
#include <numbers>

namespace graze {

namespace {

constexpr double ohms = 50, milliwatt = 1e-3;

/// Ratio of peak-to-peak amplitude to root mean square.
double crest(WaveShape shape) {
    switch (shape) {
    case WaveShape::sine:
        return 2 * std::numbers::sqrt2;
    case WaveShape::triangle:
    case WaveShape::ramp:
        return 2 * std::numbers::sqrt3;
    case WaveShape::square:
    case WaveShape::dc:
        break;
    }
    return 2;
}

double peaks_of(double value, VoltageUnit unit, WaveShape shape) {
    if (unit == VoltageUnit::dbm)
        value = std::sqrt(ohms * milliwatt * std::pow(10, value / 10));
    return unit == VoltageUnit::vpp ? value : value * crest(shape);
}

} // namespace

double shown_voltage(double peaks, VoltageUnit unit, WaveShape shape) {
    if (unit == VoltageUnit::vpp)
        return peaks;
    const double effective = peaks / crest(shape);
    return unit == VoltageUnit::vrms ? effective : 10 * std::log10(effective * effective / ohms / milliwatt);
}

bool read_voltage(std::string_view suffix, VoltageUnit unit, WaveShape shape, double& value) {
    if (suffix.empty() || (suffix == "V" && unit != VoltageUnit::dbm))
        value = peaks_of(value, unit, shape);
    else if (suffix == "MV" && unit != VoltageUnit::dbm)
        value = peaks_of(1e-3 * value, unit, shape);
    else if (suffix == "MVPP")
        value *= 1e-3;
    else if (const auto named = voltage_unit_named(suffix))
        value = peaks_of(value, *named, shape);
    else
        return false;
    return true;
}

std::string_view name_of(VoltageUnit unit) {
    return unit == VoltageUnit::vpp ? "VPP" : unit == VoltageUnit::vrms ? "VRMS" : "DBM";
}

std::optional<VoltageUnit> voltage_unit_named(std::string_view name) {
    for (const VoltageUnit unit : {VoltageUnit::vpp, VoltageUnit::vrms, VoltageUnit::dbm})
        if (name == name_of(unit))
            return unit;
    return std::nullopt;
}

} // namespace graze
