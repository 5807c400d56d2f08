// Any number of threads may use one model at once: what is compiled is their own or frozen.
#include "graze/branch/orbit_branch.hpp"
#include "graze/model/catalogue.hpp"
#include "graze/model/named_value.hpp"
#include "graze/sweep/plan.hpp"
#include "graze/trajectory/recorder.hpp"

#include <gtest/gtest.h>

#include <bit>
#include <cstdint>
#include <future>
#include <memory>
#include <string>
#include <thread>
#include <vector>

namespace graze::shared_model_test {

/// Everything that is found, as bits.
using Bits = std::vector<std::uint64_t>;

void add(Bits& bits, std::span<const double> values) {
    for (const double value : values)
        bits.push_back(std::bit_cast<std::uint64_t>(value));
}

void simulate(const System& system, Bits& bits) {
    const Model& model = system.model();
    Probe lowest;
    lowest.kind = Probe::Kind::extremum;
    lowest.expression = named_value(model, model.states[0].name + " * 2", {}).value;
    const Simulation simulation(system, {lowest, section_probe(model, model.sections[0].name)});
    Recorder recorder;
    Trajectory trajectory(simulation, model.parameter_values(), borrowed(recorder));
    JetSet jets(simulation, LaneKind::single);
    trajectory.start(model.initial_state(), model.initial_mode, 0, 60);
    run(trajectory, jets);
    add(bits, trajectory.state());
    for (const auto& passage : recorder.passages())
        add(bits, passage.state);
}

void sweep(const System& system, Bits& bits) {
    const Model& model = system.model();
    AttractorOptions options;
    options.section = model.sections[0].name;
    options.cycles = 60;
    options.lyapunov_cycles = 10;
    const auto searches = attractor_searches(system, options, {}, {}, {});
    Plan plan;
    plan.chains = 2;
    plan.chain_length = 2;
    plan.start = [&](std::size_t point) {
        PointStart start{model.parameter_values(), model.initial_state(), model.initial_mode};
        start.parameters[0] *= 1 + 1e-3 * static_cast<double>(point);
        return start;
    };
    ExecutionOptions execution;
    execution.jobs = 2;
    std::vector<std::vector<double>> ends(plan.points());
    execute(plan, *searches, {}, execution, [&](std::size_t point, const PointStart&, PointResult& result) {
        ends[point] = result.state;
        ends[point].push_back(static_cast<double>(result.label));
    });
    for (const auto& end : ends)
        add(bits, end);
}

void follow(const System& system, Bits& bits) {
    const Model& model = system.model();
    AttractorOptions settle;
    settle.section = model.sections[0].name;
    settle.cycles = 400;
    const OrbitSolution solution = find_orbit(system, settle);
    BranchSettings settings;
    settings.steps = 4;
    Monitor greatest;
    greatest.name = "greatest";
    greatest.kind = Monitor::Kind::maximum;
    greatest.expression = named_value(model, model.states[0].name, {}).value;
    settings.monitors = {greatest};
    for (const BranchPoint& point : follow_branch(system, solution.orbit, settings).points) {
        add(bits, point.solution.orbit.starts[0]);
        add(bits, point.monitors);
        add(bits, {{point.parameter}});
    }
}

Bits all_of(const System& system) {
    Bits bits;
    simulate(system, bits);
    sweep(system, bits);
    follow(system, bits);
    return bits;
}

constexpr auto model_name = "impact-oscillator";
constexpr int threads = 4;

TEST(SharedModel, ThreadsThatCompileItGetTheBitsOfOneThread) {
    const Model model = load_model(model_name);
    const Bits alone = all_of(System(load_model(model_name)));
    ASSERT_GT(alone.size(), 20u);
    std::vector<std::future<Bits>> results;
    for (int i = 0; i < threads; ++i)
        results.push_back(std::async(std::launch::async, [&] { return all_of(System(model)); }));
    for (auto& result : results)
        EXPECT_EQ(result.get(), alone);
}

TEST(SharedModel, ThreadsShareTapesWhichLiveUntilTheLastOneEnds) {
    std::vector<std::future<Bits>> results;
    const Bits alone = all_of(System(load_model(model_name)));
    std::promise<void> others_are_done;
    {
        auto model = std::make_unique<Model>(load_model(model_name));
        const System system(*model);
        for (int i = 0; i < threads; ++i)
            results.push_back(
                std::async(std::launch::async,
                           [system, i, done = i == 0 ? others_are_done.get_future() : std::future<void>()]() mutable {
                               if (i == 0)
                                   done.wait();
                               return all_of(system);
                           }));
        model.reset();
    }
    for (int i = 1; i < threads; ++i)
        EXPECT_EQ(results[static_cast<std::size_t>(i)].get(), alone);
    others_are_done.set_value();
    EXPECT_EQ(results[0].get(), alone);
}

TEST(SharedModel, CopiesMayGrowWhileOthersCompile) {
    const Model model = load_model(model_name);
    const Bits alone = all_of(System(model));
    std::vector<std::future<Bits>> results;
    for (int i = 0; i < threads; ++i)
        results.push_back(std::async(std::launch::async, [copy = model, i]() mutable {
            for (int k = 0; k < 200; ++k)
                copy.symbol(copy.states[0].name) * static_cast<double>(1000 * i + k);
            return all_of(System(copy));
        }));
    for (auto& result : results)
        EXPECT_EQ(result.get(), alone);
}

} // namespace graze::shared_model_test
