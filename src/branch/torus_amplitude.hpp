#pragma once

#include "branch/torus_problem.hpp"
#include "branch/turning_pair.hpp"

#include <optional>

namespace graze {

/// Returns the amplitude, along the vector of the pair in the scales of the setting, beyond which the return departs
/// from its linear part by half of it: the size of the tori that begin there. Known to a factor of 2. Empty where none
/// is found, as for linear returns.
/// @param at return of the orbit
std::optional<double> amplitude_of_tori(const TorusSetting& setting, const SignatureReturn::Image& at, double parameter,
                                        const TurningPair& pair);

/// Scales the states that the pair moves by the size of the tori, if that differs by orders of magnitude from their
/// extent along the orbit: states that are zero on the orbit have none. @return whether scales have changed
bool scale_by_amplitude(TorusSetting& setting, const SignatureReturn::Image& at, double parameter,
                        const TurningPair& pair);

} // namespace graze
