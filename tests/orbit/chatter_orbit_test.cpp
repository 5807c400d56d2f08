// Orbits with complete chatter sequences.

#include "base/message_of.hpp"
#include "graze/model/catalogue.hpp"
#include "graze/model/model_file.hpp"
#include "graze/orbit/solve.hpp"
#include "kicked_ball.hpp"
#include "orbit/accumulation.hpp"
#include "orbits.hpp"
#include "trajectory/simulate.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>
#include <vector>

namespace graze::chatter_orbit_test {

using namespace graze::testing;

TEST(ChatterSignature, IsReadAndWritten) {
    const Model model = load_model("bouncing-ball");
    const Signature signature = parse_signature(model, "impact* release impact impact* release");
    ASSERT_EQ(signature.size(), 5U);
    EXPECT_EQ(signature[0].end, SegmentEnd::chatter);
    EXPECT_EQ(signature[1].end, SegmentEnd::event);
    EXPECT_EQ(model.modes[signature[1].mode].name, "rest");
    EXPECT_EQ(to_string(model, signature), "impact* release impact impact* release");
    EXPECT_EQ(to_string(model, parse_signature(model, "(flight:impact* release)^2")), "(impact* release)^2");
    EXPECT_EQ(end_name(model, signature[0]), "impact*");
}

TEST(ChatterSignature, IsRefusedWhereTheModelDoesNotSayWhatFollows) {
    const Model ball = load_model("bouncing-ball");
    EXPECT_NE(message_of([&] { parse_signature(ball, "release*"); }).find("what follows where contacts accumulate"),
              std::string::npos);
    EXPECT_NE(message_of([&] { parse_signature(ball, "impact*^2"); }).find("'impact*' cannot follow 'impact*'"),
              std::string::npos);
    Signature signature = parse_signature(ball, "impact* release");
    signature[1].end = SegmentEnd::chatter;
    EXPECT_NE(message_of([&] { validate_signature(ball, signature); }).find("does not say what follows"),
              std::string::npos);
}

TEST(ChatterOrbit, OfAKickedBallHasItsClosedForm) {
    // Flights of 2V/g, 2eV/g, ... take 2V/(g (1 - e)); then the ball is at rest until the next kick.
    for (const double e : {0.1, 0.5, 0.9}) {
        const KickedBall ball{.e = e, .V = 10 * (1 - e) / 3};
        const Model model = ball.model();
        const auto found = orbit_with_signature(System(model), parse_signature(model, "impact* kick"));
        ASSERT_TRUE(found);
        ASSERT_EQ(found->outcome, OrbitOutcome::converged) << found->detail;
        EXPECT_TRUE(found->certificate.admissible) << found->certificate.reason;
        EXPECT_NEAR(found->orbit.durations[0], ball.chatter(), 1e-12) << e;
        EXPECT_NEAR(found->orbit.durations[1], 1 - ball.chatter(), 1e-12) << e;
        // A rest forgets the state.
        for (const auto& multiplier : found->multipliers)
            EXPECT_EQ(std::abs(multiplier), 0);
    }
}

TEST(ChatterOrbit, OfABallOnAVibratingTableAgreesWithAComputationInFortyDigits) {
    // Lift-off where the table's acceleration is -g; flights by Newton's method in 40 digits until their speed is below
    // 1e-18 m/s, and the sum of the others.
    struct Case {
        double a, accumulation;
    };
    for (const auto& [a, accumulation] : {Case{0.003, 0.0510099311428005151}, Case{0.0026, 0.02433017352567343}}) {
        const Model model = shipped_with("bouncing-ball", {{"a", a}, {"e", 0.5}});
        const OrbitSolution solution = settled(model, "phase0");
        const Orbit& orbit = solution.orbit;
        ASSERT_EQ(orbit.segments(), 2U);
        const std::size_t flight = orbit.signature[0].end == SegmentEnd::chatter ? 0 : 1;
        EXPECT_EQ(end_name(model, orbit.signature[flight]), "impact*");
        EXPECT_EQ(end_name(model, orbit.signature[1 - flight]), "release");
        EXPECT_TRUE(solution.certificate.admissible) << solution.certificate.reason;
        // Round-off of the gap over the speed of the last contacts that are resolved.
        EXPECT_NEAR(orbit.durations[flight], accumulation, 2e-12);
        EXPECT_NEAR(orbit.period(), 0.1, 1e-15);
        const double omega = 20 * std::numbers::pi;
        EXPECT_NEAR(orbit.starts[flight][2], std::asin(9.81 / (a * omega * omega)), 1e-12);
        for (const auto& multiplier : solution.multipliers)
            EXPECT_EQ(std::abs(multiplier), 0);
        EXPECT_LT(solution.error.value_or(1), 1e-9);
    }
}

TEST(ChatterOrbit, OfAnImpactOscillatorIsTheMotionThatIsSimulated) {
    for (const double omega : {0.3, 0.5, 1.0})
        for (const double zeta : {0.02, 0.2}) {
            const Model model =
                shipped_with("impact-oscillator", {{"omega", omega}, {"zeta", zeta}, {"e", 0.5}, {"sigma", -0.5}});
            const OrbitSolution solution = settled(model, "phase0");
            const Orbit& orbit = solution.orbit;
            ASSERT_EQ(orbit.segments(), 2U);
            const std::size_t rest = orbit.signature[0].mode == 1 ? 0 : 1;
            EXPECT_EQ(end_name(model, orbit.signature[1 - rest]), "impact*") << omega << ' ' << zeta;
            EXPECT_TRUE(solution.certificate.admissible) << solution.certificate.reason;
            Experiment experiment(model);
            experiment.run_from(orbit.starts[rest], 1, 1.01 * orbit.period());
            double sticking = 0, released = 0;
            for (const Recorder::RecordedContact& one : experiment.recorder.contacts()) {
                sticking = one.contact.kind == ContactKind::sticking ? one.contact.time : sticking;
                released = released == 0 ? one.contact.time : released;
            }
            EXPECT_NEAR(released, orbit.durations[rest], 1e-9);
            EXPECT_NEAR(sticking, orbit.period(), 1e-9) << omega << ' ' << zeta;
        }
}

/// The remaining time and the state from a start on the surface at a speed.
Accumulation::Remainder remainder_at(const Model& model, const std::vector<double>& state) {
    const System system(model);
    const Accumulation accumulation(system, 0, {model.independent_parameter("e")});
    Accumulation::Remainder result;
    EXPECT_TRUE(accumulation.evaluate(state, model.parameter_values(), result));
    return result;
}

TEST(Accumulation, OfAMassOnASpringWithDampingIsKnownToThirdOrder) {
    // One contact more changes the sum by its error, which falls with the third power of the speed. The damping acts on
    // the deceleration, the force makes it fall.
    Model model = shipped_with("impact-oscillator", {{"zeta", 0.3}, {"e", 0.6}, {"sigma", -0.5}, {"omega", 1.3}});
    Experiment experiment(model, with_tolerance(1e-14));
    double last = 0;
    for (const double speed : {0.08, 0.04, 0.02, 0.01}) {
        const std::vector<double> start{-0.5, -speed, 0.4};
        const Accumulation::Remainder here = remainder_at(model, start);
        experiment.run_from(start, 0, 1);
        ASSERT_FALSE(experiment.recorder.contacts().empty());
        const Recorder::RecordedContact& first = experiment.recorder.contacts().front();
        const Accumulation::Remainder there = remainder_at(model, first.after);
        const double time = std::abs(here.time - first.contact.time - there.time),
                     phase = std::abs(here.state[2] - there.state[2]);
        EXPECT_LT(time, 0.5 * here.time * here.time * here.time);
        EXPECT_LT(phase, 1.3 * 0.5 * here.time * here.time * here.time);
        if (last > 0) {
            EXPECT_NEAR(last / time, 8, 1.5) << speed;
        }
        last = time;
        EXPECT_NEAR(here.state[0], -0.5, 2 * here.time * here.time * here.time);
        EXPECT_NEAR(here.state[1], 0, 2 * here.time * here.time);
    }
}

TEST(Accumulation, HasTheDerivativesThatDifferencesShow) {
    Model model = shipped_with("bouncing-ball", {{"a", 0.003}, {"e", 0.5}});
    const double theta = 4.2, omega = 20 * std::numbers::pi;
    const std::vector<double> start{0.003 * std::sin(theta), 0.003 * omega * std::cos(theta) + 0.01, theta};
    const Accumulation::Remainder here = remainder_at(model, start);
    constexpr double step = 1e-6;
    for (std::size_t j = 0; j < 4; ++j) {
        const auto at = [&](double way) {
            std::vector<double> state = start;
            Model changed = model;
            if (j < 3)
                state[j] += way * step;
            else
                changed.set_parameter("e", 0.5 + way * step);
            return remainder_at(changed, state);
        };
        const Accumulation::Remainder above = at(1), below = at(-1);
        const double by = here.time_by[index(j)];
        EXPECT_NEAR((above.time - below.time) / (2 * step), by, 1e-6 * (1 + std::abs(by))) << j;
        for (Eigen::Index i = 0; i < 3; ++i)
            EXPECT_NEAR((above.state[i] - below.state[i]) / (2 * step), here.state_by(i, index(j)),
                        1e-6 * (1 + std::abs(here.state_by(i, index(j)))))
                << i << ' ' << j;
    }
}

TEST(ChatterOrbit, NeedsContactsThatAccumulate) {
    // The guess says that the contacts accumulate early.
    const Model model = shipped_with("impact-oscillator", {{"sigma", -0.5}, {"e", 0.5}, {"omega", 1.6}});
    const Orbit guess = given_orbit(model, "impact* release", {{-0.5, 0, 2}, {-0.5, 0, 5}}, {0.3, 3.6});
    const OrbitSolution solution = solve_orbit(System(model), guess);
    EXPECT_EQ(solution.outcome, OrbitOutcome::undefined);
    EXPECT_NE(solution.detail.find("segment 1 is no complete chatter sequence"), std::string::npos) << solution.detail;
}

TEST(ChatterOrbit, ABodyThatRidesAMovingSurfaceHasTheSignatureOfItsSection) {
    const Model model = shipped_with("bouncing-ball", {{"a", 0.002}, {"e", 0.5}});
    const OrbitSolution solution = settled(model, "phase0");
    EXPECT_EQ(to_string(model, solution.orbit.signature), "phase0");
    EXPECT_EQ(model.modes[solution.orbit.signature[0].mode].name, "rest");
    EXPECT_NEAR(solution.orbit.period(), 0.1, 1e-12);
}

/// A part on a vibrating table. It begins to slip where friction, and to fly where the force of the table, no longer
/// suffices. Its contact has three solutions of the law of impact, of which the orbit takes the second one.
TEST(ChatterOrbit, OfADeclaredContactIsAdmissible) {
    const double lift = 1.1, push = 0.2, mu = 0.4;
    const Model model = parse_model(R"toml(
parameters = { lift = 1.1, push = 0.2 }
states = { x = { initial = 0, drifting = true }, y = 0, u = "push", v = "lift", phase = { initial = 0, period = "2*pi" } }
modes.flight.rates = { x = "u", y = "v", u = 0, v = -1, phase = 1 }
contacts.velocities = ["u", "v"]
contacts.mass = [1, 1]
contacts.table = { gap = "y - lift*sin(phase)", slip = "u - push*cos(phase)", restitution = 0.3, friction = 0.4 }
sections.beat = { state = "phase", value = 0 }
)toml",
                                    "conveyor.toml");
    const OrbitSolution solution = settled(model, "beat");
    ASSERT_EQ(to_string(model, solution.orbit.signature),
              "flight-table-stick:table-forward flight-table-forward:table-opens flight:table:forward* "
              "flight-table-forward:table-stops");
    EXPECT_TRUE(solution.certificate.admissible) << solution.certificate.reason;
    EXPECT_NEAR(solution.orbit.starts[1][4], std::asin(mu / (push + mu * lift)), 1e-12);
    EXPECT_NEAR(solution.orbit.starts[2][4], std::asin(1 / lift), 1e-12);
    EXPECT_NEAR(solution.orbit.period(), 2 * std::numbers::pi, 1e-12);
}

} // namespace graze::chatter_orbit_test
