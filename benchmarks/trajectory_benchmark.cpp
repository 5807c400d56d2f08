// One trajectory on the period-3 orbit of the electromagnetic vibro-impactor: against Boost.odeint at equal tolerance,
// and the cost of additional output (probes, minima of the gap, derivatives).

#include "testbed.hpp"

#include <benchmark/benchmark.h>

#include <string>

namespace {

using namespace graze;

constexpr int periods = 10 * Testbed::orbit_periods; ///< in each round

/// A trajectory on the orbit, simulated period by period.
class OrbitRun {
public:
    explicit OrbitRun(const Testbed& testbed, SimulationOptions options, std::vector<Probe> probes = {})
        : simulation_(System(testbed.model), std::move(probes), {}, options), jets_(simulation_, LaneKind::single),
          trajectory_(simulation_, testbed.model.parameter_values(), borrowed(counter_)) {
        trajectory_.start(testbed.settled(), testbed.model.initial_mode, 0, 0);
        run(0);
    }

    void run(int more) {
        periods_ += more;
        trajectory_.extend(periods_ * Testbed::forcing_period);
        graze::run(trajectory_, jets_);
    }

    Trajectory& trajectory() { return trajectory_; }
    const Model& model() const { return simulation_.model(); }
    std::size_t impacts() const { return counter_.contacts; }

private:
    Simulation simulation_;
    JetSet jets_;
    ContactCounter counter_;
    Trajectory trajectory_;
    int periods_ = 0;
};

double distance(const OdeintPeer::State& a, const OdeintPeer::State& b) {
    double most = 0;
    for (std::size_t i = 0; i < a.size(); ++i)
        most = std::max(most, std::abs(a[i] - b[i]));
    return most;
}

void period_3_orbit(benchmark::State& state, double tolerance) {
    const Testbed testbed;
    OrbitRun own(testbed, {.tolerance = tolerance});
    OdeintPeer peer(testbed.groups(), tolerance);
    const OdeintPeer::State start = testbed.nondimensional(own.trajectory().state());
    peer.start(start);
    // Errors on a stable orbit soon saturate at a multiple of those of one period.
    const std::size_t before = own.impacts();
    own.run(periods);
    peer.run(periods);
    const double error = distance(testbed.nondimensional(own.trajectory().state()), start);
    const double peer_error = distance(peer.state(), start);
    if (own.impacts() - before != peer.impacts() || !(std::max(error, peer_error) <= 1e-11 + 1e4 * tolerance)) {
        state.SkipWithError("graze and odeint do not follow the same orbit");
        return;
    }
    PairedTiming timing(Clock::processor);
    for (auto unused : state)
        state.SetIterationTime(timing.round([&] { own.run(periods); }, [&] { peer.run(periods); }));
    state.counters["periods_per_second"] = periods / timing.own();
    state.counters["peer_periods_per_second"] = periods / timing.peer();
    state.counters["ratio"] = timing.peer() / timing.own();
    state.counters["error"] = error;
    state.counters["peer_error"] = peer_error;
}

/// Compares the plain simulation with one that computes more: `ratio` is the remaining share of the speed.
void extra(benchmark::State& state, const SimulationOptions& options, const std::vector<std::string>& sections,
           std::size_t directions) {
    const Testbed testbed;
    std::vector<Probe> probes;
    for (const std::string& section : sections)
        probes.push_back(section_probe(testbed.model, section));
    OrbitRun plain(testbed, {}), more(testbed, options, probes);
    const std::size_t inputs = testbed.model.states.size() + testbed.model.parameter_values().size();
    if (directions > 0) {
        std::vector<double> seeds(directions * inputs, 0.0);
        for (std::size_t d = 0; d < directions; ++d)
            seeds[d * inputs + d] = 1;
        more.trajectory().carry_tangents(seeds, directions);
    }
    PairedTiming timing(Clock::processor);
    for (auto unused : state)
        state.SetIterationTime(timing.round([&] { more.run(periods); }, [&] { plain.run(periods); }));
    state.counters["periods_per_second"] = periods / timing.own();
    state.counters["peer_periods_per_second"] = periods / timing.peer();
    state.counters["ratio"] = timing.peer() / timing.own();
}

void register_extras() {
    const auto add = [](const std::string& name, const SimulationOptions& options,
                        const std::vector<std::string>& sections, std::size_t directions) {
        benchmark::RegisterBenchmark(("period_3_orbit/plain/" + name).c_str(), extra, options, sections, directions)
            ->UseManualTime()
            ->Unit(benchmark::kMicrosecond);
    };
    add("one_phase_section", {}, {"phase0"}, 0);
    add("three_sections", {}, {"phase0", "phasepi", "nearest"}, 0);
    add("minima", {.minima = true}, {}, 0);
    add("derivatives_by_1_input", {}, {}, 1);
    add("derivatives_by_7_inputs", {}, {}, 7);
    add("derivatives_by_8_inputs", {}, {}, 8);
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
    register_extras();
    return 0;
}();

} // namespace
