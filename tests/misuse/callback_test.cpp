// What every computation promises of the callbacks that it is given: one is called at a time, and what one throws comes
// out of the call, after which all is as if nothing had been begun.

#include "misuse/valid_objects.hpp"

#include "acquire/bench_experiment.hpp"
#include "base/temporary_folder.hpp"
#include "graze/acquire/acquisition.hpp"
#include "graze/branch/ladder.hpp"
#include "graze/branch/yield.hpp"
#include "graze/identify/fit.hpp"
#include "graze/study/runner.hpp"
#include "graze/sweep/plan.hpp"
#include "graze/trajectory/ensemble.hpp"
#include "instrument/bench_lines.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <cmath>
#include <functional>
#include <thread>

namespace graze::callback_test {

using namespace graze::testing;

/// What a caller throws: nothing that the library knows.
struct Enough : std::exception {};

/// Is called back: counts, finds out whether somebody else is in it, and throws when it has been called often enough.
class Watch {
public:
    /// @param often 0: it does not throw
    explicit Watch(int often = 0) : often_(often) {}
    void call() {
        if (inside_.exchange(true))
            together_ = true;
        if (called_ < 64 && called_ % 8 == 0)
            std::this_thread::sleep_for(std::chrono::microseconds(100)); // for others to come in
        const bool enough = ++called_ == often_;
        after_ = after_ || (often_ > 0 && called_ > often_);
        inside_ = false;
        if (enough)
            throw Enough();
    }
    int called() const { return called_; }
    void expect_one_at_a_time() const {
        EXPECT_GT(called_, 0);
        EXPECT_FALSE(together_);
        EXPECT_FALSE(after_) << "called again after it had thrown";
    }

private:
    const int often_;
    std::atomic<bool> inside_{false}, together_{false}, after_{false};
    std::atomic<int> called_{0};
};

/// @param computation with all of its callbacks calling the watch
void expect_promises(const std::function<void(Watch&)>& computation) {
    Watch calm;
    EXPECT_NO_THROW(computation(calm));
    calm.expect_one_at_a_time();
    for (const int often : {1, 2, calm.called() / 4}) {
        if (often > calm.called() || often < 1)
            continue;
        Watch thrower(often);
        bool thrown = false;
        try {
            computation(thrower);
        } catch (const Enough&) {
            thrown = true;
        }
        // Threads do not wait to ask whether to stop, so that the number of calls differs from run to run.
        EXPECT_EQ(thrown, thrower.called() >= often) << thrower.called() << ", " << often << " of " << calm.called();
        EXPECT_TRUE(thrown || often > 2);
        thrower.expect_one_at_a_time();
    }
}

/// Observes and throws.
class Thrower : public Observer {
public:
    explicit Thrower(Watch& watch) : watch_(watch) {}
    void step(const Step&) override { watch_.call(); }
    void contact(const Contact&) override { watch_.call(); }
    bool stop() override {
        watch_.call();
        return false;
    }

private:
    Watch& watch_;
};

Study study() {
    return parse_study(R"(
name = "s"
model = "impact-oscillator"
set = { sigma = 0.5, omega = 1.2, amplitude = 0.1 }
[runs.rest]
kind = "orbit"
[runs.branch]
kind = "continue"
start = { run = "rest" }
along = { amplitude = [0.05, 0.6] }
steps = 5
[runs.sweep]
kind = "sweep"
vary = { amplitude = { from = 0.1, to = 0.3, points = 4 } }
cycles = 10
[runs.basin]
kind = "basin"
vary = { x = { from = 0.1, to = 0.3, points = 3 }, v = { from = 0, to = 0.1, points = 3 } }
cycles = 10
)",
                       "s.toml");
}

TEST(Callbacks, AnExceptionEndsAMotion) {
    expect_promises([](Watch& watch) {
        Motion motion;
        Trajectory trajectory(motion.simulation, motion.model.parameter_values(), std::make_shared<Thrower>(watch));
        trajectory.start(motion.model.initial_state(), motion.model.initial_mode, 0, 10);
        run(trajectory, motion.jets);
    });
}

TEST(Callbacks, AnExceptionLeavesAnEnsembleUsable) {
    const Simulation simulation{System(oscillator())};
    Ensemble ensemble(simulation);
    const auto run_in = [&](Watch& watch) {
        std::vector<Trajectory> trajectories;
        for (int i = 0; i < 20; ++i) {
            trajectories.emplace_back(simulation, oscillator().parameter_values(), std::make_shared<Thrower>(watch));
            trajectories.back().start(oscillator().initial_state(), 0, 0, 2);
        }
        ensemble.stop_when([&] {
            watch.call();
            return false;
        });
        ensemble.run(trajectories);
        for (const Trajectory& trajectory : trajectories)
            EXPECT_EQ(trajectory.outcome().ending, Ending::end_time);
    };
    expect_promises(run_in);
    Watch calm;
    run_in(calm);
}

