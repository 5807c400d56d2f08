// The flow of one mode with second derivatives contracted with a vector, against first derivatives alone; and the time
// to compile it.

#include "paired_timing.hpp"

#include "graze/flow/second_order_flow.hpp"
#include "graze/model/catalogue.hpp"
#include "graze/model/microbeam.hpp"

#include <benchmark/benchmark.h>

#include <string>
#include <vector>

namespace {

using namespace graze;

constexpr double tolerance = 1e-12;
constexpr int runs = 20; ///< number of runs per measurement

Model model_of(const std::string& name) {
    return name == "microbeam-3" ? microbeam({.modes = 3}) : load_model(name);
}

/// Returns the first `count` parameters.
std::vector<ParameterId> free_of(std::size_t count) {
    std::vector<ParameterId> free;
    for (std::size_t f = 0; f < count; ++f)
        free.push_back(ParameterId(f));
    return free;
}

/// Runs over 2 / omega from the initial state, in the initial mode.
struct Arc {
    System system;
    double duration;
    std::vector<double> state, derivatives, second, vector;

    Arc(const Model& model, std::size_t free)
        : system(model), duration(2 / model.values_of(std::vector{model.symbol("omega")}).front()),
          vector(system.states() + free, 0.3) {
        derivatives.resize(system.states() * vector.size());
        second = derivatives;
    }
    void first_order(ModeFlow& flow) {
        for (int run = 0; run < runs; ++run) {
            state = system.model().initial_state();
            benchmark::DoNotOptimize(flow.run(system.model().initial_mode, state, duration, derivatives));
        }
    }
    void second_order(SecondOrderFlow& flow) {
        for (int run = 0; run < runs; ++run) {
            state = system.model().initial_state();
            benchmark::DoNotOptimize(
                flow.run(system.model().initial_mode, state, duration, vector, derivatives, second));
        }
    }
};

void second_derivatives(benchmark::State& state, const std::string& name, std::size_t free) {
    Arc arc(model_of(name), free);
    const std::vector<double> parameters = arc.system.model().parameter_values();
    ModeFlow first(arc.system, tolerance, 0, free_of(free));
    SecondOrderFlow second(VariationalSystem(arc.system, free_of(free)), tolerance);
    first.set_parameters(parameters);
    second.set_parameters(parameters);
    PairedTiming timing;
    for (auto unused : state)
        state.SetIterationTime(timing.round([&] { arc.second_order(second); }, [&] { arc.first_order(first); }));
    state.counters["cost"] = timing.own() / timing.peer();
    const std::size_t first_before = first.steps(), second_before = second.steps();
    arc.first_order(first);
    arc.second_order(second);
    state.counters["steps"] = static_cast<double>(second.steps() - second_before) / runs;
    state.counters["first_order_steps"] = static_cast<double>(first.steps() - first_before) / runs;
}

void compiling(benchmark::State& state, const std::string& name) {
    const System system(model_of(name));
    for (auto unused : state)
        benchmark::DoNotOptimize(VariationalSystem(system, free_of(2)).variables());
}

const int registered = [] {
    for (const std::string name :
         {"impact-oscillator", "electromagnetic-testbed", "mems-switch", "microbeam", "microbeam-3"}) {
        for (const std::size_t free : {1, 2})
            benchmark::RegisterBenchmark(("second_derivatives/" + name + "/" + std::to_string(free)).c_str(),
                                         second_derivatives, name, free)
                ->UseManualTime()
                ->Unit(benchmark::kMicrosecond);
        benchmark::RegisterBenchmark(("compiling/" + name).c_str(), compiling, name)->Unit(benchmark::kMillisecond);
    }
    return 0;
}();

} // namespace
