// From a model file to the first Taylor coefficients, for each shipped model, and for long chains of oscillators.

#include "../tests/model/chain.hpp"
#include "paired_timing.hpp"

#include "graze/model/catalogue.hpp"
#include "graze/model/model_file.hpp"
#include "graze/trajectory/trajectory.hpp"

#include <benchmark/benchmark.h>

#include <string>

namespace {

using namespace graze;

constexpr double allowed_milliseconds = 10, allowed_for_chains = 30;

void first_jet(const Model& model) {
    const Simulation simulation{System(model)};
    JetSet jets(simulation, LaneKind::single);
    jets.set_parameters(model.parameter_values());
    Jet& jet = jets(model.initial_mode);
    jet.compute(model.initial_state());
    benchmark::DoNotOptimize(jet.state(0)[1]);
}

void start_up(benchmark::State& state, const std::string& name) {
    double least = std::numeric_limits<double>::infinity();
    for (auto unused : state) {
        const double time = seconds([&] { first_jet(load_model(name)); });
        state.SetIterationTime(time);
        least = std::min(least, time);
    }
    state.counters["ratio"] = allowed_milliseconds / (1e3 * least);
}

void start_up_of_chain(benchmark::State& state) {
    const std::string text = write_model(testing::chain(static_cast<std::size_t>(state.range(0))));
    double least = std::numeric_limits<double>::infinity();
    for (auto unused : state) {
        const double time = seconds([&] { first_jet(parse_model(text, "chain.toml")); });
        state.SetIterationTime(time);
        least = std::min(least, time);
    }
    state.counters["ratio"] = allowed_for_chains / (1e3 * least);
}
BENCHMARK(start_up_of_chain)
    ->Name("start_up/30_ms/chain")
    ->Arg(20)
    ->Arg(200)
    ->Arg(1000)
    ->UseManualTime()
    ->Unit(benchmark::kMillisecond);

const int registered = [] {
    for (const CatalogueEntry& entry : catalogue())
        benchmark::RegisterBenchmark(("start_up/10_ms/" + entry.name).c_str(), start_up, entry.name)
            ->UseManualTime()
            ->Unit(benchmark::kMillisecond);
    return 0;
}();

} // namespace
