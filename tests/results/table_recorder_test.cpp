#include "graze/results/table_recorder.hpp"

#include "graze/trajectory/run_control.hpp"
#include "trajectory/ball_between_walls.hpp"

#include <gtest/gtest.h>

namespace graze::table_recorder_test {

TEST(TableRecorder, RunEndsWhenTheTableIsFull) {
    const Model model = testing::ball_between_walls(0);
    for (const TableKind kind : {TableKind::contacts, TableKind::minima}) {
        SimulationOptions options;
        options.minima = kind == TableKind::minima;
        const Simulation simulation(System(model), {}, {}, options);
        TableRequest request;
        request.kind = kind;
        request.events = {true, true};
        request.most_cells = 1000;
        const std::shared_ptr<TableRecorder> table = make_table_recorder(simulation, request);
        RunControl control(table, std::nullopt, request.events);
        control.end_when([&] { return table->is_full(); });
        Trajectory trajectory(simulation, {}, borrowed(control));
        trajectory.start(model.initial_state(), 0, 0, 1e9);
        control.begin({}, 0, true);
        JetSet jets(simulation, LaneKind::single);
        run(trajectory, jets);
        EXPECT_EQ(trajectory.outcome().ending, Ending::stopped);
        EXPECT_TRUE(table->is_full());
        const std::size_t cells = table->table().rows() * table->table().columns().size();
        EXPECT_GE(cells, 1000u);
        EXPECT_LT(cells, 1100u) << "it stops at once";
    }
}

} // namespace graze::table_recorder_test
