#pragma once

#include "graze/branch/orbit_branch.hpp"
#include "graze/model/catalogue.hpp"

// The impact microactuator's orbit {J1, J8} at the frequency of most of its published branches.

inline graze::Model microactuator(double voltage) {
    graze::Model model = graze::load_model("impact-microactuator");
    model.set_parameter("omega", 0.9189);
    model.set_parameter("V", voltage);
    return model;
}

/// Start of a branch of 200 points upwards, and its largest step.
inline constexpr double microactuator_start = 0.82, microactuator_step = 0.008;

inline graze::BranchSettings microactuator_settings(double largest_step = microactuator_step) {
    graze::BranchSettings result;
    result.greatest = 1.5;
    result.steps = 200;
    result.continuation.largest_step = largest_step;
    return result;
}

/// The stable orbit {J1, J8} at V = 0.865, followed down to 0.82.
inline const graze::Orbit& microactuator_orbit() {
    static const graze::Orbit orbit = [] {
        graze::AttractorOptions settle;
        settle.section = "phase0";
        settle.cycles = 4000;
        const graze::Orbit stable = find_orbit(graze::System(microactuator(0.865)), settle).orbit;
        graze::BranchSettings down = microactuator_settings(0.1);
        down.direction = -1;
        down.least = microactuator_start;
        const graze::Branch branch = follow_branch(graze::System(microactuator(0.865)), stable, down);
        return branch.special.back().solution.orbit;
    }();
    return orbit;
}

/// Returns an orbit repeated several times.
inline graze::Orbit repeated(const graze::Orbit& one, std::size_t times) {
    graze::Orbit orbit = one;
    for (std::size_t i = 1; i < times; ++i) {
        orbit.signature.insert(orbit.signature.end(), one.signature.begin(), one.signature.end());
        orbit.starts.insert(orbit.starts.end(), one.starts.begin(), one.starts.end());
        orbit.durations.insert(orbit.durations.end(), one.durations.begin(), one.durations.end());
    }
    return orbit;
}
