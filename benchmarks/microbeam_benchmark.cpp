// The microbeam with a compliant stop: what nine modes cost against one, and derivatives with respect to all states and
// the voltage against none.

#include "duel.hpp"

#include "graze/model/microbeam.hpp"
#include "graze/trajectory/trajectory.hpp"

#include <benchmark/benchmark.h>

#include <numbers>
#include <vector>

namespace {

using namespace graze;

constexpr int periods = 4; ///< in each round

/// The beam in steady motion that can be carried on period by period.
class BeamRun {
public:
    BeamRun(int modes, bool derivatives)
        : model_(microbeam({.modes = modes})), period_(2 * std::numbers::pi / MicrobeamOptions{}.frequency),
          simulation_(model_), jets_(simulation_, LaneKind::single),
          trajectory_(simulation_, model_.parameter_values(), observer_) {
        trajectory_.start(model_.initial_state(), model_.initial_mode, 0, 0);
        run(20);
        if (derivatives)
            carry_derivatives();
    }

    void run(int more) {
        periods_ += more;
        trajectory_.extend(periods_ * period_);
        graze::run(trajectory_, jets_);
    }

    const Trajectory& trajectory() const { return trajectory_; }

private:
    void carry_derivatives() {
        const std::size_t states = model_.states.size(), inputs = states + model_.parameter_values().size();
        std::size_t voltage = states;
        while (model_.parameter_symbols()[voltage - states].name() != "V")
            ++voltage;
        std::vector<double> seeds((states + 1) * inputs, 0.0);
        for (std::size_t d = 0; d < states; ++d)
            seeds[d * inputs + d] = 1;
        seeds[states * inputs + voltage] = 1;
        trajectory_.carry_tangents(seeds, states + 1);
    }

    Observer observer_;
    Model model_;
    double period_;
    Simulation simulation_;
    JetSet jets_;
    Trajectory trajectory_;
    int periods_ = 0;
};

void beam(benchmark::State& state, int modes, bool derivatives, int peer_modes) {
    BeamRun own(modes, derivatives), peer(peer_modes, false);
    Duel duel;
    for (auto unused : state)
        state.SetIterationTime(duel.round([&] { own.run(periods); }, [&] { peer.run(periods); }));
    if (own.trajectory().outcome().ending != Ending::end_time)
        state.SkipWithError("the trajectory has ended early");
    state.counters["periods_per_second"] = periods / duel.own();
    state.counters["peer_periods_per_second"] = periods / duel.peer();
    state.counters["ratio"] = duel.peer() / duel.own();
}

const int registered = [] {
    const auto add = [](const char* name, int modes, bool derivatives, int peer_modes) {
        benchmark::RegisterBenchmark(name, beam, modes, derivatives, peer_modes)
            ->UseManualTime()
            ->Unit(benchmark::kMicrosecond);
    };
    add("beam/1_mode/9_modes", 9, false, 1);
    add("beam/1_mode/1_mode_with_derivatives", 1, true, 1);
    add("beam/9_modes/9_modes_with_derivatives", 9, true, 9);
    return 0;
}();

} // namespace
