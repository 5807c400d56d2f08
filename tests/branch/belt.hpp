#pragma once

#include "branch/follow.hpp"

namespace graze::testing {

/// x'' + x = friction(1 - x') + amplitude cos(nu t), with cubic friction (M. di Bernardo, P. Kowalczyk and A. B.
/// Nordmark, Int. J. Bifurcation Chaos 13, 2003).
inline Model belt() {
    return model_from(
        R"toml(
name = "belt"
[parameters]
alpha0 = 1.5
alpha1 = 1.5
alpha2 = 0.45
amplitude = 0.1
nu = 1.7
[states]
x = 1
v = 0.9
theta = { initial = 0, period = "2*pi" }
[definitions]
slip = "1 - v"
force = "amplitude*cos(theta) - x"
smooth = "force - alpha1*slip + alpha2*slip^3"
[initial]
mode = "below"
[modes.below]
watch = ["reach"]
rates = { x = "v", v = "smooth + alpha0", theta = "nu" }
[modes.above]
watch = ["fall"]
rates = { x = "v", v = "smooth - alpha0", theta = "nu" }
[modes.stick]
watch = ["slow", "fast"]
rates = { x = 1, v = 0, theta = "nu" }
[events]
reach = "1 - v"
fall = "v - 1"
slow = "alpha0 + force"
fast = "alpha0 - force"
[jumps.stop]
v = 1
[sections.phase0]
state = "theta"
value = 0
)toml" +
        transition("below", "reach", "[{ when = 'alpha0 - force >= 0', mode = 'stick' }, { mode = 'above' }]", "stop") +
        transition("above", "fall", "[{ when = 'alpha0 + force >= 0', mode = 'stick' }, { mode = 'below' }]", "stop") +
        transition("stick", "slow", "below") + transition("stick", "fast", "above"));
}

} // namespace graze::testing
