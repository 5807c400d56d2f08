#pragma once

#include "graze/model/model_file.hpp"

#include <cmath>
#include <string>

namespace graze::testing {

/// A magnet: Appendix C of B. E. Wilcox's dissertation.
namespace magnet {

inline constexpr double beta1 = 1.902e-5, beta2 = 1.631e-3, gap = 0.00479102312304, stiffness = 0.6462 * 95.94 * 95.94;

/// The current at which a displacement is an equilibrium, Eq. (5.13).
inline double current_at(double q) {
    return (gap + beta2 - q) * std::sqrt(2 * stiffness * q / beta1);
}

} // namespace magnet

/// A model with one mode. @param parameters, states, rates as TOML
inline Model smooth_model(const std::string& parameters, const std::string& states, const std::string& rates) {
    return parse_model("name = \"smooth\"\nparameters = " + parameters + "\nstates = " + states +
                           "\nmodes.m.rates = " + rates + "\n",
                       "smooth.toml");
}

/// A damped oscillator that is released and hits a wall: three impacts, quick to compute.
inline Model wall_model() {
    return parse_model(R"(
name = "wall"
parameters = { c = 0.1, k = 4, wall = 0.5, e = 0.7 }
states = { x = "-4*wall", v = 0 }
[modes.swing]
rates = { x = "v", v = "-k*x - c*v" }
watch = ["hit"]
[events.hit]
function = "wall - x"
[jumps.bounce]
v = "-e*v"
[[transitions]]
mode = "swing"
event = "hit"
jump = "bounce"
next = "swing"
)",
                       "wall.toml");
}

/// A dropped ball, which comes to rest after infinitely many bounces.
inline Model dropped_ball(const std::string& chatter = "chatter = { jump = \"stop\", mode = \"rest\" }") {
    return parse_model(R"(
name = "drop"
parameters = { g = 9.81, e = 0.6 }
states = { x = 1, v = 0 }
initial.mode = "fall"
modes.fall = { rates = { x = "v", v = "-g" }, watch = ["floor"] }
modes.rest = { rates = { x = 0, v = 0 } }
events.floor.function = "x"
jumps.bounce.v = "-e*v"
jumps.stop = { v = 0, x = 0 }
[[transitions]]
mode = "fall"
event = "floor"
jump = "bounce"
next = "fall"
)" + chatter,
                       "drop.toml");
}

} // namespace graze::testing
