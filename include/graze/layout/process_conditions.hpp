#pragma once

#include "graze/layout/etched_wall.hpp"
#include "graze/layout/squeeze_film.hpp"

#include <span>

namespace graze {

/// What the process makes of a drawing, and of what. Each number is in the unit of its field.
struct ProcessConditions {
    double bias = 0;            ///< um, by which silicon recedes from each drawn edge
    double taper = 0;           ///< deg, of the walls from the vertical; positive: trenches are wider at their bottom
    double modulus = 169;       ///< GPa, Young's, along the beams: of silicon in <110>
    double density = 2330;      ///< kg/m^3
    double pressure = 101325;   ///< Pa, of the gas around the device
    double viscosity = 1.82e-5; ///< Pa s, of that gas
    double mean_free_path = 0.067; ///< um, of that gas at 101325 Pa
    double bond_thickness = 3;     ///< um, of the epoxy between the wafers
    double base_thickness = 500;   ///< um, of the wafer below

    /// In um.
    EtchedWall wall() const;
    Gas gas() const;
};

/// A number of a section of a design file, which may be written with any unit of its kind.
template <class Section>
struct QuantityField {
    const char* name;
    double Section::*member;
    const char* unit; ///< of the number in the program, and in the file where none is given; empty: a ratio
    double least, greatest;
    const char* text; ///< for people
};

std::span<const QuantityField<ProcessConditions>> condition_fields();

/// Limits of what can be made, and of what the device may do. Infinite ones are not applied.
struct RuleLimits {
    double smallest_line = 4;        ///< um, of silicon between two trenches
    double smallest_gap = 4;         ///< um, of a trench
    double smallest_etched_line = 2; ///< um, of what an etch of the front leaves of a line, where it is narrowest
    double smallest_etched_gap = 2;  ///< um, of a trench from the front after the etch, where it is narrowest
    double largest_aspect = 40;      ///< depth of a trench by its width
    double chamber_overlap = 20;     ///< um, by which a chamber reaches at least beyond what moves above it
    double undercut = 10;            ///< um, by which the fixed electrode reaches at least beyond its base
    double largest_stop_share = 0.9; ///< of the way until the electrodes touch, that the stop's gap is
    double largest_stress = 300;     ///< MPa, in a beam at the stops, and where the electrodes touch
    double largest_squeeze = 0.5;    ///< squeeze number, up to which the gas is taken not to be compressed
};
std::span<const QuantityField<RuleLimits>> rule_fields();
/// The limit of a rule that is not applied.
double no_limit(const QuantityField<RuleLimits>& rule);

} // namespace graze
