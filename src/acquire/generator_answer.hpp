#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace graze {

/// Whether an error may come from a garbled line, so that another attempt may succeed.
bool is_of_transmission(int error);

/// Parses an answer that is a number. @return nothing for any other answer
std::optional<double> answered_number(std::string_view answer);

/// Parses the number at the beginning of an answer to SYST:ERR?, such as -113,"Undefined header"; 0 for no error.
/// @return nothing for any other answer
std::optional<int> answered_error(std::string_view answer);

/// Returns an answer trimmed and in capitals, for comparisons.
std::string compared(std::string_view answer);

/// Ratio of a generator's open-circuit voltage to the one it displays for a given load.
double inner_by_shown(double load);

/// Whether an answer, in capitals, reports this load.
bool tells_load(const std::string& answer, double load);
/// Whether an answer, in capitals, reports a switch that is off, or on.
bool tells_off(const std::string& answer);
bool tells_on(const std::string& answer);

} // namespace graze
