// Maps at a touch: the discontinuity map, the map of the whole cycle, and the latter with the next order. The compiled
// model is given; all else is measured, including symbolic derivatives.

#include "graze/grazing/verdict.hpp"
#include "graze/model/catalogue.hpp"
#include "graze/orbit/solve.hpp"

#include <benchmark/benchmark.h>

#include <cmath>
#include <stdexcept>

namespace {

using namespace graze;

/// The ball at rest in front of the shaker, which just touches it.
struct Resting {
    Model model = load_model("ball-and-shaker");
    Orbit orbit;
    CycleMapOptions options;

    Resting() {
        model.set_parameter("a", 0.65);
        model.set_parameter("b", 0.65);
        model.set_parameter("f", 6);
        orbit.signature = parse_signature(model, "free:phase0");
        orbit.parameters = model.parameter_values();
        orbit.starts = {{0, 0, 0}};
        orbit.durations = {1.0 / 6};
        options.parameter = model.independent_parameter("a");
    }
};

void ContactMap(benchmark::State& state) {
    const Resting resting;
    const System system(resting.model);
    const CycleMap map = cycle_map(system, resting.orbit, touches_of(system, resting.orbit).front(), resting.options);
    for (auto _ : state)
        benchmark::DoNotOptimize(discontinuity_map(system, map.contact.touch).acceleration);
}
BENCHMARK(ContactMap)->Unit(benchmark::kMicrosecond);

/// @param state its argument selects the next order
void MapOfCycle(benchmark::State& state) {
    Resting resting;
    resting.options.next_order = state.range(0) == 1;
    const System system(resting.model);
    const OrbitTouch touch = touches_of(system, resting.orbit).front();
    for (auto _ : state) {
        const CycleMap map = cycle_map(system, resting.orbit, touch, resting.options);
        if (verdict_of(map).outcome != GrazingOutcome::lost)
            throw std::logic_error("the verdict is another one");
    }
}
BENCHMARK(MapOfCycle)->Arg(0)->Arg(1)->Unit(benchmark::kMicrosecond);

} // namespace
