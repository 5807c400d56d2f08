// A slowly forced oscillator whose motion against a stop goes through a ladder of grazings to chatter.

#pragma once

#include "follow.hpp"

#include "graze/branch/ladder.hpp"

#include <gtest/gtest.h>

namespace graze::testing {

inline constexpr double zeta = 0.5, omega = 0.3;

/// An oscillator with a stop at s, in units of length and time.
inline Model chattering_oscillator(double restitution, double length, double time) {
    return model_from(fmt::format(R"toml(
[parameters]
s = {:.17g}
force = 1
[states]
x = 0
v = 0
theta = {{ initial = 0, period = "2*pi" }}
[modes.free]
rates = {{ x = "v", v = "({:.17g}*force*cos(theta) - x)/{:.17g} - 2*{:.17g}*v", theta = "{:.17g}" }}
watch = ["stop"]
[events.stop]
function = "s - x"
[jumps.bounce]
v = "-{:.17g}*v"
[[transitions]]
mode = "free"
event = "stop"
jump = "bounce"
next = "free"
[sections.start]
state = "theta"
value = 0
)toml",
                                  1.5 * length, length, time * time, zeta / time, omega / time, restitution));
}

/// Returns the first grazing of the attractor.
inline SpecialPoint first_grazing(const Model& model, BranchSettings settings) {
    settings.stop_at = {PointType::grazing};
    const Branch branch = follow_branch(System(model), settled(model, model.sections.front().name).orbit, settings);
    EXPECT_EQ(branch.outcome, BranchOutcome::stopped) << names(branch);
    return branch.special.back();
}

inline BranchSettings of_oscillator(const Model& model, double length) {
    BranchSettings settings;
    settings.parameter = model.independent_parameter("s");
    settings.direction = -1;
    settings.least = 0.1 * length;
    settings.greatest = 3 * length;
    return settings;
}

} // namespace graze::testing
