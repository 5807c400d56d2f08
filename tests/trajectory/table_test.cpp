// Tables in the equations: steps end at their points, and nothing else shows there.

#include "closed_form.hpp"
#include "graze/flow/mode_flow.hpp"
#include "graze/trajectory/ensemble.hpp"
#include "simulate.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

using namespace graze;
using namespace graze::testing;

namespace table_test {

/// A mass on a spring of slope 1, and k beyond 1. The event is at a point of the table.
Model stiffening() {
    return model_from("states = { x = 2, v = 0 }\n"
                      "modes.free = { rates = { x = 'v', v = '-f(x)' }, watch = ['out'] }\n"
                      "events.out = { function = '1 - x', kind = 'section' }\n"
                      "transitions = [{ mode = 'free', event = 'out', next = 'free' }]\n"
                      "tables.f = { points = [[-1, -1], [0, 0], [1, 1], [2, 3]], outside = 'linear' }\n");
}

/// Its period, and the derivative of that with respect to the amplitude 0.5 + a.
std::pair<double, double> period(double a) {
    const double outer = std::acos(0.5 / a) / std::sqrt(2.0), v = std::sqrt(2 * (a * a - 0.25)),
                 inner = std::atan(1 / v), outer_rate = 0.5 / (a * a) / std::sqrt(1 - 0.25 / (a * a)) / std::sqrt(2.0),
                 inner_rate = -2 * a / v / (v * v + 1);
    return {2 * (outer + inner) + std::acos(-1.0), 2 * (outer_rate + inner_rate)};
}

TEST(Table, AMeasuredSpringReturnsAfterItsPeriod) {
    Experiment experiment(stiffening());
    const auto [duration, rate] = period(1.5);
    experiment.trajectory.start(std::vector{2.0, 0.0}, 0, 0, 10 * duration);
    experiment.trajectory.carry_derivatives(std::vector<std::string>{"x", "v"});
    run(experiment.trajectory, experiment.jets);
    ASSERT_EQ(experiment.trajectory.outcome().ending, Ending::end_time) << experiment.trajectory.outcome().detail;
    EXPECT_NEAR(experiment.state()[0], 2, 1e-12);
    EXPECT_NEAR(experiment.state()[1], 0, 1e-11);
    EXPECT_TRUE(experiment.trajectory.tangents_valid());
    EXPECT_NEAR(experiment.trajectory.derivative(0, 0), 1, 1e-10);
    EXPECT_NEAR(experiment.trajectory.derivative(1, 0), 30 * rate, 1e-9);
    EXPECT_NEAR(experiment.trajectory.derivative(0, 1), 0, 1e-10);
    EXPECT_NEAR(experiment.trajectory.derivative(1, 1), 1, 1e-10);
}

/// A point at zero is passed as exactly as another, and by as few steps.
TEST(Table, APointAtZeroIsPassedLikeAnother) {
    std::size_t steps[2];
    for (const int at_zero : {0, 1}) {
        const double knot = at_zero == 1 ? 0 : 0.3;
        Experiment experiment(model_from(fmt::format("states = {{ x = 0, v = 1, y = 0 }}\n"
                                                     "modes.free = {{ rates = {{ x = 'v', v = '-x', y = 'f(x)' }} }}\n"
                                                     "tables.f = {{ points = [[{}, {}], [{}, 2], [{}, 0]], "
                                                     "outside = 'linear' }}\n",
                                                     knot - 2, -4, knot, knot + 2)),
                              with_tolerance(1e-15));
        // f = 2 - (x - knot) above and 2 + 3 (x - knot) below, where x = sin(t) is from asin(knot) to pi - asin(knot).
        const double pi = std::acos(-1.0), begin = std::asin(knot), end = pi - begin, last = 4;
        const auto integral = [&](double slope, double from, double to) {
            return (2 - slope * knot) * (to - from) + slope * (std::cos(from) - std::cos(to));
        };
        ASSERT_EQ(experiment.run(last).ending, Ending::end_time) << experiment.trajectory.outcome().detail;
        EXPECT_NEAR(experiment.state()[2], integral(3, 0, begin) + integral(-1, begin, end) + integral(3, end, last),
                    2e-14)
            << knot;
        steps[at_zero] = experiment.trajectory.steps();
    }
    EXPECT_LE(steps[1], steps[0] + 4);
}

/// A steep table within another one, with a point exactly at zero, where its argument changes sign again and again.
TEST(Table, APointAtZeroMayBeWithinAnotherTable) {
    const auto model = [](double shift) {
        return model_from(fmt::format(
            "states = {{ x = 1, v = 0, c = {{ initial = 0, period = 2.5 }} }}\n"
            "modes.m = {{ rates = {{ x = 'v', v = '-spring(x - 0.5*third(v + {0})) - 0.2*v + 3*cos(2.513274*c)', "
            "c = 1 }} }}\n"
            "tables.third.points = [[{0}, 0.59], [{1}, -0.67], [{2}, 0.78], [{3}, -1]]\n"
            "tables.spring.points = [[-1, -2.7], [0.7, 2.6], [1, 2.5]]\n",
            shift, shift + 0.03, shift + 0.15, shift + 1));
    };
    // The same table elsewhere: its points are those of a shifted argument.
    Experiment zero(model(0)), shifted(model(0.5));
    ASSERT_EQ(zero.run(20).ending, Ending::end_time) << zero.trajectory.outcome().detail;
    ASSERT_EQ(shifted.run(20).ending, Ending::end_time) << shifted.trajectory.outcome().detail;
    for (std::size_t i = 0; i < 2; ++i)
        EXPECT_NEAR(zero.state()[i], shifted.state()[i], 1e-9);
}

TEST(Table, AnEventAtAPointHappensOnce) {
    Experiment experiment(stiffening());
    const double duration = period(1.5).first;
    ASSERT_EQ(experiment.run(20 * duration).ending, Ending::end_time);
    EXPECT_EQ(experiment.recorder.contacts().size(), 20u);
    EXPECT_LT(experiment.trajectory.steps(), 20u * 60u);
}

TEST(Table, ARecordedForceActsAsInClosedForm) {
    for (const std::string interpolation : {"linear", "cubic"}) {
        Experiment experiment(
            model_from("states = { x = 1, v = 0, s = 0 }\n"
                       "modes.free = { rates = { x = 'v', v = 'f(s) - 1.3*x - 0.1*v', s = 1 } }\n"
                       "tables.f = { points = [[0, 0.2], [0.5, 1], [1.3, -0.5], [2, 0.4], [3.1, 0.9], [4, -0.3]], "
                       "interpolation = '" +
                       interpolation + "' }\n"),
            with_tolerance(1e-15));
        ASSERT_EQ(experiment.run(4).ending, Ending::end_time);
        ModeFlow flow(experiment.simulation.system(), 1e-15);
        flow.set_parameters({});
        std::vector<double> expected{1, 0, 0};
        ASSERT_EQ(flow.run(0, expected, 4), ModeFlow::Ending::done);
        if (interpolation == "linear") // mpmath: matrix exponentials of the pieces
            expected = {0.27349183735536312, 0.88146197797497779, 4};
        for (std::size_t i = 0; i < 3; ++i)
            EXPECT_NEAR(experiment.state()[i], expected[i], 1e-13);
    }
}

TEST(Table, BeyondTheEndOfARecordAMotionMayEnd) {
    Experiment experiment(model_from("states = { x = 1, s = 0 }\n"
                                     "modes.free = { rates = { x = 'f(s) - x', s = 1 } }\n"
                                     "tables.f = { points = [[0, 0], [1, 2], [2, 1]], outside = 'error' }\n"));
    EXPECT_EQ(experiment.run(2).ending, Ending::end_time);
    const Outcome& outcome = experiment.run(3);
    EXPECT_EQ(outcome.ending, Ending::undefined);
    EXPECT_NEAR(outcome.time, 2, 1e-9);
}

TEST(Table, MotionsInLanesEqualSeparateRuns) {
    const Simulation simulation{System(stiffening())};
    std::vector<Trajectory> together, alone;
    for (int i = 0; i < 17; ++i)
        for (auto* trajectories : {&together, &alone}) {
            trajectories->emplace_back(simulation, std::vector<double>{});
            trajectories->back().start(std::vector{-2 + 0.3 * i, 0.1 * i}, 0, 0, 20 + i);
        }
    Ensemble(simulation, best_instruction_set()).run(together);
    for (std::size_t i = 0; i < together.size(); ++i) {
        run(alone[i]);
        for (std::size_t k = 0; k < 2; ++k)
            EXPECT_NEAR(together[i].state()[k], alone[i].state()[k], 1e-11) << i;
        EXPECT_EQ(together[i].outcome().ending, Ending::end_time);
    }
}

TEST(Table, AMotionMayCrossManyPoints) {
    // The table of a straight line acts as the line.
    std::string points;
    for (int i = 0; i <= 2000; ++i)
        points += fmt::format("[{}, {}], ", 0.01 * i - 10, 2 * (0.01 * i - 10));
    Experiment experiment(model_from("states = { x = 1.003, v = 0 }\n"
                                     "modes.free = { rates = { x = 'v', v = '-f(x)' } }\n"
                                     "tables.f.points = [" +
                                     points + "]\n"));
    ASSERT_EQ(experiment.run(10).ending, Ending::end_time);
    EXPECT_NEAR(experiment.state()[0], 1.003 * std::cos(10 * std::sqrt(2.0)), 1e-11);
}

/// Returns a table of random points with uneven distances from -3 to 3.
std::string random_table(Random& random) {
    const bool periodic = random.chance(0.4);
    std::string points;
    double x = -3;
    const double first = random.uniform(-1, 1);
    points += fmt::format("[{}, {}], ", x, first);
    for (x += random.uniform(0.01, 1.5); x < 2.9; x += random.uniform(0.01, 1.5))
        points += fmt::format("[{}, {}], ", x, random.uniform(-1, 1));
    points += fmt::format("[3, {}]", periodic ? first : random.uniform(-1, 1));
    return fmt::format("points = [{}], interpolation = '{}'{}", points, random.chance(0.5) ? "linear" : "cubic",
                       periodic             ? ", periodic = true"
                       : random.chance(0.5) ? ", outside = 'linear'"
                                            : "");
}

TEST(Table, TrajectoriesAndFlowsOfRandomTablesAgreeAndReturn) {
    Random random(7);
    for (int i = 0; i < 60; ++i) {
        const char* rates[] = {"f(s) - 2*x + 0.3*g(x + v)", "f(x) - 2*x - 0.1*g(s)*v",
                               "f(2*sin(x) + sin(v)) - 3*x + g(2*s)", "f(g(x) + s) - x^3",
                               "f(-1.7*x + 0.2) + g(sin(s)) - 2*x"};
        const std::string text = fmt::format("states = {{ x = 0.3, v = 0.5, s = 0 }}\n"
                                             "modes.free = {{ rates = {{ x = 'v', v = '{}', s = 1 }} }}\n"
                                             "tables.f = {{ {} }}\ntables.g = {{ {} }}\n",
                                             rates[i % 5], random_table(random), random_table(random));
        SCOPED_TRACE(text);
        const std::vector<double> start{random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-4, 4)};
        Experiment experiment(model_from(text), with_tolerance(1e-15));
        ASSERT_EQ(experiment.run_from(start, 0, 5).ending, Ending::end_time) << experiment.trajectory.outcome().detail;
        ModeFlow flow(experiment.simulation.system(), 1e-15);
        flow.set_parameters({});
        std::vector<double> state = start, derivatives(9);
        ASSERT_EQ(flow.run(0, state, 5, derivatives), ModeFlow::Ending::done);
        experiment.trajectory.start(start, 0, 0, 5);
        experiment.trajectory.carry_derivatives(std::vector<std::string>{"x", "v", "s"});
        run(experiment.trajectory, experiment.jets);
        EXPECT_TRUE(experiment.trajectory.tangents_valid());
        for (std::size_t k = 0; k < 3; ++k) {
            EXPECT_NEAR(experiment.state()[k], state[k], 1e-11 * (1 + std::abs(state[k])));
            for (std::size_t d = 0; d < 3; ++d)
                EXPECT_NEAR(experiment.trajectory.derivative(k, d), derivatives[3 * k + d],
                            1e-9 * (1 + std::abs(derivatives[3 * k + d])));
        }
        ASSERT_EQ(flow.run(0, state, -5, derivatives), ModeFlow::Ending::done);
        double growth = 0;
        for (const double derivative : derivatives)
            growth = std::max(growth, std::abs(derivative));
        for (std::size_t k = 0; k < 3; ++k)
            EXPECT_NEAR(state[k], start[k], 1e-11 * (1 + growth));
        EXPECT_LT(flow.steps(), 10000u);
    }
}

TEST(Table, ClocksMayBeFarFromZero) {
    // The time of a record in seconds since 1970, whose round-off is 2e-7.
    const double begin = 1.7e9;
    std::string points, near;
    for (const auto& [s, f] : {std::pair(0.0, 0.2), std::pair(0.5, 1.0), std::pair(1.25, -0.5), std::pair(4.0, 0.4)}) {
        points += fmt::format("[{}, {}], ", begin + s, f);
        near += fmt::format("[{}, {}], ", s, f);
    }
    const char* text = "states = {{ x = 1, v = 0, s = {} }}\n"
                       "modes.free = {{ rates = {{ x = 'v', v = 'f(s) - x', s = 1 }} }}\n"
                       "tables.f = {{ points = [{}], outside = 'error' }}\n";
    Experiment far(model_from(fmt::format(fmt::runtime(text), begin, points))),
        other(model_from(fmt::format(fmt::runtime(text), 0, near)));
    ASSERT_EQ(far.run(4).ending, Ending::end_time);
    ASSERT_EQ(other.run(4).ending, Ending::end_time);
    EXPECT_NEAR(far.state()[0], other.state()[0], 1e-5);
    EXPECT_LT(far.trajectory.steps(), 100u);
}

} // namespace table_test
