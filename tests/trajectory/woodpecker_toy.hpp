#pragma once

#include <string>

namespace graze::testing {

/// The woodpecker toy, with the parameters of Leine, Glocker and van Campen (2001): a sleeve with play on a rod, and a
/// woodpecker on a spring, whose beak hits the rod.
inline const std::string woodpecker_toy = R"toml(
parameters = { g = 9.81, mM = 0.0003, JM = 5e-9, mS = 0.0045, JS = 7e-7, c = 0.0056, play = 0.0006, rM = 0.0031, hM = 0.0058, lM = 0.01, lG = 0.015, hS = 0.02, lS = 0.0201, reach = 0.0024, mu = 0.3, e = 0.5 }
states = { y = { initial = 0, drifting = true }, phiM = "-play/hM", phiS = -0.2788, v = -0.3395, wM = 0, wS = -7.462 }
definitions.spring = "c*(phiM - phiS)"
initial.mode = "free"
[modes.free]
rates = { y = "v", phiM = "wM", phiS = "wS" }
forces = { v = "-(mS + mM)*g", wM = "-spring - mS*g*lM", wS = "spring - mS*g*lG" }
[contacts]
velocities = ["v", "wM", "wS"]
mass = [["mS + mM", "mS*lM", "mS*lG"], ["mS*lM", "JM + mS*lM^2", "mS*lM*lG"], ["mS*lG", "mS*lM*lG", "JS + mS*lG^2"]]
beak = { gap = "reach - hS*phiS", restitution = "e", friction = "mu", slip = "v + lM*wM + (lG - lS)*wS" }
lower = { gap = "play + hM*phiM", restitution = 0, friction = "mu", slip = "v + rM*wM" }
upper = { gap = "play - hM*phiM", restitution = 0, friction = "mu", slip = "v + rM*wM" }
[sections.leaning]
function = "phiS + 0.2788"
direction = "falling"
)toml";

} // namespace graze::testing
