#include "flow/uniformised_flow.hpp"

#include "graze/flow/mode_flow.hpp"
#include "graze/flow/second_order_flow.hpp"
#include "graze/model/model_file.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

namespace graze::uniformised_flow_test {

/// A unit mass that meets an elastic law.
Model bouncer(const std::string& force) {
    return parse_model("parameters = { k = 50, c = 0.4 }\n"
                       "states = { x = 0, v = 1 }\n"
                       "modes.contact = { rates = { x = 'v', v = '-k*" +
                           force +
                           "' }, watch = ['loss'] }\n"
                           "modes.flight = { rates = { x = 'v', v = '0' } }\n"
                           "events = { loss = 'x' }\n"
                           "transitions = [{ mode = 'contact', event = 'loss', next = 'flight' }]\n"
                           "initial = { mode = 'contact' }\n",
                       "bouncer.toml");
}

/// The duration of a contact with the force k d^p that begins at speed v (Johnson 1985, section 11.4, for p = 3/2):
/// with d = D u, where D is the largest depth, it is 2 D/v times the integral of 1/sqrt(1 - u^(p + 1)) over [0, 1].
double duration(double p, double k, double v) {
    const double n = p + 1, depth = std::pow(n * v * v / (2 * k), 1 / n);
    return 2 * depth / v * std::sqrt(std::acos(-1.0)) * std::tgamma(1 + 1 / n) / std::tgamma(0.5 + 1 / n);
}

struct Law {
    const char* text;
    double power;
};

constexpr Law laws[] = {{"x^1.5", 1.5}, {"sqrt(x)", 0.5}, {"x^(1/3)", 1.0 / 3}, {"x^2.5", 2.5}, {"x^1.25", 1.25}};

TEST(UniformisedFlow, PassesAContactInClosedFormWithItsDerivatives) {
    for (const Law& law : laws) {
        ModeFlow flow(System(bouncer(law.text)), 1e-15, 0, {ParameterId(0)});
        for (const double v : {1.0, 0.01}) {
            const double k = 50, whole = duration(law.power, k, v), p = law.power;
            flow.set_parameters(std::vector{k, 0.4});
            std::vector<double> state{0, v}, derivatives(2 * 3);
            const std::size_t before = flow.steps();
            ASSERT_EQ(flow.run(0, state, whole, derivatives), ModeFlow::Ending::done) << law.text;
            EXPECT_LE(flow.steps() - before, 40u) << law.text;
            EXPECT_NEAR(state[0], 0, 1e-13 * v * whole) << law.text;
            EXPECT_NEAR(state[1], -v, 1e-13 * v) << law.text;
            // The speed of the exit is that of the entry; the duration T is proportional to v^((1-p)/(1+p))
            // k^(-1/(1+p)).
            const std::vector<double> exact{-1, (1 - p) / (1 + p) * whole, -v * whole / (1 + p) / k, 0, -1, 0};
            const std::vector<double> sizes{1, whole, v * whole / k, 1 / whole, 1, v / k};
            // Beside the zero derivatives vary as its distance to the power p, for p < 1: so does the effect of
            // round-off.
            const double accuracy = 3e-11 + 10 * std::pow(1e-16, std::min(p, 1.0));
            for (std::size_t i = 0; i < exact.size(); ++i)
                EXPECT_NEAR(derivatives[i] / sizes[i], exact[i] / sizes[i], accuracy)
                    << law.text << ' ' << i << ' ' << v;
        }
    }
}

TEST(UniformisedFlow, FollowsExponentsWithoutACommonFraction) {
    for (const char* force : {"x^c", "x^pi", "x^(c/2)"}) {
        const double p = force == std::string("x^c") ? 2.3 : force == std::string("x^pi") ? std::acos(-1.0) : 1.15;
        ModeFlow flow(System(bouncer(force)), 1e-15, 0, {ParameterId(0), ParameterId(1)});
        flow.set_parameters(std::vector{50.0, 2.3});
        const double whole = duration(p, 50, 1);
        std::vector<double> state{0, 1}, derivatives(2 * 4);
        ASSERT_EQ(flow.run(0, state, whole, derivatives), ModeFlow::Ending::done) << force;
        EXPECT_LE(flow.steps(), 250u) << force;
        EXPECT_NEAR(state[0], 0, 1e-12 * whole) << force;
        EXPECT_NEAR(state[1], -1, 1e-12) << force;
        EXPECT_NEAR(derivatives[1], (1 - p) / (1 + p) * whole, 1e-9 * whole) << force;
        EXPECT_NEAR(derivatives[2], -whole / (1 + p) / 50, 1e-9 * whole / 50) << force;
        if (force == std::string("x^c")) {
            const double by_exponent = (duration(p + 1e-5, 50, 1) - duration(p - 1e-5, 50, 1)) / 2e-5;
            EXPECT_NEAR(derivatives[3], by_exponent, 1e-8) << force; // the body returns later at unit speed
        }
    }
}

TEST(UniformisedFlow, PassesTheZeroFromEitherSideForwardsAndBackwards) {
    // Beyond the zero nothing acts: the times outside are known, and so is the way back.
    const double v = 1.3, whole = duration(1.5, 50, v);
    ModeFlow flow(System(bouncer("x^1.5")), 1e-15, 0, {ParameterId(0)});
    flow.set_parameters(std::vector{50.0, 0.4});
    for (const double before : {1e-16, 1e-12, 1e-7, 0.3}) {
        std::vector<double> state{-before * v, v}, derivatives(2 * 3);
        ASSERT_EQ(flow.run(0, state, before + whole + 0.2, derivatives), ModeFlow::Ending::done) << before;
        EXPECT_NEAR(state[0], -0.2 * v, 1e-13) << before;
        EXPECT_NEAR(state[1], -v, 1e-13) << before;
        // x = -v (t - whole(v)) + x_0 is to be differentiated.
        EXPECT_NEAR(derivatives[0], -1, 1e-10) << before;
        EXPECT_NEAR(derivatives[1], -(before + 0.2) - whole / 5, 1e-10) << before;
        EXPECT_NEAR(derivatives[2], -v * whole * 0.4 / 50, 1e-10) << before;
        EXPECT_NEAR(derivatives[4], -1, 1e-10) << before;
        ASSERT_EQ(flow.run(0, state, -(before + whole + 0.2)), ModeFlow::Ending::done) << before;
        EXPECT_NEAR(state[0], -before * v, 1e-13) << before;
        EXPECT_NEAR(state[1], v, 1e-13) << before;
    }
    for (const double share : {1e-14, 1e-9, 1e-4, 0.3, 0.9999, 1 - 1e-9}) { // in two parts, of which one is short
        std::vector<double> state{0, v}, first(2 * 3), second(2 * 3);
        ASSERT_EQ(flow.run(0, state, share * whole, first), ModeFlow::Ending::done) << share;
        ASSERT_EQ(flow.run(0, state, (1 - share) * whole, second), ModeFlow::Ending::done) << share;
        EXPECT_NEAR(state[0], 0, 1e-13) << share;
        EXPECT_NEAR(state[1], -v, 1e-13) << share;
        EXPECT_NEAR(second[0] * first[1] + second[1] * first[4], -whole / 5, 1e-9) << share;
    }
}

TEST(UniformisedFlow, ShowsStepsInTimeFromZeroToZero) {
    const double v = 1.3, whole = duration(1.5, 50, v), deepest = std::pow(2.5 * v * v / 100, 0.4);
    ModeFlow flow(System(bouncer("x^1.5")), 1e-13);
    flow.set_parameters(std::vector{50.0, 0.4});
    std::vector<double> state{0, v};
    double reached = 0, most = 0;
    const auto visit = [&](const Jet& jet, double time, double length) {
        EXPECT_NEAR(time, reached, 1e-15);
        for (int i = 0; i < 20; ++i)
            most = std::max(
                most, evaluate_polynomial(jet.series()[0], static_cast<std::size_t>(jet.order()) + 1, length * i / 20));
        reached = time + length;
    };
    ASSERT_EQ(flow.run(0, state, whole, visit), ModeFlow::Ending::done);
    EXPECT_NEAR(reached, whole, 1e-9 * whole);
    EXPECT_NEAR(most, deepest, 1e-3 * deepest);
    WatchedSeries watched;
    std::vector<double> again{0, v}, derivatives(2 * 2);
    ASSERT_EQ(flow.run(0, again, whole, derivatives, &watched), ModeFlow::Ending::done);
    EXPECT_EQ(watched.steps().front().time, 0);
    EXPECT_NEAR(watched.steps().back().time + watched.steps().back().length, whole, 1e-9 * whole);
}

TEST(UniformisedFlow, HasSecondDerivatives) {
    // x = -v (t - whole(v)) at a time after the contact, with whole proportional to v^(-1/5).
    const double v = 1.3, k = 50, whole = duration(1.5, k, v), time = whole + 0.1;
    SecondOrderFlow flow(VariationalSystem(System(bouncer("x^1.5")), {ParameterId(0)}), 1e-14);
    flow.set_parameters(std::vector{k, 0.4});
    std::vector<double> state{0, v}, derivatives(2 * 3), second(2 * 3);
    const std::vector<double> along{0, 1, 0}; // the initial speed
    ASSERT_EQ(flow.run(0, state, time, along, derivatives, second), ModeFlow::Ending::done);
    EXPECT_NEAR(derivatives[1], -0.1 - whole / 5, 1e-10);
    EXPECT_NEAR(second[1], -0.16 * whole / v, 1e-9); // of -(t - 4/5 whole) by v
    EXPECT_NEAR(second[2], -0.32 * whole / k, 1e-9); // and by k, of which whole is the power -2/5
    EXPECT_NEAR(second[3 + 1], 0, 1e-9);
}

TEST(UniformisedFlow, AgreesWithQuadraticDampingInClosedForm) {
    // Hunt and Crossley's law k x^1.5 (1 + c v): v dv/(1 + c v) = -k x^1.5 dx, so that with w = c v
    // w - log(1 + w) is the same at the beginning and at the end.
    ModeFlow flow(System(bouncer("x^1.5*(1 + c*v)")), 1e-15);
    flow.set_parameters(std::vector{50.0, 0.4});
    std::vector<double> state{0, 1};
    double low = 0, high = 1; // the time of the exit by bisection
    for (int i = 0; i < 60; ++i) {
        const double middle = 0.5 * (low + high);
        std::vector<double> there{0, 1};
        ASSERT_EQ(flow.run(0, there, middle), ModeFlow::Ending::done);
        (there[0] > 0 ? low : high) = middle;
    }
    ASSERT_EQ(flow.run(0, state, 0.5 * (low + high)), ModeFlow::Ending::done);
    const double in = 0.4, out = 0.4 * state[1];
    EXPECT_LT(out, 0);
    EXPECT_NEAR(out - std::log1p(out), in - std::log1p(in), 1e-14);
}

TEST(UniformisedFlow, BeginsWithoutSpeedWherePressed) {
    // Gravity presses the body into the support, and back to where it came from: the time is an integral of energy,
    // 2 times that of dx/sqrt(2 (x - 0.4 k x^2.5)) from 0 to X = (2.5/k)^(2/3), with x = X u^2.
    ModeFlow flow(System(bouncer("(x^1.5 - 1/k)")), 1e-14);
    flow.set_parameters(std::vector{50.0, 0.4});
    const double deepest = std::pow(2.5 / 50, 2.0 / 3), n = 1.5;
    double integral = 0; // of 2/sqrt(1 - u^3) over [0, 1]: a beta function
    integral = 2.0 / (2 * n) * std::tgamma(1 / (2 * n)) * std::tgamma(0.5) / std::tgamma(1 / (2 * n) + 0.5);
    const double whole = 2 * std::sqrt(deepest / 2) * integral;
    std::vector<double> state{0, 0}, derivatives(2 * 2);
    ASSERT_EQ(flow.run(0, state, 0.5 * whole, derivatives), ModeFlow::Ending::done);
    EXPECT_NEAR(state[0], deepest, 1e-12);
    EXPECT_NEAR(state[1], 0, 1e-9);
}

} // namespace graze::uniformised_flow_test
