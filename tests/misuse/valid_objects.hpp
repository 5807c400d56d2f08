#pragma once

#include "graze/branch/switching.hpp"
#include "graze/model/catalogue.hpp"
#include "graze/model/model_file.hpp"
#include "graze/trajectory/trajectory.hpp"

namespace graze::testing {

/// A model with three states, five parameters, two modes, events, transitions and sections, and three jumps.
inline Model oscillator() {
    return load_model("impact-oscillator");
}
/// The same model with two stops and a symmetry.
inline Model symmetric_oscillator() {
    return load_model("impact-oscillator-two-stops");
}
/// The oscillator with parameters at which it moves periodically without impacts.
inline Model calm_oscillator() {
    Model model = oscillator();
    model.set_parameter("sigma", 0.5);
    model.set_parameter("omega", 1.2);
    model.set_parameter("amplitude", 0.1);
    return model;
}
inline AttractorOptions by_phase() {
    AttractorOptions options;
    options.section = "phase0";
    return options;
}
inline const OrbitSolution& calm_solution() {
    static const OrbitSolution solution = find_orbit(System(calm_oscillator()), by_phase());
    return solution;
}
inline Orbit calm_orbit() {
    return calm_solution().orbit;
}
inline BranchSettings by_amplitude() {
    BranchSettings settings;
    settings.parameter = oscillator().independent_parameter("amplitude");
    settings.greatest = 1;
    settings.steps = 30;
    return settings;
}
/// The point at which the oscillator grazes the stop.
inline SpecialPoint grazing_point() {
    static const SpecialPoint point =
        follow_branch(System(calm_oscillator()), calm_orbit(), by_amplitude()).special.back();
    return point;
}

/// A trajectory with all objects that it needs, not yet started.
struct Motion {
    Model model = oscillator();
    Simulation simulation{System(model)};
    Trajectory trajectory{simulation, model.parameter_values()};
    JetSet jets{simulation, LaneKind::single};

    Trajectory& begun(double end_time = 1) {
        trajectory.start(model.initial_state(), model.initial_mode, 0, end_time);
        return trajectory;
    }
    Trajectory& finished() {
        run(begun(), jets);
        return trajectory;
    }
};

} // namespace graze::testing
