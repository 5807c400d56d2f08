#pragma once

#include "graze/layout/etched_wall.hpp"

namespace graze {

/// A gas at rest between moving parts.
struct Gas {
    double pressure = 0;       ///< in Pa
    double viscosity = 0;      ///< in Pa s; of a dilute gas it does not depend on the pressure
    double mean_free_path = 0; ///< in m, at the standard atmosphere of 101325 Pa
};

/// The mean free path at the gas's own pressure, in m.
double mean_free_path_of(const Gas& gas);

/// The viscosity that the flow in a film seems to have: at Knudsen number K = (mean free path)/gap it is lower by
/// 1 + 9.638 K^1.159 (T. Veijola, H. Kuisma, J. Lahdenpera and T. Ryhanen, "Equivalent-circuit model of the squeezed
/// gas film in a silicon accelerometer", Sens. Actuators A 48 (1995)). In Pa s.
/// @throws InputError for a gas or a gap that is not positive and finite
double effective_viscosity(const Gas& gas, double gap);

/// Two walls, one of which moves towards the other; the film is open along all four edges. Lengths in m.
struct GasFilm {
    double length = 0; ///< along the trench
    double height = 0; ///< from its top to its bottom
    EtchedWidth gap;   ///< at rest; linear in the depth
};

/// Damping force by velocity, in N s/m, of a film too thin and slow to be compressed: by Reynolds' equation
/// div(g^3 grad p) = 12 mu v. Across a film that is much longer than high its solution is a quadrature,
///
///     c = 12 mu l (I2 - I1^2/I0),  Ik the integral of z^k/g^3 over the height,
///
/// which is mu l h^3/g^3 for a constant gap. At the ends gas flows out as well, which the factor of the constant gap
/// allows for (W. S. Griffin, H. H. Richardson and S. Yamanami, "A study of fluid squeeze-film damping", J. Basic Eng.
/// 88 (1966); J. J. Blech, "On isothermal squeeze films", J. Lubr. Technol. 105 (1983)), for h <= l
///
///     1 - (192/pi^5)(h/l) sum over odd n of tanh(n pi l/(2 h))/n^5.
///
/// The viscosity is effective_viscosity at the mean gap.
/// @throws InputError for lengths that are not positive and finite
double squeeze_film_damping(const GasFilm& film, const Gas& gas);

/// The squeeze number 12 mu omega s^2/(p g^2) with the shorter side s: the gas is compressed rather than pressed out
/// when it is not small. @param angular_frequency in rad/s
double squeeze_number(const GasFilm& film, const Gas& gas, double angular_frequency);

/// A plate that moves along a wall: mu A/(g + 2 lambda), in N s/m. The gas slips at either wall by the mean free path
/// lambda times the shear (J. C. Maxwell, Phil. Trans. R. Soc. 170 (1879)), so that the shear is lower by 1 + 2 K.
/// @param area in m^2 @param gap in m
double sliding_film_damping(double area, double gap, const Gas& gas);

} // namespace graze
