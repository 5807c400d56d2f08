// Trajectories in lanes equal those of separate runs bit for bit.

#include "graze/trajectory/ensemble.hpp"

#include "closed_form.hpp"
#include "simulate.hpp"
#include "tape/problems.hpp"

#include <gtest/gtest.h>

#include <array>
#include <bit>
#include <cstdint>
#include <thread>

using namespace graze;
using namespace graze::testing;

namespace ensemble_test {

/// Records all observer calls, as bits.
struct Transcript : Observer {
    std::vector<std::uint64_t> bits;
    std::size_t contacts = 0;

    void put(double number) { bits.push_back(std::bit_cast<std::uint64_t>(number)); }
    void put(std::span<const double> numbers) {
        for (const double number : numbers)
            put(number);
    }
    void step(const Step& step) override {
        put(step.start);
        put(step.length);
    }
    void contact(const Contact& contact) override {
        ++contacts;
        bits.push_back(static_cast<std::uint64_t>(contact.kind));
        bits.push_back(contact.transition);
        put(std::array{contact.time, contact.rate_before, contact.rate_after, contact.value});
        put(contact.before);
        put(contact.after);
    }
    void passage(const Passage& passage) override {
        bits.push_back(passage.probe);
        put(passage.time);
        put(passage.state);
    }
    void minimum(const StepMinimum& minimum) override {
        put(minimum.time);
        put(minimum.minimum.value);
    }
};

struct Task {
    std::vector<double> parameters, state;
    std::size_t mode = 0;
    double end_time = 0;
};

/// The results of one task.
struct Result {
    std::vector<std::uint64_t> bits;
    std::vector<double> state;
    Ending ending;
    double time;
    std::size_t steps, contacts;

