#pragma once

#include "graze/layout/etched_wall.hpp"

namespace graze {

/// The gas between moving parts.
struct Gas {
    double pressure = 0;       ///< in Pa
    double viscosity = 0;      ///< in Pa s; for a dilute gas independent of the pressure
    double mean_free_path = 0; ///< in m, at the standard atmosphere of 101325 Pa
};

/// Returns the mean free path at the gas's own pressure, in m.
double mean_free_path_of(const Gas& gas);

/// Returns the effective viscosity of a thin film in Pa s: at Knudsen number K = (mean free path)/gap it is lower by 1
/// + 9.638 K^1.159 (T. Veijola, H. Kuisma, J. Lahdenpera and T. Ryhanen, "Equivalent-circuit model of the squeezed gas
/// film in a silicon accelerometer", Sens. Actuators A 48 (1995)).
/// @throws InputError for a gas or a gap that is not positive and finite
double effective_viscosity(const Gas& gas, double gap);

/// A gas film between two walls, one of which moves towards the other; it is open along all four edges. Lengths in m.
struct GasFilm {
    double length = 0; ///< along the trench
    double height = 0; ///< from its top to its bottom
    EtchedWidth gap;   ///< at rest; linear in the depth
};

/// Returns the damping coefficient, in N s/m, of an incompressible film (thin and slow), by Reynolds' equation div(g^3
/// grad p) = 12 mu v. Across a film that is much longer than high its solution is an integral,
///
///     c = 12 mu l (I2 - I1^2/I0),  Ik the integral of z^k/g^3 over the height,
///
/// which is mu l h^3/g^3 for a constant gap. The flow out of the ends is included by the factor for a constant gap (W.
/// S. Griffin, H. H. Richardson and S. Yamanami, "A study of fluid squeeze-film damping", J. Basic Eng. 88 (1966); J.
/// J. Blech, "On isothermal squeeze films", J. Lubr. Technol. 105 (1983)), for h <= l
///
///     1 - (192/pi^5)(h/l) sum over odd n of tanh(n pi l/(2 h))/n^5.
///
/// The viscosity is effective_viscosity at the mean gap.
/// @throws InputError for lengths that are not positive and finite
double squeeze_film_damping(const GasFilm& film, const Gas& gas);

/// Returns the squeeze number 12 mu omega s^2/(p g^2) with the shorter side s: unless it is small, the gas is
/// compressed rather than pressed out. @param angular_frequency in rad/s
double squeeze_number(const GasFilm& film, const Gas& gas, double angular_frequency);

/// Returns the damping coefficient mu A/(g + 2 lambda), in N s/m, of a plate that slides along a wall. The gas slips at
/// either wall by the mean free path lambda times the shear (J. C. Maxwell, Phil. Trans. R. Soc. 170 (1879)), so that
/// the shear is lower by 1 + 2 K.
/// @param area in m^2 @param gap in m
double sliding_film_damping(double area, double gap, const Gas& gas);

} // namespace graze
