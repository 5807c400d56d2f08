#pragma once

#include "graze/model/model_file.hpp"

namespace graze::testing {

/// A damped oscillator that is released and hits a wall: three impacts, quick to compute.
inline Model wall_model() {
    return parse_model(R"(
name = "wall"
[parameters]
c = 0.1
k = 4
wall = 0.5
e = 0.7
[states]
x = { initial = "-4*wall" }
v = { initial = 0 }
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

} // namespace graze::testing
