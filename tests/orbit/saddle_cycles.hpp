// Saddle cycles in closed form, and homoclinic orbits of one of them, through a contact.

#pragma once

#include "orbit/orbits.hpp"
#include "trajectory/model_parts.hpp"

#include <fmt/format.h>

#include <cmath>
#include <numbers>

namespace graze::testing {

/// x grows at the rate 0.2 and y decays at the rate 0.3; at x = 1 the state jumps to (c + A cos(theta), 1). The origin
/// is a cycle, since there is a clock. Its unstable manifold y = 0 meets the gate at all phases, and comes back in the
/// stable manifold x = 0 where c + A cos(theta) = 0: homoclinic orbits pass the gate at these phases, and manifolds
/// touch at c = A and at c = -A.
inline OneMode parts_of_gated_saddle(double c, double amplitude = 0.5) {
    return OneMode{.parameters = fmt::format("c = {:.17g}\nA = {:.17g}", c, amplitude),
                   .states = "x = 0\ny = 0",
                   .rates = "x = '0.2*x', y = '-0.3*y'",
                   .clock = "1",
                   .stops = {{"gate", "1 - x", "x = 'c + A*cos(theta) + 0.3*y'\ny = 1", "back"}}};
}
inline Model gated_saddle(double c, double amplitude = 0.5) {
    return parts_of_gated_saddle(c, amplitude).model();
}

/// The cycle, of which the return is at the section `start`.
inline Orbit origin_of(const Model& model) {
    return given_orbit(model, "start", {{0, 0, 0}}, {2 * std::numbers::pi});
}

/// The map of Henon, (x, y) -> (1 - a x^2 + y, b x), made once per unit of time.
inline Model henon_map(double a, double b) {
    return OneMode{.parameters = fmt::format("a = {:.17g}\nb = {:.17g}", a, b),
                   .states = "x = 0\ny = 0\nclock = 0",
                   .rates = "x = 0, y = 0, clock = 1",
                   .stops = {{"tick", "1 - clock", "x = '1 - a*x^2 + y'\ny = 'b*x'\nclock = 0", "map"}}}
        .model();
}

/// Its fixed point with positive x, which is a saddle, and the multipliers, the unstable one first.
struct HenonSaddle {
    HenonSaddle(double a, double b)
        : x((b - 1 + std::sqrt((1 - b) * (1 - b) + 4 * a)) / (2 * a)), y(b * x),
          unstable(-a * x - std::sqrt(a * a * x * x + b)), stable(-a * x + std::sqrt(a * a * x * x + b)) {}
    double x, y, unstable, stable;
};
inline Orbit saddle_of_henon(const Model& model, double a, double b) {
    const HenonSaddle saddle(a, b);
    return given_orbit(model, "map", {{saddle.x, saddle.y, 0}}, {1});
}

} // namespace graze::testing
