// A slowly forced oscillator whose motion against a stop goes through a ladder of grazings to chatter.

#pragma once

#include "follow.hpp"

#include "graze/branch/ladder.hpp"

#include <gtest/gtest.h>

namespace graze::testing {

inline constexpr double zeta = 0.5, omega = 0.3;

/// An oscillator with a stop at s, in units of length and time.
inline Model chattering_oscillator(double restitution, double length, double time) {
    return driven(fmt::format("s = {:.17g}\nforce = 1", 1.5 * length),
                  fmt::format("({:.17g}*force*cos(theta) - x)/{:.17g} - 2*{:.17g}*v", length, time * time, zeta / time),
                  fmt::format("{:.17g}", omega / time),
                  {{"stop", "s - x", fmt::format("v = '-{:.17g}*v'", restitution)}});
}

/// Returns the first grazing of the attractor.
inline SpecialPoint first_grazing(const Model& model, BranchSettings settings) {
    settings.stop_at = {PointType::grazing};
    const Branch branch = follow_branch(System(model), settled(model, model.sections.front().name).orbit, settings);
    EXPECT_EQ(branch.outcome, BranchOutcome::stopped) << names(branch);
    return branch.special.back();
}

inline BranchSettings of_oscillator(const Model& model, double length) {
    return in_parameter(model, "s", 0.1 * length, 3 * length, -1);
}

} // namespace graze::testing