    bool operator==(const Result& other) const {
        return bits == other.bits && ending == other.ending && steps == other.steps &&
               std::bit_cast<std::uint64_t>(time) == std::bit_cast<std::uint64_t>(other.time) &&
               std::equal(state.begin(), state.end(), other.state.begin(), [](double a, double b) {
                   return std::bit_cast<std::uint64_t>(a) == std::bit_cast<std::uint64_t>(b);
               });
    }
};

Result result_of(const Trajectory& trajectory, const Transcript& transcript) {
    return {transcript.bits,
            {trajectory.state().begin(), trajectory.state().end()},
            trajectory.outcome().ending,
            trajectory.outcome().time,
            trajectory.steps(),
            transcript.contacts};
}

Result run_alone(const Simulation& simulation, const Task& task, InstructionSet set) {
    Transcript transcript;
    Trajectory trajectory(simulation, task.parameters, borrowed(transcript));
    trajectory.start(task.state, task.mode, 0, task.end_time);
    JetSet jets(simulation, LaneKind::single, set);
    graze::run(trajectory, jets);
    return result_of(trajectory, transcript);
}

std::vector<Result> run_together(const Simulation& simulation, const std::vector<Task>& tasks, InstructionSet set) {
    std::vector<Transcript> transcripts(tasks.size());
    std::vector<Trajectory> trajectories;
    for (std::size_t i = 0; i < tasks.size(); ++i) {
        trajectories.emplace_back(simulation, tasks[i].parameters, borrowed(transcripts[i]));
        trajectories.back().start(tasks[i].state, tasks[i].mode, 0, tasks[i].end_time);
    }
    Ensemble(simulation, set).run(trajectories);
    std::vector<Result> results;
    for (std::size_t i = 0; i < tasks.size(); ++i)
        results.push_back(result_of(trajectories[i], transcripts[i]));
    return results;
}

/// Returns a time in which a model has many events.
double span_of(const std::string& model) {
    if (model == "electromagnetic-testbed")
        return 0.6;
    if (model == "bouncing-ball" || model == "ball-and-shaker" || model == "microbeam")
        return 2;
    return 30;
}

std::vector<Task> draw_tasks(const Model& model, Random& random, int count) {
    std::vector<Task> tasks;
    for (int i = 0; i < count; ++i) {
        Task task{model.parameter_values(), model.initial_state(), model.initial_mode,
                  span_of(model.name) * random.uniform(0, 1)};
        for (double& parameter : task.parameters)
            parameter *= 1 + 0.03 * random.uniform(-1, 1);
        for (std::size_t k = 0; k < task.state.size(); ++k)
            if (random.chance(0.7) && !(model.name == "mems-switch" && k == 0))
                task.state[k] += 0.02 * random.uniform(-1, 1) * (1e-3 + std::abs(task.state[k]));
        if (random.chance(0.05))
            task.end_time = 0;
        tasks.push_back(task);
    }
    return tasks;
}

std::vector<Probe> all_probes(const Model& model) {
    std::vector<Probe> probes;
    for (const Section& section : model.sections)
        probes.push_back(section_probe(model, section.name));
    if (!model.quantities.empty())
        probes.push_back({"extremum", Probe::Kind::extremum, model.quantities[0].value, Direction::both, 0, {}});
    return probes;
}

TEST(Ensemble, ShippedModelsInLanesEqualSeparateRuns) {
    Random random(21);
    std::size_t contacts = 0;
    for (const CatalogueEntry& entry : catalogue()) {
        const Model model = load_model(entry.name);
        const Simulation simulation(System(model), all_probes(model), {}, {.tolerance = 1e-10, .minima = true});
        for (const InstructionSet set : supported_sets())
            for (const int count : {1, 2, 3, 5, 8, 17, 40}) {
                const std::vector<Task> tasks = draw_tasks(model, random, count);
                const std::vector<Result> together = run_together(simulation, tasks, set);
                for (std::size_t i = 0; i < tasks.size(); ++i) {
                    contacts += together[i].contacts;
                    EXPECT_TRUE(together[i] == run_alone(simulation, tasks[i], set))
                        << entry.name << ", " << name_of(set) << ", " << i << " of " << count;
                }
            }
    }
    EXPECT_GT(contacts, 5000U);
}

TEST(Ensemble, TrajectoriesThatEndEarlyDoNotAffectOthers) {
    // x' = x^2 is singular at 1/x, 1/(x - 1) is undefined at 1, the square root below 0; other trajectories end at
    // barriers or by the limit of steps.
    const Model model = model_from(R"toml(
name = "ends"
parameters = { a = 1 }
states = { x = 1, y = 0 }
modes.burst = { rates = { x = "a*x^2", y = 1 }, watch = ["wall"] }
modes.root = { rates = { x = "-sqrt(x)", y = "1/(x - 2)" } }
modes.wave = { rates = { x = "y", y = "-a*x" }, watch = ["turn"] }
events.wall = { function = "10 - y" }
events.turn = { function = "x + 5", kind = "section" }
transitions = [
    { mode = "burst", event = "wall", next = "end" },
    { mode = "wave", event = "turn", next = [{ when = "x > 0", mode = "wave" }] },
]
initial = { mode = "burst" }
)toml");
    const Simulation simulation(System(model), {}, {}, {.step_limit = 200});
    Random random(22);
    std::vector<Task> tasks;
    for (int i = 0; i < 60; ++i) {
        const double sign = random.chance(0.5) ? 1 : -1;
        const std::size_t mode = static_cast<std::size_t>(i % 3);
        tasks.push_back({{random.uniform(0.5, 2)},
                         {mode == 1 ? random.uniform(-0.2, 3) : sign * random.uniform(0.1, 6), random.uniform(0, 8)},
                         mode,
                         random.log_uniform(0.1, 1e4)});
    }
    tasks[7].state[0] = 2; // undefined at the start
    tasks[7].mode = 1;
    for (const InstructionSet set : supported_sets()) {
        const std::vector<Result> together = run_together(simulation, tasks, set);
        std::vector<int> endings(16);
        for (std::size_t i = 0; i < tasks.size(); ++i) {
            ++endings[static_cast<std::size_t>(together[i].ending)];
            EXPECT_TRUE(together[i] == run_alone(simulation, tasks[i], set)) << i;
        }
        for (const Ending ending : {Ending::end_time, Ending::terminal, Ending::singular, Ending::undefined,
                                    Ending::no_transition, Ending::step_limit})
            EXPECT_GT(endings[static_cast<std::size_t>(ending)], 0) << name_of(ending);
    }
}

TEST(Ensemble, CanBeContinuedAndReused) {
    const Model model = load_model("bouncing-ball");
    const Simulation simulation{System(model)};
    Random random(23);
    std::vector<Task> tasks = draw_tasks(model, random, 13);
    Ensemble ensemble(simulation);
    std::vector<Transcript> transcripts(tasks.size());
    std::vector<Trajectory> trajectories;
    for (std::size_t i = 0; i < tasks.size(); ++i) {
        trajectories.emplace_back(simulation, tasks[i].parameters, borrowed(transcripts[i]));
        trajectories.back().start(tasks[i].state, 0, 0, tasks[i].end_time);
    }
    ensemble.run(trajectories);
    for (std::size_t i = 0; i < tasks.size(); i += 2)
        trajectories[i].extend(3);
    ensemble.run(trajectories);
    JetSet jets(simulation, LaneKind::single);
    for (std::size_t i = 0; i < tasks.size(); ++i) {
        Transcript transcript;
        Trajectory alone(simulation, tasks[i].parameters, borrowed(transcript));
        alone.start(tasks[i].state, 0, 0, tasks[i].end_time);
        graze::run(alone, jets);
        if (i % 2 == 0) {
            alone.extend(3);
            graze::run(alone, jets);
        }
        EXPECT_TRUE(result_of(alone, transcript) == result_of(trajectories[i], transcripts[i])) << i;
    }
    ensemble.run({});
}

// A motion may take too long: single and in lanes, it is left unfinished on request.
TEST(Ensemble, LeavesMotionsUnfinishedOnRequest) {
    const Simulation simulation{System(load_model("impact-oscillator"))};
    Observer observer;
    for (const std::size_t count : {std::size_t{1}, std::size_t{9}}) {
        std::vector<Trajectory> trajectories;
        for (std::size_t i = 0; i < count; ++i) {
            trajectories.emplace_back(simulation, simulation.model().parameter_values(), borrowed(observer));
            trajectories.back().start(simulation.model().initial_state(), 0, 0, 1e12);
        }
        Ensemble ensemble(simulation);
        int asked = 0;
        ensemble.stop_when([&] { return ++asked == 3; });
        ensemble.run(trajectories);
        EXPECT_EQ(asked, 3);
        for (const Trajectory& trajectory : trajectories)
            EXPECT_FALSE(trajectory.finished());
        EXPECT_GT(trajectories.front().time(), 0);
    }
}

TEST(Ensemble, ThreadsCanShareASimulation) {
    for (const char* name : {"impact-microactuator", "electromagnetic-testbed"}) {
        const Model model = load_model(name);
        const Simulation simulation(System(model), all_probes(model));
        Random random(24);
        const std::vector<Task> tasks = draw_tasks(model, random, 24);
        std::vector<std::vector<Result>> results(3);
        std::vector<std::thread> threads;
        for (auto& result : results)
            threads.emplace_back([&] { result = run_together(simulation, tasks, best_instruction_set()); });
        for (std::thread& thread : threads)
            thread.join();
        for (std::size_t i = 0; i < tasks.size(); ++i) {
            const Result alone = run_alone(simulation, tasks[i], best_instruction_set());
            for (const auto& result : results)
                EXPECT_TRUE(result[i] == alone) << name << " " << i;
        }
    }
}

} // namespace ensemble_test
