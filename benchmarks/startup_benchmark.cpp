// From a model file to the first Taylor coefficients, for each shipped model.

#include "duel.hpp"

#include "graze/model/catalogue.hpp"
#include "graze/trajectory/trajectory.hpp"

#include <benchmark/benchmark.h>

#include <string>

namespace {

using namespace graze;

constexpr double allowed_milliseconds = 10;

void first_jet(const std::string& name) {
    const Model model = load_model(name);
    const Simulation simulation(model);
    JetSet jets(simulation, LaneKind::single);
    jets.set_parameters(model.parameter_values());
    Jet& jet = jets(model.initial_mode);
    jet.compute(model.initial_state());
    benchmark::DoNotOptimize(jet.state(0)[1]);
}

void start_up(benchmark::State& state, const std::string& name) {
    double least = std::numeric_limits<double>::infinity();
    for (auto unused : state) {
        const double time = seconds([&] { first_jet(name); });
        state.SetIterationTime(time);
        least = std::min(least, time);
    }
    state.counters["ratio"] = allowed_milliseconds / (1e3 * least);
}

const int registered = [] {
    for (const CatalogueEntry& entry : catalogue())
        benchmark::RegisterBenchmark(("start_up/10_ms/" + entry.name).c_str(), start_up, entry.name)
            ->UseManualTime()
            ->Unit(benchmark::kMillisecond);
    return 0;
}();

} // namespace
