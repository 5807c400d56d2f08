#pragma once

#include "graze/model/microbeam.hpp"

#include <vector>

namespace graze {

/// A node x of a quadrature rule on [0, 1] that is symmetric about 1/2, together with its mirror image 1 - x of the
/// same weight; the node at 1/2 is its own image and counts once.
struct NodePair {
    double x;      ///< 0 < x <= 1/2
    double weight; ///< of x without its mirror image
    bool is_centre() const { return x == 0.5; }
};

/// Returns the nodes of Simpson's rule with `points` intervals (even) without the end points, where the integrands of
/// interest vanish; or those of Gauss's rule with `points` nodes. In increasing order of x.
/// @throws InputError when `points` does not suit the rule
std::vector<NodePair> node_pairs(Quadrature rule, int points);

} // namespace graze