TEST(Callbacks, AnExceptionEndsAPlan) {
    for (const bool carry : {false, true})
        for (const int jobs : {1, 3})
            expect_promises([&](Watch& watch) {
                const Model model = oscillator();
                Plan plan{.chains = 8, .chain_length = 3, .carry = carry, .start = {}};
                plan.start = [&](std::size_t) {
                    watch.call();
                    return PointStart{model.parameter_values(), model.initial_state(), 0};
                };
                ExecutionOptions options;
                options.jobs = jobs;
                options.interrupted = [&] {
                    watch.call();
                    return false;
                };
                EXPECT_TRUE(execute(plan, *transient_searches(System(model), {.time = 1}, {}, {}, {}), {}, options,
                                    [&](std::size_t, const PointStart&, PointResult&) { watch.call(); }));
            });
}

TEST(Callbacks, AnExceptionEndsOrbitsAndBranches) {
    const System system(calm_oscillator());
    expect_promises([&](Watch& watch) {
        find_orbit(system, by_phase(), {}, {}, [&] {
            watch.call();
            return false;
        });
    });
    expect_promises([&](Watch& watch) {
        BranchSettings settings = by_amplitude();
        settings.steps = 5;
        follow_branch(system, calm_orbit(), settings, [&](const BranchPoint&, const std::vector<SpecialPoint>&) {
            watch.call();
            return true;
        });
    });
    expect_promises([&](Watch& watch) {
        climb(
            system, grazing_point(), by_amplitude(), 2,
            [&](std::size_t, const Branch&) {
                watch.call();
                return true;
            },
            [&] {
                watch.call();
                return false;
            });
    });
    expect_promises([&](Watch& watch) {
        YieldSettings settings;
        settings.tolerances = {{oscillator().independent_parameter("omega"), Spread::normal, 1e-4}};
        settings.devices = 200;
        settings.jobs = 3;
        settings.progress = [&](std::size_t) { watch.call(); };
        settings.interrupted = [&] {
            watch.call();
            return false;
        };
        yield_of(system, grazing_point(), oscillator().independent_parameter("amplitude"), settings);
    });
}

TEST(Callbacks, AnExceptionEndsAStudy) {
    const TemporaryFolder folder;
    int files = 0;
    for (const int jobs : {1, 3})
        expect_promises([&](Watch& watch) {
            ResultFile file(folder / std::to_string(files++), ResultFile::Access::write);
            RunnerOptions options;
            options.jobs = jobs;
            options.progress = [&](const StudyProgress&) { watch.call(); };
            options.orbit = [&](const std::string&, const OrbitRecord&) { watch.call(); };
            options.interrupted = [&] {
                watch.call();
                return false;
            };
            for (const RunReport& report : run_study(study(), file, options))
                EXPECT_TRUE(report.complete()) << report.name << ": " << report.problem;
        });
    // What looks like a mistake of the run is the caller's, too.
    ResultFile file(folder / "input", ResultFile::Access::write);
    RunnerOptions options;
    options.progress = [](const StudyProgress&) { throw InputError("of the caller", ""); };
    EXPECT_THROW(run_study(study(), file, options), InputError);
}

TEST(Callbacks, AnExceptionEndsAFit) {
    const Model model = calm_oscillator();
    FitTask task;
    task.parameters = {{.parameter = model.independent_parameter("amplitude"), .guess = 0.1}};
    task.outputs = {{.name = "x", .value = model.symbol("x")}};
    FitRecord record;
    record.start = model.initial_state();
    record.readings.resize(1);
    for (int i = 0; i <= 40; ++i) {
        record.times.push_back(0.25 * i);
        record.readings[0].values.push_back(0.1 * std::sin(0.3 * i));
    }
    task.records = {record};
    expect_promises([&](Watch& watch) {
        FitSettings settings;
        settings.most_iterations = 3;
        settings.progress = [&](const FitProgress&) {
            watch.call();
            return true;
        };
        settings.interrupted = [&] {
            watch.call();
            return false;
        };
        fit_model(System(model), task, settings);
    });
}

TEST(Callbacks, AnExceptionEndsAnAcquisition) {
    const TemporaryFolder folder;
    int files = 0;
    const Experiment experiment = parse_experiment(experiment_text(), "sweep.toml");
    expect_promises([&](Watch& watch) {
        ScpiBench bench(testbed_bench());
        BenchGeneratorLine line(bench);
        BenchSampleLine samples(bench);
        AcquisitionOptions options;
        options.progress = [&](const AcquisitionProgress&) { watch.call(); };
        options.begun = [&] { watch.call(); };
        options.recorded = [&](const RecordEntry&) { watch.call(); };
        options.interrupted = [&] {
            watch.call();
            return false;
        };
        TextSampleDevice device(borrowed(samples), 0.1, options.interrupted);
        RecordFolder records(folder / std::to_string(files++), experiment, 0);
        EXPECT_EQ(acquire(experiment, line, device, records, options).ending, AcquisitionEnding::complete);
        EXPECT_EQ(bench.generator().output(), (GeneratorOutput{6.1, 0.1, 0}));
    });
}

} // namespace graze::callback_test
