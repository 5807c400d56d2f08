#pragma once

#include "graze/model/model_file.hpp"

namespace graze::testing {

/// A ball between two walls at 0 and 1, with a contact every half unit of time forever.
inline Model ball_between_walls(double x) {
    Model model = parse_model(R"(
states = { x = 0, v = 2 }
modes.flight = { rates = { x = "v", v = "0" }, watch = ["left", "right"] }
events = { left = "x", right = "1 - x" }
jumps.turn.v = "-v"
transitions = [
  { mode = "flight", event = "left", jump = "turn", next = "flight" },
  { mode = "flight", event = "right", jump = "turn", next = "flight" },
]
)",
                              "ball.toml");
    model.set_initial("x", x);
    return model;
}

} // namespace graze::testing
