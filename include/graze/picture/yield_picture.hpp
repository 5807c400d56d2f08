#pragma once

#include "graze/branch/yield.hpp"
#include "graze/picture/figure.hpp"

#include <optional>
#include <string>

namespace graze {

/// How the values of devices are distributed, as bars, and a normal distribution by the derivatives alone.
/// @param parameter whose values they are; @param least, greatest values that are wanted, marked
Figure yield_picture(const Yield& yield, const std::string& parameter, const std::string& unit,
                     std::optional<double> least, std::optional<double> greatest);

} // namespace graze
