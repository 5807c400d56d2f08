#pragma once

#include "graze/layout/etched_wall.hpp"
#include "graze/layout/squeeze_film.hpp"

#include <span>

namespace graze {

/// Conditions of the process and of operation. Each number is in the unit of its field.
struct ProcessConditions {
    double bias = 0;               ///< um, recess of silicon from each drawn edge
    double taper = 0;              ///< deg, of walls from the vertical; positive: trenches widen towards their bottom
    double modulus = 169;          ///< GPa, Young's modulus along the beams; default: silicon in <110>
    double density = 2330;         ///< kg/m^3
    double pressure = 101325;      ///< Pa, of the gas around the device
    double viscosity = 1.82e-5;    ///< Pa s, of that gas
    double mean_free_path = 0.067; ///< um, of that gas at 101325 Pa
    double bond_thickness = 3;     ///< um, thickness of the epoxy between the wafers
    double base_thickness = 500;   ///< um, thickness of the lower wafer

    /// The etched wall, in um.
    EtchedWall wall() const;
    Gas gas() const;
};

/// Descriptor of a number in a section of a design file, which may be given in any unit of its dimension.
template <class Section>
struct QuantityField {
    const char* name;
    double Section::*member;
    const char* unit; ///< unit in the program, and in the file by default; empty: a ratio
    double least, greatest;
    const char* text; ///< description
};

std::span<const QuantityField<ProcessConditions>> condition_fields();

/// Limits of fabrication and operation. Infinite ones are not applied.
struct RuleLimits {
    double smallest_line = 4;        ///< um, width of silicon between two trenches
    double smallest_gap = 4;         ///< um, width of a trench
    double smallest_etched_line = 2; ///< um, width of a line after the etch, at its narrowest
    double smallest_etched_gap = 2;  ///< um, width of a front trench after the etch, at its narrowest
    double largest_aspect = 40;      ///< ratio of a trench's depth to its width
    double chamber_overlap = 20;     ///< um, least extension of a chamber beyond what moves above it
    double undercut = 10;            ///< um, least overhang of the fixed electrode over its base
    double largest_stop_share = 0.9; ///< largest ratio of the stop's gap to the travel until the electrodes touch
    double largest_stress = 300;     ///< MPa, in a beam at the stops, and when the electrodes touch
    double largest_squeeze = 0.5;    ///< squeeze number up to which the gas counts as incompressible
};
std::span<const QuantityField<RuleLimits>> rule_fields();
/// Returns the infinite limit that switches a rule off.
double no_limit(const QuantityField<RuleLimits>& rule);

} // namespace graze
