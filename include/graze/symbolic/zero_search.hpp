#pragma once

#include "graze/symbolic/function.hpp"
#include "graze/symbolic/interval.hpp"

#include <cstddef>
#include <functional>
#include <span>
#include <vector>

namespace graze {

/// An interval for each unknown.
using IntervalBox = std::vector<Interval>;

struct ZeroSearchSettings {
    /// Extent, relative to that of the searched box, at which a box that is neither proven empty nor to have one zero
    /// is left undecided; 1e-14 .. 0.1. Smaller ones separate zeros that are closer to each other.
    double resolution = 1e-9;
    std::size_t boxes = 100'000;         ///< the search ends when it has examined so many; at least 1
    std::function<bool()> interrupted{}; ///< called at each box; returns true to stop
};

/// A zero of which it is proven that it exists.
struct VerifiedZero {
    std::vector<double> values; ///< of the unknowns, by Newton's method; in the enclosure
    IntervalBox enclosure;      ///< contains the zero, and is about as small as round-off allows
    IntervalBox alone;          ///< contains the enclosure and no other zero
};

struct ZeroSearch {
    enum class Ending {
        complete,       ///< outside the verified zeros' and the undecided boxes there is no zero
        too_many_boxes, ///< the same holds outside the unexamined boxes
        interrupted     ///< the same
    };
    std::vector<VerifiedZero> zeros; ///< sorted by their values; those on the edge of the searched box included
    /// Boxes in which there may be more zeros, sorted by their lower ends: any number of them, or none, as at a double
    /// zero, zeros too close to each other, or where a function is undefined. Boxes that touch or nearly touch are
    /// merged, verified zeros between them included.
    std::vector<IntervalBox> undecided;
    std::vector<IntervalBox>
        unexamined; ///< what is left when the search ends early, merged likewise; empty if complete
    Ending ending = Ending::complete;
    std::size_t boxes = 0; ///< number of boxes examined
};

/// Finds all zeros that n functions of n unknowns have in a box, and proves it: by bisection, bounds of the functions
/// and their derivatives in interval arithmetic, and the interval Newton method. The proofs are for the functions as
/// compiled, and take the rounded constants in their compiled derivatives for exact.
///
/// R. Krawczyk, Newton-Algorithmen zur Bestimmung von Nullstellen mit Fehlerschranken, Computing 4 (1969) 187;
/// A. Neumaier, Interval Methods for Systems of Equations, Cambridge 1990, ch. 5; E. Hansen, S. Sengupta, Bounding
/// solutions of systems of equations using interval analysis, BIT 21 (1981) 203.
/// @param function inputs: the unknowns, then parameters; outputs: n functions, then their derivatives with respect to
///        the unknowns, row by row
/// @param lower, upper the box; @param parameters values of the other inputs
/// @throws InputError for a function with other numbers of inputs or outputs, a box that is not finite or has no
///         extent, settings outside their limits
ZeroSearch find_zeros(const Function& function, std::span<const double> lower, std::span<const double> upper,
                      std::span<const double> parameters = {}, const ZeroSearchSettings& settings = {});

} // namespace graze
