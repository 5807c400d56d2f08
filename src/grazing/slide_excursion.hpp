#pragma once

#include "grazing/contact_effect.hpp"

namespace graze {

/// The effect of a short excursion from a slide whose motion touches, from within, the edge h = 0 of where it slides
/// (adding-sliding: M. di Bernardo, P. Kowalczyk and A. B. Nordmark, Physica D 170, 2002). Beyond the touch the motion
/// leaves the surface H = 0 at the edge and is back after three times the time that it took from there to its least h
/// = -d: H' is a multiple of -h, whose integral vanishes then.
///
/// Let F be the sliding field and D = h M + H N the difference of the field of the excursion from it. Pulled back by
/// the flow of F, the motion obeys y' = D + t [F, D], whose integral from -T to 2 T, with T^2 = 2 d/a, is proportional
/// to d^2: the terms in d^(3/2) cancel. M and [F, M] follow from the second and third Lie bracket of D along F.
/// @param functions of h in the sliding mode; @param chain one contact, into a mode that is left by `chain.slid_along`
/// @return shift of the states, on the surface, per unit of d^2
ContactEffect slide_excursion(const TouchFunctions& functions, const TouchState& touch, const TouchGeometry& geometry,
                              const TouchSizes& sizes, const ContactChain& chain);

} // namespace graze
