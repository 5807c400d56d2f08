#include "graze/trajectory/run_control.hpp"

#include "graze/trajectory/trajectory.hpp"
#include "trajectory/ball_between_walls.hpp"

#include <gtest/gtest.h>

namespace graze::run_control_test {

struct Seen : Observer {
    void contact(const Contact& contact) override { times.push_back(contact.time); }
    std::vector<double> times;
};

/// Runs a leg that is not shown and one that is. @return the contacts of the latter
std::vector<double> contacts_of(const LegEnd& first, const LegEnd& second, RunControl& control, const Seen& seen) {
    const Model model = testing::ball_between_walls(0.5);
    const Simulation simulation(System(model), {}, {}, {});
    Trajectory trajectory(simulation, {}, borrowed(control));
    trajectory.start(model.initial_state(), 0, 0, 1e3);
    JetSet jets(simulation, LaneKind::single);
    control.begin(first, 0, false);
    run(trajectory, jets);
    trajectory.extend(1e3);
    control.begin(second, trajectory.time(), true);
    run(trajectory, jets);
    return seen.times;
}

TEST(RunControl, CountsSelectedContactsAndShowsOnlyTheirLeg) {
    Seen seen;
    RunControl control(borrowed(seen), std::nullopt, {true, false}); // contacts at the left wall count
    LegEnd first, second;
    first.contacts = 2;
    second.contacts = 3;
    double most = 0;
    control.tell([&](std::optional<double> fraction, double) { most = std::max(most, fraction.value_or(0)); });
    const std::vector<double> times = contacts_of(first, second, control, seen);
    ASSERT_EQ(times.size(), 6U); // three at the left, each preceded by one at the right
    EXPECT_NEAR(times.front(), 2.25, 1e-12);
    EXPECT_NEAR(times.back(), 4.75, 1e-12);
    EXPECT_EQ(most, 1);
}

TEST(RunControl, EndsOnRequest) {
    Seen seen;
    RunControl control(borrowed(seen), std::nullopt, {true, true});
    LegEnd first;
    first.contacts = 1;
    control.end_when([&] { return seen.times.size() >= 4; });
    EXPECT_EQ(contacts_of(first, {}, control, seen).size(), 4U);
}

} // namespace graze::run_control_test
