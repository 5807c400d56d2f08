#pragma once

#include "graze/branch/yield.hpp"
#include "graze/picture/figure.hpp"

#include <optional>
#include <string>

namespace graze {

/// A histogram of the values of devices, and the normal distribution that follows from the derivatives.
/// @param parameter name of the value; @param least, greatest limits of acceptable values, which are marked
/// @throws InputError when no value was found, or all are equal
Figure yield_picture(const Yield& yield, const std::string& parameter, const std::string& unit,
                     std::optional<double> least, std::optional<double> greatest);

} // namespace graze
