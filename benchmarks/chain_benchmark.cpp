// A chain of forced oscillators with walls, of variable length: how start-up, memory, a simulated period, derivatives
// and points of branches scale with its length. Times are CPU times. Benchmarks with `large` in their names take long.

#include "chain.hpp"
#include "memory.hpp"
#include "paired_timing.hpp"

#include "graze/branch/switching.hpp"
#include "graze/flow/mode_flow.hpp"
#include "graze/trajectory/trajectory.hpp"

#include <benchmark/benchmark.h>

#include <limits>
#include <memory>
#include <numbers>
#include <stdexcept>
#include <string>
#include <vector>

namespace {

using namespace graze;

constexpr double period = 2 * std::numbers::pi / Chain::frequency;
constexpr double tolerance = 1e-12;

/// Returns how many short runs are timed together, so that the CPU clock resolves them.
/// @param size of one run, as a multiple of a period of one oscillator
int resolved_runs(std::size_t size) {
    constexpr std::size_t enough = 200;
    return 1 + static_cast<int>(enough / size);
}

/// Targets, in milliseconds.
constexpr double allowed_start_up = 30;
double allowed_point(std::size_t oscillators) {
    return oscillators <= 5 ? 1 : oscillators <= 10 ? 3 : 10;
}

/// Builds a model and computes its first Taylor coefficients.
void first_jet(std::size_t oscillators) {
    const Model model = chain(oscillators, Chain::small_force);
    const Simulation simulation{System(model)};
    JetSet jets(simulation, LaneKind::single);
    jets.set_parameters(model.parameter_values());
    Jet& jet = jets(model.initial_mode);
    jet.compute(model.initial_state());
    benchmark::DoNotOptimize(jet.state(0)[1]);
}

void start_up(benchmark::State& state, std::size_t oscillators) {
    double least = std::numeric_limits<double>::infinity();
    const double megabytes = peak_megabytes([&] { first_jet(oscillators); });
    for (auto unused : state) {
        const double time = seconds([&] { first_jet(oscillators); }, Clock::processor);
        state.SetIterationTime(time);
        least = std::min(least, time);
    }
    state.counters["megabytes"] = megabytes;
    state.counters["ratio"] = allowed_start_up / (1e3 * least);
}

/// The chain in steady motion, simulated period by period.
class ChainRun {
public:
    ChainRun(std::size_t oscillators, double force)
        : model_(chain(oscillators, force)), simulation_(System(model_), {}, {}, {.tolerance = tolerance}),
          jets_(simulation_, LaneKind::single),
          trajectory_(simulation_, model_.parameter_values(), borrowed(observer_)) {
        constexpr int settling = 40;
        trajectory_.start(model_.initial_state(), model_.initial_mode, 0, 0);
        run(settling);
        observer_.contacts = 0;
    }

