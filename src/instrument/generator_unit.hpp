#pragma once

#include "instrument/function_generator.hpp"

#include <optional>
#include <string_view>

namespace graze {

/// What a display shows of an amplitude. @param peaks in V from peak to peak
double shown_voltage(double peaks, VoltageUnit unit, WaveShape shape);
/// Of an amplitude with a suffix, V from peak to peak. @param suffix in capitals; empty: the unit itself
/// @return false for a suffix that there is not
bool read_voltage(std::string_view suffix, VoltageUnit unit, WaveShape shape, double& value);
/// "VPP", "VRMS" or "DBM".
std::string_view name_of(VoltageUnit unit);
std::optional<VoltageUnit> voltage_unit_named(std::string_view name);

} // namespace graze
