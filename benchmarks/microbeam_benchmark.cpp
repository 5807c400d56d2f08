// The microbeam with a compliant stop: the cost of nine modes against one, of derivatives with respect to all states
// and the voltage against none, and of the folds that end its branches. Benchmarks with `large` in their names take
// long.

#include "paired_timing.hpp"

#include "graze/branch/switching.hpp"
#include "graze/model/microbeam.hpp"
#include "graze/trajectory/trajectory.hpp"

#include <benchmark/benchmark.h>

#include <cmath>
#include <numbers>
#include <stdexcept>
#include <string>
#include <vector>

namespace {

using namespace graze;

constexpr int periods = 4; ///< periods per measurement

/// The beam in steady motion, simulated period by period.
class BeamRun {
public:
    BeamRun(int modes, bool derivatives)
        : model_(microbeam({.modes = modes})), period_(2 * std::numbers::pi / MicrobeamOptions{}.frequency),
          simulation_(System(model_)), jets_(simulation_, LaneKind::single),
          trajectory_(simulation_, model_.parameter_values(), borrowed(observer_)) {
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
    PairedTiming timing;
    for (auto unused : state)
        state.SetIterationTime(timing.round([&] { own.run(periods); }, [&] { peer.run(periods); }));
    if (own.trajectory().outcome().ending != Ending::end_time)
        state.SkipWithError("the trajectory has ended early");
    state.counters["periods_per_second"] = periods / timing.own();
    state.counters["peer_periods_per_second"] = periods / timing.peer();
    state.counters["ratio"] = timing.peer() / timing.own();
}

/// The cost of one of the two folds: seconds including the model, and points.
struct FoldRun {
    double seconds = 0, voltage = 0;
    std::size_t points = 0;
};

Orbit settled_orbit(const Model& model) {
    AttractorOptions settle;
    settle.section = "phase0";
    settle.cycles = 2000;
    const OrbitSolution solution = find_orbit(System(model), settle);
    if (solution.outcome != OrbitOutcome::converged)
        throw std::logic_error("the beam does not settle: " + solution.detail);
    return solution.orbit;
}

BranchSettings in_voltage(const Model& model, int direction) {
    BranchSettings settings;
    settings.parameter = model.independent_parameter("V");
    settings.direction = direction;
    settings.least = 0.005;
    settings.greatest = 0.06;
    settings.steps = 5000;
    settings.stop_at = {PointType::fold};
    return settings;
}

double fold_of(const std::vector<SpecialPoint>& special) {
    if (special.empty() || special.back().type != PointType::fold || !special.back().located)
        throw std::logic_error("the beam's branch does not end in a fold");
    return special.back().parameter;
}

/// From rest at a small voltage up to the grazing of the stop, then with contact to the fold that ends the branch of
/// low penetration.
void low_fold(int modes, FoldRun& run) {
    const Model model = microbeam({.modes = modes, .voltage = 0.01});
    const System system(model);
    const BranchSettings settings = in_voltage(model, 1);
    const Branch free = follow_branch(system, settled_orbit(model), settings);
    if (free.special.empty() || free.special.back().type != PointType::grazing)
        throw std::logic_error("the beam does not graze its stop");
    const std::vector<BranchStart> starts = branches_at(system, free.special.back(), settings);
    OrbitBranch contact(system, starts.at(0).orbit, settings);
    run.points = free.points.size();
    std::vector<SpecialPoint> last;
    for (bool going = contact.start_along(starts[0].direction, starts[0].distance); going; going = contact.step()) {
        ++run.points;
        if (!contact.found().empty())
            last = contact.found();
    }
    run.voltage = fold_of(last);
}

/// From rest at a large voltage, where the beam settles deep in its stop, down to the fold that ends the branch of high
/// penetration.
void high_fold(int modes, FoldRun& run) {
    const Model model = microbeam({.modes = modes, .voltage = 0.034});
    const Branch branch = follow_branch(System(model), settled_orbit(model), in_voltage(model, -1));
    run.points = branch.points.size();
    run.voltage = fold_of(branch.special);
}

/// The peer is one mode; times are CPU times. @param voltage independently known voltage of the fold
void fold(benchmark::State& state, int modes, void (*find)(int, FoldRun&), double voltage) {
    FoldRun own, one;
    PairedTiming timing(Clock::processor);
    for (auto unused : state)
        state.SetIterationTime(timing.round([&] { find(modes, own); }, [&] { find(1, one); }));
    constexpr double last_digit = 1e-11; // accuracy of the known values
    if (!(std::abs(own.voltage - voltage) < last_digit))
        state.SkipWithError("the fold is not where it is known to be");
    state.counters["s"] = timing.own();
    state.counters["points"] = static_cast<double>(own.points);
    state.counters["points_of_peer"] = static_cast<double>(one.points);
    state.counters["ratio"] = timing.peer() / timing.own();
    state.counters["V"] = own.voltage;
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
    const auto add_fold = [](const std::string& name, int modes, void (*find)(int, FoldRun&), double voltage) {
        auto* one = benchmark::RegisterBenchmark(name.c_str(), fold, modes, find, voltage)
                        ->UseManualTime()
                        ->Unit(benchmark::kMillisecond);
        if (modes > 1)
            one->Iterations(1);
    };
    add_fold("low_fold/1_mode/1_mode", 1, low_fold, 0.032825650930776);
    add_fold("high_fold/1_mode/1_mode", 1, high_fold, 0.022532683475758);
    add_fold("large/low_fold/1_mode/9_modes", 9, low_fold, 0.032895909148145);
    add_fold("large/high_fold/1_mode/9_modes", 9, high_fold, 0.02272192415);
    return 0;
}();

} // namespace
