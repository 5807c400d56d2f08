#pragma once

#include "graze/branch/special_point.hpp"
#include "graze/flow/system.hpp"

#include <string>

namespace graze {

/// Returns the name of a bifurcation of an orbit at a surface along which a slide lets motions slide, in the words of
/// di Bernardo et al. 2008, chapter 8: "grazing-sliding", "crossing-sliding", "switching-sliding", "adding-sliding".
/// Empty for other points. @param special a grazing, guard or vanishing point, complete but for its details
std::string sliding_name(const System& system, const SpecialPoint& special);

/// True at adding-sliding, where a slide becomes two with a short motion off the surface between them. The orbit goes
/// on through it; its equations are singular there to higher order in the duration of that motion.
bool is_adding_sliding(const System& system, const SpecialPoint& special);

} // namespace graze
