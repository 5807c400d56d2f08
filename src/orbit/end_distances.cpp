#include "orbit/end_distances.hpp"

#include <algorithm>
#include <cmath>

namespace graze {

/// The spaces are curved, so that an orbit that ends in the linear stable space at a small distance d is off its stable
/// manifold by d^2. Followed back along the orbit that shrinks with the slowest growth g, while d grows with the
/// slowest decay s: the effect on the orbit is of the order d^(2 + g/s). The same holds for the beginning with s/g.
EndDistances wanted_distances(double growth, double decay, double effect) {
    constexpr double least = 1e-7, greatest = 0.05;
    const auto distance = [&](double ratio) { return std::clamp(std::pow(effect, 1 / (2 + ratio)), least, greatest); };
    return {distance(decay / growth), distance(growth / decay)};
}

} // namespace graze
