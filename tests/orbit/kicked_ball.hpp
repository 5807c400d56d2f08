// A ball on a fixed table that is sent up once per period, while it rests.

#pragma once

#include "graze/model/model_file.hpp"

#include <fmt/format.h>

#include <string>

namespace graze::testing {

struct KickedBall {
    double e = 0.5; ///< coefficient of restitution
    double V = 2;   ///< speed after a kick

    static constexpr double g = 10;
    /// Time from a kick to the accumulation of contacts; at most the period, 1.
    double chatter() const { return 2 * V / (g * (1 - e)); }
    Model model() const {
        return parse_model(fmt::format(R"toml(
name = "kicked-ball"
[parameters]
g = 10
e = {}
V = {}
[states]
x = 0
v = "V"
clock = 0
[modes.flight]
rates = {{ x = "v", v = "-g", clock = 1 }}
watch = ["contact"]
[modes.rest]
rates = {{ x = 0, v = 0, clock = 1 }}
watch = ["kick"]
[events]
contact = "x"
kick = "1 - clock"
[jumps.impact]
v = "-e*v"
[jumps.land]
x = 0
v = 0
[jumps.hit]
v = "V"
clock = 0
[[transitions]]
mode = "flight"
event = "contact"
label = "impact"
jump = "impact"
next = "flight"
chatter = {{ jump = "land", mode = "rest" }}
[[transitions]]
mode = "rest"
event = "kick"
label = "kick"
jump = "hit"
next = "flight"
[initial]
mode = "flight"
)toml",
                                       e, V),
                           "kicked-ball.toml");
    }
};

} // namespace graze::testing
