#pragma once

#include "graze/layout/wafer_yield.hpp"

#include <cstddef>
#include <optional>
#include <string>

namespace graze {

/// Labels of a map of wafers.
struct WaferMapLabels {
    std::string title, control, unit;
    std::optional<double> least, greatest; ///< acceptable trip values; devices within them are ringed
};

constexpr std::size_t most_wafers_drawn = 16; ///< of more wafers only the first ones are drawn

/// Commands for gnuplot that draw the devices on their wafers, coloured by the trip value; devices without one are
/// crosses.
/// @param ending svg, png or pdf; @param output the file that the commands write
std::string wafer_map_script(const WaferYield& yield, const WaferPlan& plan, const WaferMapLabels& labels,
                             const std::string& ending, const std::string& output);

} // namespace graze
