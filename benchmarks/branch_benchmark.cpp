// Branches of periodic orbits. The orbit {J1, J8} of the microactuator is followed in V from 0.82 for 200 points, with
// multipliers, all test functions and certificates; the peer only integrates, with Boost.odeint, what the Newton steps
// of that branch need when derivatives are taken by differences. Then orbits with increasing numbers of segments.

#include "microactuator.hpp"
#include "paired_timing.hpp"

#include <benchmark/benchmark.h>
#include <boost/numeric/odeint/integrate/integrate_adaptive.hpp>
#include <boost/numeric/odeint/stepper/generation.hpp>
#include <boost/numeric/odeint/stepper/runge_kutta_dopri5.hpp>

#include <array>
#include <cmath>
#include <stdexcept>

namespace {

using namespace graze;

/// The smooth motions of the two segments, written by hand.
class OdeintFlows {
public:
    using State = std::array<double, 5>;

    void flow(bool stick, State state, double voltage, double time) {
        namespace odeint = boost::numeric::odeint;
        const auto rates = [stick, voltage](const State& x, State& rate, double) {
            const double sine = std::sin(x[4]), gap = 1 - x[2];
            const double force = voltage * voltage * sine * sine / (gap * gap) - 0.04 * x[3] - x[2];
            const double frame = stick ? 0 : -(force + 0.27 * 58.86) / 5;
            rate = {stick ? 0 : x[1], frame, x[3], force - frame, 0.9189};
        };
        odeint::integrate_adaptive(odeint::make_controlled(1e-12, 1e-12, odeint::runge_kutta_dopri5<State>()), rates,
                                   state, 0.0, time, 0.1 * time);
        sum += state[0];
    }

    /// Performs the integrations of one evaluation of the equations and their derivatives by differences.
    void evaluate(const Orbit& orbit) {
        const double voltage = orbit.parameters[0];
        for (std::size_t s = 0; s < orbit.segments(); ++s) {
            State start;
            std::copy(orbit.starts[s].begin(), orbit.starts[s].end(), start.begin());
            const bool stick = orbit.signature[s].mode == 0;
            flow(stick, start, voltage, orbit.durations[s]);
            for (std::size_t i = 0; i < start.size(); ++i) {
                State moved = start;
                moved[i] += 1e-7;
                flow(stick, moved, voltage, orbit.durations[s]);
            }
            flow(stick, start, voltage + 1e-7, orbit.durations[s]);
        }
    }

    double sum = 0;
};

void BranchOfTheMicroactuator(benchmark::State& state) {
    const Model model = microactuator(microactuator_start);
    const Orbit& orbit = microactuator_orbit();
    const Branch known = follow_branch(System(model), orbit, microactuator_settings());
    if (known.points.size() != 201 || model.parameter_symbols()[0].name() != "V" || model.modes[0].name != "stick")
        throw OrderError("the branch is not what is to be measured");
    PairedTiming timing;
    OdeintFlows peer;
    for (auto _ : state)
        state.SetIterationTime(timing.round(
            [&] {
                benchmark::DoNotOptimize(follow_branch(System(model), orbit, microactuator_settings()).points.size());
            },
            [&] {
                for (const BranchPoint& point : known.points) // the tangent takes one more evaluation
                    for (std::size_t i = 0; i <= point.iterations; ++i)
                        peer.evaluate(point.solution.orbit);
                benchmark::DoNotOptimize(peer.sum);
            }));
    state.counters["seconds"] = timing.own();
    state.counters["odeint_flows_ratio"] = timing.peer() / timing.own();
    state.counters["special"] = static_cast<double>(known.special.size());
}
BENCHMARK(BranchOfTheMicroactuator)->UseManualTime()->Unit(benchmark::kMillisecond)->MinTime(1);

void OrbitOfManySegments(benchmark::State& state) {
    const Model model = microactuator(microactuator_start);
    const std::size_t segments = static_cast<std::size_t>(state.range(0));
    const Orbit orbit = repeated(microactuator_orbit(), segments / 2), two = microactuator_orbit();
    BranchSettings few = microactuator_settings();
    few.steps = 5;
    PairedTiming timing;
    for (auto _ : state)
        state.SetIterationTime(
            timing.round([&] { benchmark::DoNotOptimize(follow_branch(System(model), orbit, few).points.size()); },
                         [&] { benchmark::DoNotOptimize(follow_branch(System(model), two, few).points.size()); }));
    state.counters["time_for_each_segment_against_two"] =
        timing.own() / timing.peer() * 2 / static_cast<double>(segments);
    state.SetComplexityN(state.range(0));
}
BENCHMARK(OrbitOfManySegments)
    ->RangeMultiplier(10)
    ->Arg(2)
    ->Arg(8)
    ->Arg(20)
    ->Arg(60)
    ->Arg(200)
    ->UseManualTime()
    ->Unit(benchmark::kMillisecond)
    ->Complexity();

} // namespace
