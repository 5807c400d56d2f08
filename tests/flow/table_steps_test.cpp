#include "graze/flow/mode_flow.hpp"
#include "graze/model/model_file.hpp"
#include "graze/symbolic/piece_table.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

namespace graze::table_steps_test {

/// A damped oscillator under a force that is recorded over the time s.
Model driven(const std::string& table) {
    return parse_model("parameters = { k = 1.3, c = 0.1 }\n"
                       "states = { x = 1, v = 0, s = 0 }\n"
                       "modes.free = { rates = { x = 'v', v = 'f(s) - k*x - c*v', s = 1 } }\n"
                       "tables.f = { " +
                           table + " }\n",
                       "driven.toml");
}

const std::string uneven = "points = [[0, 0.2], [0.5, 1], [1.3, -0.5], [2, 0.4], [3.1, 0.9], [4, -0.3]]";

/// A mass on a spring of slope 1, and 2 beyond 1.
Model stiffening() {
    return parse_model("states = { x = 2, v = 0 }\n"
                       "modes.free = { rates = { x = 'v', v = '-f(x)' } }\n"
                       "tables.f = { points = [[-1, -1], [0, 0], [1, 1], [2, 3]], outside = 'linear' }\n",
                       "spring.toml");
}

/// Returns the state after a duration, and checks its derivatives against differences.
std::vector<double> checked_run(ModeFlow& flow, std::vector<double> start, std::vector<double> parameters,
                                double duration, double accuracy) {
    const std::size_t states = start.size(), inputs = states + parameters.size();
    std::vector<double> end = start, derivatives(states * inputs);
    flow.set_parameters(parameters);
    EXPECT_EQ(flow.run(0, end, duration, derivatives), ModeFlow::Ending::done);
    std::vector<double> plain = start;
    EXPECT_EQ(flow.run(0, plain, duration), ModeFlow::Ending::done);
    for (std::size_t i = 0; i < states; ++i)
        EXPECT_NEAR(plain[i], end[i], 1e-12);
    const double step = 1e-5;
    for (std::size_t j = 0; j < inputs; ++j) {
        std::vector<double> sides[2];
        for (const int side : {0, 1}) {
            std::vector<double> moved = start, changed = parameters;
            (j < states ? moved[j] : changed[j - states]) += side == 0 ? -step : step;
            flow.set_parameters(changed);
            EXPECT_EQ(flow.run(0, moved, duration), ModeFlow::Ending::done);
            sides[side] = moved;
        }
        for (std::size_t i = 0; i < states; ++i)
            EXPECT_NEAR(derivatives[i * inputs + j], (sides[1][i] - sides[0][i]) / (2 * step), accuracy)
                << i << ' ' << j;
    }
    return end;
}

TEST(TableSteps, ARecordedForceActsAsInClosedForm) {
    ModeFlow flow(System(driven(uneven)), 1e-15, 0, {ParameterId(0), ParameterId(1)});
    checked_run(flow, {1, 0, 0.1}, {1.3, 0.1}, 3.7, 1e-8);
    flow.set_parameters(std::vector{1.3, 0.1});
    std::vector<double> end{1, 0, 0};
    ASSERT_EQ(flow.run(0, end, 4), ModeFlow::Ending::done);
    // The product of the matrix exponentials of the five pieces, with 40 digits (mpmath).
    EXPECT_NEAR(end[0], 0.27349183735536312, 1e-14);
    EXPECT_NEAR(end[1], 0.88146197797497779, 1e-14);
}

TEST(TableSteps, TimeMayRunBackwards) {
    for (const char* kind : {"linear", "cubic"}) {
        ModeFlow flow(System(driven(uneven + ", interpolation = '" + kind + "'")), 1e-15);
        flow.set_parameters(std::vector{1.3, 0.1});
        std::vector<double> state{1, 0, 0};
        ASSERT_EQ(flow.run(0, state, 4.7), ModeFlow::Ending::done);
        ASSERT_EQ(flow.run(0, state, -4.7), ModeFlow::Ending::done);
        EXPECT_NEAR(state[0], 1, 1e-13);
        EXPECT_NEAR(state[1], 0, 1e-13);
    }
}

/// Integrates a driven oscillator by Gauss-Legendre steps of order 6 that end at the points.
std::vector<double> integrated(const PieceTable& table, double end) {
    const double root = std::sqrt(15.0), c[3] = {0.5 - root / 10, 0.5, 0.5 + root / 10},
                 b[3] = {5 / 18.0, 8 / 18.0, 5 / 18.0};
    const double a[3][3] = {{5 / 36.0, 2 / 9.0 - root / 15, 5 / 36.0 - root / 30},
                            {5 / 36.0 + root / 24, 2 / 9.0, 5 / 36.0 - root / 24},
                            {5 / 36.0 + root / 30, 2 / 9.0 + root / 15, 5 / 36.0}};
    double x = 1, v = 0;
    for (std::size_t piece = 0; piece + 1 < table.points().size(); ++piece) {
        const double from = table.points()[piece].x, to = std::min(end, table.points()[piece + 1].x);
        const int steps = 200;
        for (int n = 0; n < steps && from < to; ++n) {
            const double h = (to - from) / steps, t = from + n * h;
            double kx[3] = {}, kv[3] = {};
            for (int sweep = 0; sweep < 30; ++sweep)
                for (int i = 0; i < 3; ++i) {
                    double xi = x, vi = v;
                    for (int j = 0; j < 3; ++j) {
                        xi += h * a[i][j] * kx[j];
                        vi += h * a[i][j] * kv[j];
                    }
                    kx[i] = vi;
                    kv[i] = table.value(t + c[i] * h, 0) - 1.3 * xi - 0.1 * vi;
                }
            for (int i = 0; i < 3; ++i) {
                x += h * b[i] * kx[i];
                v += h * b[i] * kv[i];
            }
        }
    }
    return {x, v};
}

TEST(TableSteps, ASplineActsAsInAnIndependentIntegration) {
    for (const char* more : {", interpolation = 'cubic'", ", interpolation = 'cubic', outside = 'linear'"}) {
        const Model model = driven(uneven + more);
        ModeFlow flow(System(model), 1e-15, 0, {ParameterId(0), ParameterId(1)});
        checked_run(flow, {1, 0, 0.1}, {1.3, 0.1}, 3.7, 1e-8);
        flow.set_parameters(std::vector{1.3, 0.1});
        std::vector<double> end{1, 0, 0};
        ASSERT_EQ(flow.run(0, end, 4), ModeFlow::Ending::done);
        const std::vector<double> expected = integrated(*model.graph->tables().front(), 4);
        EXPECT_NEAR(end[0], expected[0], 1e-12);
        EXPECT_NEAR(end[1], expected[1], 1e-12);
    }
}

TEST(TableSteps, APolynomialInPiecesActsAsAWhole) {
    const char* text = "states = { x = 1, v = 0 }\n"
                       "modes.free = { rates = { x = 'v', v = '1 - 2*x' } }\n";
    const std::string pieces = "states = { x = 1, v = 0 }\n"
                               "modes.free = { rates = { x = 'v', v = 'f(x)' } }\n"
                               "tables.f = { points = [[-1, 3], [0, 1], [0.25, 0.5], [0.75, -0.5], [2, -3]]";
    ModeFlow one(System(parse_model(text, "")), 1e-15), many(System(parse_model(pieces + " }", "")), 1e-15);
    std::vector<double> first{1, 0}, second{1, 0}, of_first(4), of_second(4);
    one.set_parameters({});
    many.set_parameters({});
    ASSERT_EQ(one.run(0, first, 3, of_first), ModeFlow::Ending::done);
    ASSERT_EQ(many.run(0, second, 3, of_second), ModeFlow::Ending::done);
    for (std::size_t i = 0; i < 2; ++i)
        EXPECT_NEAR(first[i], second[i], 2e-15);
    for (std::size_t i = 0; i < 4; ++i)
        EXPECT_NEAR(of_first[i], of_second[i], 1e-14);
}

TEST(TableSteps, AMeasuredSpringHasThePeriodOfItsQuarters) {
    ModeFlow flow(System(stiffening()), 1e-15);
    flow.set_parameters({});
    // Inner parts have the slope 1, the outer one on the right 2; on the left the force goes on with slope 1.
    const double a = 1.5, outer = std::acos(0.5 / a) / std::sqrt(2.0), v = std::sqrt(2 * (a * a - 0.25)),
                 inner = std::atan(1 / v), left = std::acos(-1.0), period = 2 * (outer + inner) + left;
    const double outer_rate = 0.5 / (a * a) / std::sqrt(1 - 0.25 / (a * a)) / std::sqrt(2.0), v_rate = 2 * a / v,
                 inner_rate = -v_rate / (v * v + 1), period_rate = 2 * (outer_rate + inner_rate);
    std::vector<double> state{2, 0}, derivatives(4);
    ASSERT_EQ(flow.run(0, state, period, derivatives), ModeFlow::Ending::done);
    EXPECT_NEAR(state[0], 2, 1e-14);
    EXPECT_NEAR(state[1], 0, 1e-13);
    // A motion with another amplitude comes back later: v = -x'' T'(x) dx, where x'' = -3.
    const double expected[] = {1, 0, 3 * period_rate, 1};
    for (std::size_t i = 0; i < 4; ++i)
        EXPECT_NEAR(derivatives[i], expected[i], 1e-12) << i;
    EXPECT_LT(flow.steps(), 100u);
    checked_run(flow, {1.7, 0.3}, {}, 9, 1e-8);
}

TEST(TableSteps, PeriodicTablesGoOnForEver) {
    for (const char* kind : {"linear", "cubic"}) {
        const std::string options = std::string(", interpolation = '") + kind + "' }\n";
        const auto model = [&](const std::string& table) {
            return parse_model("parameters = { k = 1.3 }\n"
                               "states = { x = 1, v = 0, s = 0 }\n"
                               "modes.free = { rates = { x = 'v', v = 'f(s) - k*x - 0.1*v', s = 2 } }\n"
                               "tables.f = { points = [" +
                                   table + options,
                               "");
        };
        const std::string one = "[0, 0.2], [0.5, 1], [1.3, -0.5], [2, 0.2]";
        ModeFlow closed(System(model(one + "], periodic = true")), 1e-15, 0, {ParameterId(0)});
        const std::vector<double> start{1, 0, -3.1};
        const std::vector<double> end = checked_run(closed, start, {1.3}, 7, 1e-7);
        if (kind == std::string("cubic"))
            continue;
        std::string many;
        for (int i = -3; i < 10; ++i)
            for (const auto& [x, f] : {std::pair(0.0, 0.2), std::pair(0.5, 1.0), std::pair(1.3, -0.5)})
                many += "[" + std::to_string(2 * i + x) + ", " + std::to_string(f) + "], ";
        ModeFlow open(System(model(many + "]")), 1e-15);
        open.set_parameters(std::vector{1.3});
        std::vector<double> state = start;
        ASSERT_EQ(open.run(0, state, 7), ModeFlow::Ending::done);
        for (std::size_t i = 0; i < 3; ++i)
            EXPECT_NEAR(state[i], end[i], 1e-13);
    }
}

TEST(TableSteps, MotionsRestTouchAndEndAtKnots) {
    ModeFlow spring(System(stiffening()), 1e-15);
    spring.set_parameters({});
    std::vector<double> rest{0, 0};
    ASSERT_EQ(spring.run(0, rest, 10), ModeFlow::Ending::done);
    EXPECT_EQ(rest[0], 0);
    std::vector<double> touch{-1, 0}; // touches the knot at 1
    const double half = std::acos(-1.0);
    ASSERT_EQ(spring.run(0, touch, 2 * half), ModeFlow::Ending::done);
    EXPECT_NEAR(touch[0], -1, 1e-13);
    std::vector<double> away{1, 1e-9};
    ASSERT_EQ(spring.run(0, away, 1), ModeFlow::Ending::done);
    EXPECT_NEAR(away[0], std::cos(1.0), 1e-8);
    ModeFlow record(System(driven(uneven + ", outside = 'error'")), 1e-15);
    record.set_parameters(std::vector{1.3, 0.1});
    std::vector<double> state{1, 0, 0};
    EXPECT_EQ(record.run(0, state, 4), ModeFlow::Ending::done);
    EXPECT_NEAR(state[0], 0.27349183735536312, 1e-14);
    EXPECT_NE(record.run(0, state, 0.1), ModeFlow::Ending::done);
}

} // namespace graze::table_steps_test
