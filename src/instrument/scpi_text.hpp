#pragma once

#include "instrument/function_generator.hpp"

#include <optional>
#include <string_view>
#include <vector>

namespace graze {

/// Splits a text at separators, and trims the parts.
std::vector<std::string_view> parts(std::string_view text, char separator);
/// Whether a word is the long or the short form of a keyword such as "FREQuency", whose capitals are the short form.
bool is_form_of(std::string_view word, std::string_view pattern);
/// Whether a header such as FREQ:MODE matches a pattern such as "FREQuency:MODE".
bool matches(std::string_view header, std::string_view pattern);

/// Returns the text of an SCPI error number, such as "Undefined header".
std::string_view scpi_error_text(int number);
/// Converts an amplitude to the number that the display shows. @param peaks in V peak to peak
double shown_voltage(double peaks, VoltageUnit unit, WaveShape shape);
/// Converts an amplitude with a suffix to V peak to peak. @param suffix in capitals; empty: the present unit
/// @return false for an unknown suffix
bool read_voltage(std::string_view suffix, VoltageUnit unit, WaveShape shape, double& value);
/// "VPP", "VRMS" or "DBM".
std::string_view name_of(VoltageUnit unit);
std::optional<VoltageUnit> voltage_unit_named(std::string_view name);

} // namespace graze
