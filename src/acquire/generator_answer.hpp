#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace graze {

/// Errors of a line that has not come as it was sent, which may come better the next time.
bool is_of_transmission(int error);

/// A whole answer that is a number. @return none for another one
std::optional<double> answered_number(std::string_view answer);

/// The number that an answer to SYST:ERR? begins with, as in -113,"Undefined header"; 0 for no error.
/// @return none for another answer
std::optional<int> answered_error(std::string_view answer);

/// Without what surrounds it, and in capitals, as answers are compared.
std::string compared(std::string_view answer);

/// By which a generator's inner voltage is larger than what it shows, when it was told of a load.
double inner_by_shown(double load);

/// Whether an answer, in capitals, says that it was told of this load.
bool tells_load(const std::string& answer, double load);
bool tells_off(const std::string& answer);
bool tells_on(const std::string& answer);

} // namespace graze
