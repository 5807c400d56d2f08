#pragma once

#include "graze/layout/wafer_yield.hpp"

#include <optional>
#include <string>

namespace graze {

/// What a map of wafers is labelled with.
struct WaferMapLabels {
    std::string title, control, unit;
    std::optional<double> least, greatest; ///< trip values that will do: such devices have a ring
};

constexpr std::size_t most_wafers_drawn = 16; ///< of more the first ones are drawn

/// Where on wafers devices trip, coloured by the trip value; one without has a cross.
/// @param ending svg, png or pdf; @param output the file that the commands write
std::string wafer_map_script(const WaferYield& yield, const WaferPlan& plan, const WaferMapLabels& labels,
                             const std::string& ending, const std::string& output);

} // namespace graze
