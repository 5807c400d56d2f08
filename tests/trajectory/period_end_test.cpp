// Events at the end of a period, where the state of the event's function is reset.

#include "simulate.hpp"

#include "closed_form.hpp"

#include <gtest/gtest.h>

using namespace graze;
using namespace graze::testing;

namespace period_end_test {

const char* const clock_text = R"(
name = "clock"
parameters = { rate = 1, turn = 1 }
states = { hand = { initial = 0, period = "turn" }, turns = 0 }
events = { noon = "turn - hand" }
jumps.count.turns = "turns + 1"
modes.running = { rates = { hand = "rate", turns = "0" }, watch = ["noon"] }
transitions = [{ mode = "running", event = "noon", jump = "count", next = "running" }]
)";

// Round-off decides whether the intended end of a period comes just before or just after it. The count must be that of
// whole periods in either case.
TEST(PeriodEnd, IsCountedOnceWhereATrajectoryEndsThereAndContinues) {
    Random random(5);
    constexpr int periods = 30;
    for (int trial = 0; trial < 2000; ++trial) {
        const double rate = random.log_uniform(1e-6, 1e6), turn = random.log_uniform(1e-3, 1e3);
        Model model = model_from(clock_text);
        model.set_parameter("rate", rate);
        model.set_parameter("turn", turn);
        const int parts = trial % 9 + 1;
        Experiment experiment(model);
        Trajectory& trajectory = experiment.trajectory;
        trajectory.start(std::vector<double>{0, 0}, 0, 0, 0);
        for (int part = 1; part <= periods * parts; ++part) {
            trajectory.extend(part * (turn / rate) / parts);
            graze::run(trajectory, experiment.jets);
        }
        trajectory.extend((periods + 0.5) * turn / rate);
        graze::run(trajectory, experiment.jets);
        ASSERT_EQ(trajectory.outcome().ending, Ending::end_time);
        EXPECT_EQ(trajectory.state()[1], periods) << "rate " << rate << ", turn " << turn << ", in parts " << parts;
        EXPECT_NEAR(trajectory.state()[0], turn / 2, 1e-12 * turn);
    }
}

} // namespace period_end_test
