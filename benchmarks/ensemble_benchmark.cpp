// Many trajectories in lanes against the same ones one after another, on one core: the electromagnetic vibro-impactor
// on and near its period-3 orbit, and over the range of voltages in which it moves irregularly.

#include "testbed.hpp"

#include "graze/trajectory/ensemble.hpp"

#include <benchmark/benchmark.h>

#include <string>

namespace {

using namespace graze;

/// Trajectories with slightly different voltages that are simulated together.
class Group {
public:
    static constexpr std::size_t count = 64;

    Group(const Testbed& testbed, const Simulation& simulation, double voltage, double spread) : counters_(count) {
        Model model = testbed.model;
        const std::vector<double> state = testbed.settled();
        for (std::size_t i = 0; i < count; ++i) {
            model.set_parameter("V0", voltage + spread * static_cast<double>(i) / count);
            trajectories.emplace_back(simulation, model.parameter_values(), borrowed(counters_[i]));
            trajectories.back().start(state, model.initial_mode, 0, 0);
        }
    }

    /// Extends the end time by some periods.
    void extend(int periods) {
        periods_ += periods;
        for (Trajectory& trajectory : trajectories)
            trajectory.extend(periods_ * Testbed::forcing_period);
    }

    bool same_states(const Group& other) const {
        for (std::size_t i = 0; i < count; ++i)
            if (!std::ranges::equal(trajectories[i].state(), other.trajectories[i].state()))
                return false;
        return true;
    }

    std::vector<Trajectory> trajectories;

private:
    std::vector<ContactCounter> counters_;
    int periods_ = 0;
};

void lanes(benchmark::State& state, double tolerance, double voltage, double spread) {
    constexpr int periods = 10;
    const Testbed testbed;
    const Simulation simulation(System(testbed.model), {}, {}, {.tolerance = tolerance});
    Group side_by_side(testbed, simulation, voltage, spread), in_turn(testbed, simulation, voltage, spread);
    Ensemble ensemble(simulation);
    JetSet jets(simulation, LaneKind::single);
    const auto run_lanes = [&](int more) {
        side_by_side.extend(more);
        ensemble.run(side_by_side.trajectories);
    };
    const auto run_in_turn = [&](int more) {
        in_turn.extend(more);
        for (Trajectory& trajectory : in_turn.trajectories)
            run(trajectory, jets);
    };
    run_lanes(0);
    run_in_turn(0);
    PairedTiming timing(Clock::processor);
    for (auto unused : state)
        state.SetIterationTime(timing.round([&] { run_lanes(periods); }, [&] { run_in_turn(periods); }));
    if (!side_by_side.same_states(in_turn))
        state.SkipWithError("lanes and single trajectories differ");
    state.counters["periods_per_second"] = Group::count * periods / timing.own();
    state.counters["peer_periods_per_second"] = Group::count * periods / timing.peer();
    state.counters["ratio"] = timing.peer() / timing.own();
}

void register_lanes(const std::string& name, double voltage, double spread) {
    for (const char* tolerance : {"1e-8", "1e-14"})
        benchmark::RegisterBenchmark(("lanes/one_by_one/" + name + "/" + tolerance).c_str(), lanes,
                                     std::stod(tolerance), voltage, spread)
            ->UseManualTime()
            ->Unit(benchmark::kMicrosecond);
}

const int registered = [] {
    register_lanes("period_3", 4.833, 0.01);
    register_lanes("irregular", 5.2, 1.0);
    return 0;
}();

} // namespace