    void run(int more) {
        periods_ += more;
        trajectory_.extend(periods_ * period);
        graze::run(trajectory_, jets_);
    }
    void require_end() const {
        if (trajectory_.outcome().ending != Ending::end_time)
            throw std::logic_error("the chain's motion has ended: " + trajectory_.outcome().detail);
    }
    const Model& model() const { return model_; }
    const System& system() const { return simulation_.system(); }
    const Trajectory& trajectory() const { return trajectory_; }
    std::size_t contacts() const { return observer_.contacts; }

private:
    struct Counter : Observer {
        std::size_t contacts = 0;
        void contact(const Contact&) override { ++contacts; }
    };
    Counter observer_;
    Model model_;
    Simulation simulation_;
    JetSet jets_;
    Trajectory trajectory_;
    int periods_ = 0;
};

/// The peer is the shortest chain times the number of oscillators: a ratio of 1 means cost proportional to the model.
void plain(benchmark::State& state, std::size_t oscillators, double force) {
    const int periods = resolved_runs(oscillators), periods_of_one = resolved_runs(1);
    ChainRun own(oscillators, force), one(1, force);
    PairedTiming timing(Clock::processor);
    for (auto unused : state)
        state.SetIterationTime(timing.round([&] { own.run(periods); }, [&] { one.run(periods_of_one); }));
    own.require_end();
    const double seconds = timing.own() / periods, seconds_of_one = timing.peer() / periods_of_one;
    state.counters["ms_a_period"] = 1e3 * seconds;
    state.counters["ratio"] = seconds_of_one * static_cast<double>(oscillators) / seconds;
    state.counters["contacts_a_period"] =
        static_cast<double>(own.contacts()) / static_cast<double>(periods * state.iterations());
}

/// Derivatives of the state after a period with respect to the first states or, with more inputs, to all states and the
/// force. The peer is the flow without derivatives.
void derivatives(benchmark::State& state, std::size_t oscillators, std::size_t inputs) {
    const ChainRun settled(oscillators, Chain::small_force);
    const std::vector<double> start(settled.trajectory().state().begin(), settled.trajectory().state().end());
    std::vector<std::size_t> starts;
    std::vector<ParameterId> free;
    for (std::size_t i = 0; i < std::min(inputs, start.size()); ++i)
        starts.push_back(i);
    if (inputs > start.size())
        free.push_back(settled.model().independent_parameter("F"));
    ModeFlow flow(settled.system(), tolerance, 0, free, starts), without(settled.system(), tolerance, 0, {}, {{}});
    flow.set_parameters(settled.model().parameter_values());
    without.set_parameters(settled.model().parameter_values());
    std::vector<double> end, matrix(start.size() * inputs);
    PairedTiming timing(Clock::processor);
    ModeFlow::Ending ending = ModeFlow::Ending::done;
    const int runs = resolved_runs(oscillators * inputs), runs_without = resolved_runs(oscillators);
    for (auto unused : state)
        state.SetIterationTime(timing.round(
            [&] {
                for (int i = 0; i < runs; ++i) {
                    end = start;
                    ending = flow.run(0, end, period, matrix);
                }
            },
            [&] {
                for (int i = 0; i < runs_without; ++i) {
                    end = start;
                    without.run(0, end, period);
                }
            }));
    if (ending != ModeFlow::Ending::done)
        state.SkipWithError("the flow with derivatives does not reach the end");
    const double times = timing.own() / runs / (timing.peer() / runs_without);
    state.counters["times_plain"] = times;
    state.counters["ratio"] = (2 + 0.5 * static_cast<double>(inputs)) / times;
    const auto steps = [&](ModeFlow& one, auto&& run) {
        const std::size_t before = one.steps();
        end = start;
        run();
        return static_cast<double>(one.steps() - before);
    };
    state.counters["steps"] = steps(flow, [&] { flow.run(0, end, period, matrix); });
    state.counters["plain_steps"] = steps(without, [&] { without.run(0, end, period); });
}

Orbit settled_orbit(const Model& model) {
    AttractorOptions settle;
    settle.section = "phase0";
    settle.cycles = 4000;
    return find_orbit(System(model), settle).orbit;
}

BranchSettings in_force(std::size_t steps) {
    BranchSettings settings;
    settings.least = 0.01;
    settings.greatest = 10;
    settings.steps = steps;
    return settings;
}

/// Points of a branch with multipliers, test functions and certificates.
void branch(benchmark::State& state, std::size_t oscillators) {
    constexpr double force = 0.05;
    constexpr std::size_t steps = 20;
    const System system(chain(oscillators, force));
    const Orbit orbit = settled_orbit(system.model());
    double least = std::numeric_limits<double>::infinity();
    Branch followed;
    for (auto unused : state) {
        const double time =
            seconds([&] { followed = follow_branch(system, orbit, in_force(steps)); }, Clock::processor);
        state.SetIterationTime(time);
        least = std::min(least, time);
    }
    const double milliseconds = 1e3 * least / static_cast<double>(followed.points.size());
    state.counters["ms_a_point"] = milliseconds;
    state.counters["ratio"] = allowed_point(oscillators) / milliseconds;
    state.counters["gain_in_F"] = followed.points.back().parameter / force;
}

/// The branch from small force to the grazing of a wall, and from there with a contact.
void branch_with_contact(benchmark::State& state, std::size_t oscillators) {
    constexpr double force = 0.05;
    constexpr std::size_t many = 5000, steps = 20;
    const System system(chain(oscillators, force));
    const Orbit orbit = settled_orbit(system.model());
    double to_grazing = std::numeric_limits<double>::infinity(), least = to_grazing;
    std::size_t points = 0;
    Branch smooth;
    for (auto unused : state) {
        to_grazing = std::min(
            to_grazing, seconds([&] { smooth = follow_branch(system, orbit, in_force(many)); }, Clock::processor));
        if (smooth.special.empty() || smooth.special.back().type != PointType::grazing)
            throw std::logic_error("the branch of the chain does not graze a wall");
        const std::vector<BranchStart> starts = branches_at(system, smooth.special.back(), in_force(steps));
        const double time = seconds(
            [&] {
                OrbitBranch impacting(system, starts.at(0).orbit, in_force(steps));
                points = 0;
                for (bool going = impacting.start_along(starts[0].direction, starts[0].distance); going;
                     going = impacting.step())
                    ++points;
            },
            Clock::processor);
        least = std::min(least, time);
        state.SetIterationTime(time);
    }
    const double milliseconds = 1e3 * least / static_cast<double>(points);
    state.counters["F_of_grazing"] = smooth.special.back().parameter;
    state.counters["points_to_grazing"] = static_cast<double>(smooth.points.size());
    state.counters["s_to_grazing"] = to_grazing;
    state.counters["points_with_contact"] = static_cast<double>(points);
    state.counters["ms_a_point"] = milliseconds;
    state.counters["ratio"] = allowed_point(oscillators) / milliseconds;
}

const int registered = [] {
    const auto add = [](const std::string& name, bool is_large, auto&&... what) {
        auto* one = benchmark::RegisterBenchmark((is_large ? "large/" + name : name).c_str(), what...)
                        ->UseManualTime()
                        ->Unit(benchmark::kMillisecond);
        if (is_large)
            one->Iterations(2);
    };
    const std::vector<std::size_t> sizes = {1, 5, 10, 20, 50, 100, 200};
    // First, while little freed memory could be reused.
    for (const std::size_t n : sizes)
        add("start_up/30_ms/chain_of_" + std::to_string(n), n > 20, start_up, n);
    for (const std::size_t n : sizes) {
        const std::string chain = "chain_of_" + std::to_string(n);
        const bool is_large = n > 20;
        add("plain/one_oscillator/" + chain, is_large, plain, n, Chain::small_force);
        add("plain_with_contact/one_oscillator/" + chain, is_large, plain, n, Chain::large_force);
        add("derivatives/plain/" + chain + "/1", is_large, derivatives, n, 1);
        if (n > 1)
            add("derivatives/plain/" + chain + "/8", is_large, derivatives, n, 8);
        add("derivatives/plain/" + chain + "/all", n > 10, derivatives, n, 2 * n + 2);
        if (n <= 20)
            add("branch/allowed/" + chain, n > 5, branch, n);
        if (n <= 20)
            add("branch_with_contact/allowed/" + chain, n > 1, branch_with_contact, n);
    }
    return 0;
}();

} // namespace
