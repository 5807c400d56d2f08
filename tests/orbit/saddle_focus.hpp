#pragma once

#include "trajectory/model_parts.hpp"

namespace graze::testing {

/// A saddle at x = p, y = z = p^2 with two complex stable eigenvalues and nonlinear terms.
inline Model focus() {
    return OneMode{.parameters = "p = 0.4\nq = 1.3",
                   .states = "x = 0.5\ny = 0.1\nz = 0.2",
                   .definitions = "u = 'x - p'\nr = 'y - p^2'\ns = 'z - p^2'",
                   .rates = "x = 'q*u + p*r + u*r', y = '-0.3*r - q*s + p*u + u^2', z = 'q*r - 0.3*s + s*u + 0.2*u'"}
        .model();
}

} // namespace graze::testing
