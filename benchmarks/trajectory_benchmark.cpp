// One trajectory on the period-3 orbit of the electromagnetic vibro-impactor, against Boost.odeint at equal tolerance,
// and what asking for more costs: probes, minima of gaps, derivatives.

#include "testbed.hpp"

#include <benchmark/benchmark.h>

#include <string>

namespace {

using namespace graze;

constexpr double horizon = 1e9;

/// A trajectory on the orbit that can be carried on period by period.
class OrbitRun {
public:
    explicit OrbitRun(const Testbed& testbed, SimulationOptions options, std::vector<Probe> probes = {})
        : simulation_(testbed.model, std::move(probes), {}, options), jets_(simulation_, LaneKind::single),
          trajectory_(simulation_, testbed.model.parameter_values(), counter_) {
        trajectory_.start(testbed.settled(), testbed.model.initial_mode, 0, 0);
        run(0);
    }

    void run(int periods) {
        periods_ += periods;
        trajectory_.extend(periods_ * Testbed::forcing_period);
        graze::run(trajectory_, jets_);
    }

    Trajectory& trajectory() { return trajectory_; }
    std::size_t impacts() const { return counter_.contacts; }

private:
    Simulation simulation_;
    JetSet jets_;
    ContactCounter counter_;
    Trajectory trajectory_;
    int periods_ = 0;
};

/// Whether graze and the peer meet the same impacts and end in the same state, after as many periods as an orbit
/// whose errors decay allows errors to add up.
bool agree(OrbitRun& own, OdeintPeer& peer, const Testbed& testbed, double tolerance) {
    constexpr int periods = 10 * Testbed::orbit_periods;
    const std::size_t before = own.impacts(), peer_before = peer.impacts();
    own.run(periods);
    peer.run(periods);
    const OdeintPeer::State state = testbed.nondimensional(own.trajectory().state());
    double difference = 0;
    for (std::size_t i = 0; i < state.size(); ++i)
        difference = std::max(difference, std::abs(state[i] - peer.state()[i]));
    return own.impacts() - before == peer.impacts() - peer_before && own.impacts() > before &&
           difference <= 1e-11 + 1e4 * tolerance;
}

void period_3_orbit(benchmark::State& state, double tolerance) {
    constexpr int periods = 10 * Testbed::orbit_periods;
    const Testbed testbed;
    OrbitRun own(testbed, {.tolerance = tolerance});
    OdeintPeer peer(testbed.groups(), tolerance);
    peer.start(testbed.nondimensional(own.trajectory().state()));
    if (!agree(own, peer, testbed, tolerance)) {
        state.SkipWithError("graze and odeint do not follow the same orbit");
        return;
    }
    Duel duel;
    for (auto unused : state)
        state.SetIterationTime(duel.round([&] { own.run(periods); }, [&] { peer.run(periods); }));
    state.counters["periods_per_second"] = periods / duel.own();
    state.counters["peer_periods_per_second"] = periods / duel.peer();
    state.counters["ratio"] = duel.peer() / duel.own();
}

void register_orbits() {
    for (const char* tolerance : {"1e-8", "1e-10", "1e-12", "1e-14"})
        benchmark::RegisterBenchmark((std::string("period_3_orbit/odeint/") + tolerance).c_str(), period_3_orbit,
                                     std::stod(tolerance))
            ->UseManualTime()
            ->Unit(benchmark::kMicrosecond);
}

const int registered = [] {
    register_orbits();
    return 0;
}();

} // namespace
