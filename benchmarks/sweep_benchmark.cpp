// The bifurcation diagram of the electromagnetic vibro-impactor at 6.25 Hz, 2002 points in steps of 1 mV: effects of
// labels, exponents, threads, lanes and the result file on its time. Tolerance 1e-12.

#include "paired_timing.hpp"

#include "graze/model/catalogue.hpp"
#include "graze/results/result_file.hpp"
#include "graze/study/runner.hpp"
#include "graze/study/study_catalogue.hpp"
#include "graze/sweep/plan.hpp"

#include <benchmark/benchmark.h>

#include <unistd.h>

#include <filesystem>
#include <string>

namespace {

using namespace graze;

/// Returns the run of the shipped study, with every n-th voltage.
StudyRun sweep_run(std::size_t lyapunov_cycles, std::size_t every) {
    StudyRun run = load_study("electromagnetic-testbed").runs.front();
    run.attractor().lyapunov_cycles = lyapunov_cycles;
    std::vector<double> values;
    for (std::size_t i = 0; i < run.motion().axes[0].values.size(); i += every)
        values.push_back(run.motion().axes[0].values[i]);
    run.motion().axes[0].values = values;
    return run;
}

/// Returns the same sweep at several frequencies: independent chains.
StudyRun chains_run(std::size_t chains) {
    StudyRun run = sweep_run(60, 20);
    Variation frequencies;
    frequencies.name = "f";
    frequencies.parameter = run.model.independent_parameter("f");
    for (std::size_t i = 0; i < chains; ++i)
        frequencies.values.push_back(6.2 + 0.1 * static_cast<double>(i) / static_cast<double>(chains));
    run.motion().axes.push_back(frequencies);
    return run;
}

std::unique_ptr<SearchFactory> searches_of(const StudyRun& run) {
    return attractor_searches(System(run.model), run.attractor(), run.motion().samplings, run.values,
                              run.motion().simulation);
}

struct Totals {
    std::size_t cycles = 0, returns = 0, samples = 0;
};

Totals run_all(const Plan& plan, const SearchFactory& searches, int jobs) {
    Totals totals;
    ExecutionOptions options;
    options.jobs = jobs;
    execute(plan, searches, {}, options, [&](std::size_t, const PointStart&, PointResult& result) {
        totals.cycles += result.cycles;
        totals.returns += result.periods_run;
        totals.samples += result.samples.size();
    });
    return totals;
}

/// The whole diagram, against a plain simulation of as many periods as the motions need to settle.
void diagram(benchmark::State& state, std::size_t lyapunov_cycles) {
    const StudyRun run = sweep_run(lyapunov_cycles, 1);
    const Plan plan = plan_of(run, System(run.model), nullptr);
    const auto searches = searches_of(run);
    Model model = run.model;
    model.set_parameter("V0", 4.95);
    const Simulation simulation{System(model)};
    Totals totals;
    PairedTiming timing(Clock::processor);
    for (auto unused : state)
        state.SetIterationTime(timing.round([&] { totals = run_all(plan, *searches, 1); },
                                            [&] {
                                                Trajectory trajectory(simulation, model.parameter_values());
                                                trajectory.start(model.initial_state(), 0, 0,
                                                                 0.16 * static_cast<double>(totals.cycles));
                                                JetSet jets(simulation, LaneKind::single);
                                                graze::run(trajectory, jets);
                                            }));
    state.counters["points"] = static_cast<double>(plan.points());
    state.counters["settling_periods"] = static_cast<double>(totals.cycles);
    state.counters["all_periods"] = static_cast<double>(totals.returns);
    state.counters["ratio"] = timing.peer() / timing.own();
}

void threads(benchmark::State& state) {
    const StudyRun run = chains_run(32);
    const Plan plan = plan_of(run, System(run.model), nullptr);
    const auto searches = searches_of(run);
    PairedTiming timing;
    for (auto unused : state)
        state.SetIterationTime(
            timing.round([&] { run_all(plan, *searches, 2); }, [&] { run_all(plan, *searches, 1); }));
    state.counters["ratio"] = timing.peer() / timing.own();
}

/// Sixteen chains in lanes against the same ones one after another.
void lanes(benchmark::State& state) {
    const StudyRun run = chains_run(16);
    const Plan plan = plan_of(run, System(run.model), nullptr);
    const auto searches = searches_of(run);
    PairedTiming timing(Clock::processor);
    for (auto unused : state)
        state.SetIterationTime(timing.round([&] { run_all(plan, *searches, 1); },
                                            [&] {
                                                for (std::size_t chain = 0; chain < plan.chains; ++chain) {
                                                    Plan one = plan;
                                                    one.chains = 1;
                                                    one.start = [&](std::size_t point) {
                                                        return plan.start(chain * plan.chain_length + point);
                                                    };
                                                    run_all(one, *searches, 1);
                                                }
                                            }));
    state.counters["ratio"] = timing.peer() / timing.own();
}

/// With a result file against without.
void writing(benchmark::State& state) {
    Study study = load_study("electromagnetic-testbed");
    study.runs = {sweep_run(60, 1)};
    const Plan plan = plan_of(study.runs[0], System(study.runs[0].model), nullptr);
    const auto searches = searches_of(study.runs[0]);
    const auto folder = std::filesystem::temp_directory_path() / ("graze-benchmark-" + std::to_string(getpid()));
    PairedTiming timing(Clock::processor);
    for (auto unused : state)
        state.SetIterationTime(timing.round(
            [&] {
                std::filesystem::remove_all(folder);
                std::filesystem::create_directories(folder);
                ResultFile file((folder / "results.sqlite").string(), ResultFile::Access::write);
                run_study(study, file, {});
            },
            [&] { run_all(plan, *searches, 1); }));
    std::filesystem::remove_all(folder);
    state.counters["share_of_writing"] = 1 - timing.peer() / timing.own();
    state.counters["ratio"] = timing.peer() / timing.own();
}

BENCHMARK_CAPTURE(diagram, labels, 0)->UseManualTime()->Unit(benchmark::kSecond);
BENCHMARK_CAPTURE(diagram, labels_and_exponents, 60)->UseManualTime()->Unit(benchmark::kSecond);
BENCHMARK(threads)->UseManualTime()->Unit(benchmark::kSecond);
BENCHMARK(lanes)->UseManualTime()->Unit(benchmark::kSecond);
BENCHMARK(writing)->UseManualTime()->Unit(benchmark::kSecond);

} // namespace
