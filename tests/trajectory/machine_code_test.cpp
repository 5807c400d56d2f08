// Machine code of shipped models: the same numbers as without it.

#include "graze/flow/system.hpp"
#include "graze/tape/jet.hpp"
#include "same_bits.hpp"
#include "trajectory/simulate.hpp"

#include <gtest/gtest.h>

#include <algorithm>

namespace graze::machine_code_test {

using testing::same_bits;

TEST(MachineCode, CoefficientsOfAllShippedModels) {
    for (const std::string& name : shipped_models()) {
        const Model model = load_model(name);
        const System system(model);
        const std::vector<double> parameters = model.parameter_values();
        std::vector<double> state(system.states()), work(system.initial().workspace());
        system.initial().evaluate(parameters, state, work);
        for (std::size_t mode = 0; mode < model.modes.size(); ++mode)
            for (const int order : {2, 3, 4, 7, 12, 19, 32}) {
                const Tape& tape = system.mode(mode).tape;
                const auto by_kernels =
                               make_jet(tape, order, LaneKind::single, best_instruction_set(), MachineCode::never),
                           by_code =
                               make_jet(tape, order, LaneKind::single, best_instruction_set(), MachineCode::at_once);
                for (const auto& jet : {by_kernels.get(), by_code.get()}) {
                    jet->set_parameters(parameters);
                    jet->compute(state);
                }
                for (std::size_t i = 0; i < by_kernels->series().size(); ++i)
                    for (std::size_t k = 0; k <= static_cast<std::size_t>(order); ++k)
                        ASSERT_TRUE(same_bits(by_kernels->series()[i][k], by_code->series()[i][k]))
                            << name << " mode " << mode << " series " << i << " coefficient " << k << " of " << order;
            }
    }
}

/// Returns state and number of steps after many steps of a trajectory with impacts.
std::vector<double> end_of_long_run(SystemOptions options) {
    const Model model = load_model("electromagnetic-testbed");
    const Simulation simulation(System(model, options), {}, {}, {.tolerance = 1e-8});
    Trajectory trajectory(simulation, model.parameter_values());
    std::vector<double> state(model.states.size(), 0.0);
    trajectory.start(state, model.initial_mode, 0, 100);
    testing::run(trajectory);
    std::vector<double> end(trajectory.state().begin(), trajectory.state().end());
    end.push_back(static_cast<double>(trajectory.steps()));
    return end;
}

TEST(MachineCode, LongTrajectoriesAreTheSameWithoutIt) {
    const std::vector<double> with = end_of_long_run({}), without = end_of_long_run({.machine_code = false});
    EXPECT_GT(with.back(), 10'000) << "long enough for machine code to be made on the way";
    ASSERT_EQ(with.size(), without.size());
    for (std::size_t i = 0; i < with.size(); ++i)
        EXPECT_TRUE(same_bits(with[i], without[i])) << i << ": " << with[i] << " and " << without[i];
}

TEST(MachineCode, WithoutItHoldsForAllTapesOfASystem) {
    const Model model = load_model("electromagnetic-testbed");
    const System system(model, {.machine_code = false}), usual(model);
    EXPECT_NE(usual.mode(0).tape.native_codes, nullptr);
    EXPECT_EQ(system.mode(0).tape.native_codes, nullptr);
    EXPECT_EQ(system.without_events().mode(0).tape.native_codes, nullptr);
    EXPECT_EQ(system.observing(std::vector{model.state_symbols()[0]}).mode(0).tape.native_codes, nullptr);
    EXPECT_EQ(system.linear(0).tape.native_codes, nullptr);
}

} // namespace graze::machine_code_test
