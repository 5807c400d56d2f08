// Errors of the shipped models against the requested tolerance: of states and derivatives after motions with contacts,
// and of multipliers and parameters of located points on branches. The reference is the same computation at the
// smallest tolerance, so that the errors show whether steps, contacts and corrections respect the tolerance; tests
// verify the reference itself.

#include "microactuator.hpp"

#include "graze/branch/switching.hpp"
#include "graze/model/microbeam.hpp"
#include "graze/trajectory/trajectory.hpp"

#include <benchmark/benchmark.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <stdexcept>
#include <string>
#include <vector>

namespace {

using namespace graze;

constexpr double least_tolerance = 1e-15;

/// A motion of a shipped model that includes contacts.
struct Motion {
    const char* model;
    double time;
};
constexpr Motion motions[] = {
    {"ball-and-shaker", 0.5},           {"bouncing-ball", 0.63},      {"dry-friction-oscillator", 20},
    {"electromagnetic-testbed", 0.45},  {"impact-microactuator", 21}, {"impact-oscillator", 12.3},
    {"impact-oscillator-two-stops", 9}, {"mems-switch", 13},          {"microbeam", 0.4}};

/// The end of a motion, with derivatives with respect to all states and parameters, states x inputs.
struct End {
    std::vector<double> state, derivatives;
    std::vector<double> periods; ///< periods of cyclic states, 0 for others
};

End end_of(const Motion& motion, double tolerance) {
    const Model model = load_model(motion.model);
    const Simulation simulation(System(model), {}, {}, {.tolerance = tolerance});
    Trajectory trajectory(simulation, model.parameter_values());
    trajectory.start(model.initial_state(), model.initial_mode, 0, motion.time);
    const std::size_t inputs = model.states.size() + model.parameter_values().size();
    std::vector<double> seeds(inputs * inputs, 0.0);
    for (std::size_t d = 0; d < inputs; ++d)
        seeds[d * inputs + d] = 1;
    trajectory.carry_tangents(seeds, inputs);
    JetSet jets(simulation, LaneKind::single);
    run(trajectory, jets);
    if (trajectory.outcome().ending != Ending::end_time || !trajectory.tangents_valid())
        throw std::logic_error(std::string(motion.model) + " does not reach the end with derivatives");
    return {{trajectory.state().begin(), trajectory.state().end()},
            {trajectory.tangents().begin(), trajectory.tangents().end()},
            model.periods()};
}

/// Computes relative errors: of states against their sizes, of derivatives against the size of their direction in
/// scaled states.
void compare(const End& end, const End& reference, double& of_states, double& of_derivatives) {
    const std::size_t n = reference.state.size(), inputs = reference.derivatives.size() / n;
    std::vector<double> units;
    of_states = of_derivatives = 0;
    for (std::size_t i = 0; i < n; ++i) {
        units.push_back(std::abs(reference.state[i]) + 1e-3);
        const double apart = end.state[i] - reference.state[i], period = reference.periods[i];
        of_states = std::max(of_states, std::abs(period > 0 ? std::remainder(apart, period) : apart) / units[i]);
    }
    for (std::size_t d = 0; d < inputs; ++d) {
        double size = 0, error = 0;
        for (std::size_t i = 0; i < n; ++i) {
            size = std::max(size, std::abs(reference.derivatives[i * inputs + d]) / units[i]);
            error = std::max(error, std::abs(end.derivatives[i * inputs + d] - reference.derivatives[i * inputs + d]) /
                                        units[i]);
        }
        of_derivatives = std::max(of_derivatives, size > 0 ? error / size : error);
    }
}

void accuracy_of_motion(benchmark::State& state, const Motion& motion, double tolerance) {
    const End reference = end_of(motion, least_tolerance);
    End end;
    for (auto unused : state)
        end = end_of(motion, tolerance);
    double of_states = 0, of_derivatives = 0;
    compare(end, reference, of_states, of_derivatives);
    state.counters["of_states"] = of_states;
    state.counters["of_derivatives"] = of_derivatives;
}

/// The largest multiplier of an attracting orbit, and a special point on its branch.
struct Located {
    double multiplier = 0, parameter = 0;
};

Located on_microactuator(double tolerance) {
    BranchSettings settings = microactuator_settings(0.1);
    settings.orbit.tolerance = tolerance;
    settings.stop_at = {PointType::fold};
    const Branch branch = follow_branch(System(microactuator(microactuator_start)), microactuator_orbit(), settings);
    return {std::abs(branch.points.front().solution.multipliers.at(0)), branch.special.back().parameter};
}

Located on_microbeam(double tolerance) {
    const Model model = microbeam({.modes = 1, .voltage = 0.034});
    AttractorOptions settle;
    settle.section = "phase0";
    settle.cycles = 2000;
    BranchSettings settings;
    settings.parameter = model.independent_parameter("V");
    settings.direction = -1;
    settings.least = 0.005;
    settings.greatest = 0.06;
    settings.orbit.tolerance = tolerance;
    settings.stop_at = {PointType::fold};
    OrbitOptions options;
    options.tolerance = tolerance;
    const Branch branch = follow_branch(System(model), find_orbit(System(model), settle, options).orbit, settings);
    return {std::abs(branch.points.front().solution.multipliers.at(0)), branch.special.back().parameter};
}

void accuracy_of_branch(benchmark::State& state, Located (*find)(double), double tolerance) {
    const Located reference = find(least_tolerance);
    Located found;
    for (auto unused : state)
        found = find(tolerance);
    state.counters["of_multiplier"] = std::abs(found.multiplier / reference.multiplier - 1);
    state.counters["of_fold"] = std::abs(found.parameter / reference.parameter - 1);
}

const int registered = [] {
    struct Tolerance {
        const char* name;
        double value;
    };
    for (const Tolerance tolerance : {Tolerance{"1e-6", 1e-6}, Tolerance{"1e-9", 1e-9}, Tolerance{"1e-12", 1e-12}}) {
        const auto name = [&](const std::string& of) { return "accuracy/" + of + "/" + tolerance.name; };
        for (const Motion& motion : motions)
            benchmark::RegisterBenchmark(name(motion.model).c_str(), accuracy_of_motion, motion, tolerance.value)
                ->Iterations(1)
                ->Unit(benchmark::kMillisecond);
        benchmark::RegisterBenchmark(name("branch-of-impact-microactuator").c_str(), accuracy_of_branch,
                                     on_microactuator, tolerance.value)
            ->Iterations(1)
            ->Unit(benchmark::kMillisecond);
        benchmark::RegisterBenchmark(name("branch-of-microbeam").c_str(), accuracy_of_branch, on_microbeam,
                                     tolerance.value)
            ->Iterations(1)
            ->Unit(benchmark::kMillisecond);
    }
    return 0;
}();

} // namespace
