#include "graze/layout/process_conditions.hpp"

#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <string_view>

namespace graze {

namespace {

using Field = QuantityField<ProcessConditions>;
// The limits are far beyond any real process; they keep results finite.
constexpr std::array condition_table{
    Field{"bias", &ProcessConditions::bias, "um", -1e3, 1e3, "by which silicon recedes from each drawn edge"},
    Field{"taper", &ProcessConditions::taper, "deg", -45, 45,
          "of the walls from the vertical; positive: trenches are wider at their bottom"},
    Field{"modulus", &ProcessConditions::modulus, "GPa", 1e-6, 1e6, "Young's, along the beams"},
    Field{"density", &ProcessConditions::density, "kg/m^3", 1e-3, 1e6, "of what moves"},
    Field{"pressure", &ProcessConditions::pressure, "Pa", 1e-6, 1e9, "of the gas around the device"},
    Field{"viscosity", &ProcessConditions::viscosity, "Pa s", 1e-9, 1e3, "of that gas"},
    Field{"mean_free_path", &ProcessConditions::mean_free_path, "um", 1e-9, 1e6, "of that gas at 101325 Pa"},
    Field{"bond_thickness", &ProcessConditions::bond_thickness, "um", 0, 1e4, "of the epoxy between the wafers"},
    Field{"base_thickness", &ProcessConditions::base_thickness, "um", 1e-3, 1e5, "of the wafer below"},
};

using Rule = QuantityField<RuleLimits>;
constexpr std::array condition_rules{
    Rule{"smallest_line", &RuleLimits::smallest_line, "um", 0, 1e6, "of silicon between two trenches"},
    Rule{"smallest_gap", &RuleLimits::smallest_gap, "um", 0, 1e6, "of a trench"},
    Rule{"smallest_etched_line", &RuleLimits::smallest_etched_line, "um", 0, 1e6, "of a line after the etch"},
    Rule{"smallest_etched_gap", &RuleLimits::smallest_etched_gap, "um", 0, 1e6, "of a trench after the etch"},
    Rule{"largest_aspect", &RuleLimits::largest_aspect, "", 1e-3, 1e6, "depth of a trench by its width"},
    Rule{"chamber_overlap", &RuleLimits::chamber_overlap, "um", 0, 1e6, "of a chamber around what moves above it"},
    Rule{"undercut", &RuleLimits::undercut, "um", 0, 1e6, "of the fixed electrode beyond its base"},
    Rule{"largest_stop_share", &RuleLimits::largest_stop_share, "", 1e-6, 1e3,
         "way to the stops by the way until the electrodes touch"},
    Rule{"largest_stress", &RuleLimits::largest_stress, "MPa", 1e-6, 1e6,
         "in a beam, at the stops and where the electrodes touch"},
    Rule{"largest_squeeze", &RuleLimits::largest_squeeze, "", 1e-9, 1e6, "squeeze number of the gas in the gap"},
};

} // namespace

std::span<const Rule> rule_fields() {
    return condition_rules;
}

double no_limit(const Rule& rule) {
    const double infinite = std::numeric_limits<double>::infinity();
    return std::string_view(rule.name).starts_with("largest") ? infinite : -infinite;
}

EtchedWall ProcessConditions::wall() const {
    return {bias, std::tan(taper * (std::numbers::pi / 180))};
}

Gas ProcessConditions::gas() const {
    return {pressure, viscosity, mean_free_path * 1e-6};
}

std::span<const Field> condition_fields() {
    return condition_table;
}

} // namespace graze
