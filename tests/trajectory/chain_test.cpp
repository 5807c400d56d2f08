// Models of many oscillators, each with its own wall.

#include "model/chain.hpp"

#include "graze/trajectory/trajectory.hpp"

#include <gtest/gtest.h>

namespace graze::chain_test {

constexpr double tolerance = 1e-12;

/// Records the contacts of a trajectory by event.
class ContactTimes : public Observer {
public:
    explicit ContactTimes(std::size_t events) : of_event(events) {}
    void contact(const Contact& contact) override {
        of_event[contact.event].push_back(contact.time);
        ++count;
    }
    std::vector<std::vector<double>> of_event;
    std::size_t count = 0;
};

struct Motion {
    std::vector<double> state;
    ContactTimes contacts;
};

Motion motion_of(const Model& model, double end) {
    const Simulation simulation(System(model), {}, {}, {.tolerance = tolerance});
    Motion motion{{}, ContactTimes(model.events.size())};
    JetSet jets(simulation, LaneKind::single);
    Trajectory trajectory(simulation, model.parameter_values(), borrowed(motion.contacts));
    trajectory.start(model.initial_state(), 0, 0, end);
    run(trajectory, jets);
    EXPECT_EQ(trajectory.outcome().ending, Ending::end_time) << trajectory.outcome().detail;
    motion.state.assign(trajectory.state().begin(), trajectory.state().end());
    return motion;
}

/// Returns the initial state of an oscillator of an uncoupled chain; each meets its wall after a different time.
double start_of(std::size_t i, std::size_t n) {
    return -1.6 - static_cast<double>(i) / static_cast<double>(n);
}

/// Without coupling each oscillator moves as it does alone, unaffected by the other walls.
void expect_uncoupled_as_alone(std::size_t n, std::size_t compared_every, double end) {
    Model model = testing::chain(n, 0);
    for (std::size_t i = 0; i < n; ++i)
        model.set_initial("x" + std::to_string(i + 1), start_of(i, n));
    const Motion together = motion_of(model, end);
    EXPECT_GE(together.contacts.count, n / 2);
    for (std::size_t i = 0; i < n; i += compared_every) {
        Model one = testing::chain(1, 0);
        one.set_initial("x1", start_of(i, n));
        one.set_parameter("F", i == 0 ? 1 : 0);
        const Motion alone = motion_of(one, end);
        // The tolerance allows for errors of steps of both; impacts dissipate energy and amplify errors little.
        constexpr double allowed = 1e3 * tolerance;
        EXPECT_NEAR(together.state[2 * i], alone.state[0], allowed) << i;
        EXPECT_NEAR(together.state[2 * i + 1], alone.state[1], allowed) << i;
        const auto &times = together.contacts.of_event[i], &own = alone.contacts.of_event[0];
        ASSERT_EQ(times.size(), own.size()) << i;
        for (std::size_t k = 0; k < times.size(); ++k)
            EXPECT_NEAR(times[k], own[k], allowed) << i;
    }
}

TEST(Chains, UncoupledOscillatorsMoveAsTheyDoAlone) {
    expect_uncoupled_as_alone(40, 1, 20);
}

TEST(Chains, OfAThousandOscillatorsEqualAShorterChainNearTheForce) {
    // The chain is forced at one end; far from the other end, a shorter chain has the same contacts to round-off.
    const double end = 2 * std::numbers::pi / 0.9;
    const Motion few = motion_of(testing::chain(40), end), many = motion_of(testing::chain(1000), end);
    EXPECT_GT(few.contacts.count, 0u);
    ASSERT_EQ(many.contacts.count, few.contacts.count);
    for (std::size_t i = 0; i < 20; ++i) { // the others are affected by the end of the shorter chain
        EXPECT_NEAR(many.state[i], few.state[i], 1e3 * tolerance) << i;
        const auto &times = many.contacts.of_event[i], &others = few.contacts.of_event[i];
        ASSERT_EQ(times.size(), others.size());
        for (std::size_t k = 0; k < times.size(); ++k)
            EXPECT_NEAR(times[k], others[k], 1e3 * tolerance);
    }
}

TEST(ChainsSlow, AThousandUncoupledOscillatorsMoveAsTheyDoAlone) {
    expect_uncoupled_as_alone(1000, 50, 4);
}

/// Derivatives through impacts, against differences.
TEST(Chains, DerivativesThroughImpactsAgreeWithDifferences) {
    constexpr std::size_t n = 6;
    const double end = 2 * std::numbers::pi / 0.9;
    const Model model = testing::chain(n);
    const Simulation simulation(System(model), {}, {}, {.tolerance = tolerance});
    JetSet jets(simulation, LaneKind::single);
    ContactTimes contacts(n);
    Trajectory trajectory(simulation, model.parameter_values(), borrowed(contacts));
    trajectory.start(model.initial_state(), 0, 0, end);
    trajectory.carry_derivatives({"F", "v1"});
    run(trajectory, jets);
    ASSERT_GT(contacts.count, 1u);
    ASSERT_TRUE(trajectory.tangents_valid());
    constexpr double h = 1e-6;
    const auto moved = [&](double force, double speed) {
        Model other = model;
        other.set_parameter("F", 1 + force);
        other.set_initial("v1", speed);
        return motion_of(other, end).state;
    };
    const auto more = moved(h, 0), less = moved(-h, 0), faster = moved(0, h), slower = moved(0, -h);
    for (std::size_t i = 0; i < 2 * n; ++i) {
        // Differences have errors of the second derivatives times h^2, and of round-off over h.
        EXPECT_NEAR(trajectory.derivative(i, 0), (more[i] - less[i]) / (2 * h), 1e-5) << i;
        EXPECT_NEAR(trajectory.derivative(i, 1), (faster[i] - slower[i]) / (2 * h), 1e-5) << i;
    }
}

} // namespace graze::chain_test
