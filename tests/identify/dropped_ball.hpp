#pragma once

#include "graze/model/model_file.hpp"

#include <string>

namespace graze::testing {

/// A dropped ball, which comes to rest after infinitely many bounces.
inline Model dropped_ball(const std::string& chatter = "chatter = { jump = \"stop\", mode = \"rest\" }") {
    return parse_model(R"(
name = "drop"
[parameters]
g = 9.81
e = 0.6
[states]
x = { initial = 1 }
v = { initial = 0 }
[initial]
mode = "fall"
[modes.fall]
rates = { x = "v", v = "-g" }
watch = ["floor"]
[modes.rest]
rates = { x = 0, v = 0 }
[events.floor]
function = "x"
[jumps.bounce]
v = "-e*v"
[jumps.stop]
v = 0
x = 0
[[transitions]]
mode = "fall"
event = "floor"
jump = "bounce"
next = "fall"
)" + chatter,
                       "drop.toml");
}

} // namespace graze::testing
