#pragma once

#include "orbit/shooting.hpp"

namespace graze {

/// True when an orbit belongs to a family of orbits at the same parameters, as in models that conserve a quantity: its
/// equations are singular, and displaced along the null vector Newton's method converges to another orbit there, whose
/// equations are singular too. At folds and branch points such orbits exist only at other parameters, or not at all.
/// @param equations without free parameters; @param at their evaluation at the orbit
bool is_in_family(Shooting& equations, const OrbitEvaluation& at);

} // namespace graze
