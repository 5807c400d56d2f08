#pragma once

#include "orbit/shooting.hpp"

namespace graze {

/// Whether an orbit is one of a family at the same parameters, as all orbits of a model are that conserves a quantity:
/// its equations leave a direction free, and so do those of an orbit that lies in that direction, at a distance. At
/// folds and branch points orbits lie so only at other parameters, or none do.
/// @param equations by shooting, without free parameters; @param at their evaluation at the orbit
bool is_in_family(Shooting& equations, const OrbitEvaluation& at);

} // namespace graze
