#pragma once

#include "instrument/function_generator.hpp"

#include <optional>
#include <string_view>

namespace graze {

/// Converts an amplitude to the number that the display shows. @param peaks in V peak to peak
double shown_voltage(double peaks, VoltageUnit unit, WaveShape shape);
/// Converts an amplitude with a suffix to V peak to peak. @param suffix in capitals; empty: the present unit
/// @return false for an unknown suffix
bool read_voltage(std::string_view suffix, VoltageUnit unit, WaveShape shape, double& value);
/// "VPP", "VRMS" or "DBM".
std::string_view name_of(VoltageUnit unit);
std::optional<VoltageUnit> voltage_unit_named(std::string_view name);

} // namespace graze
