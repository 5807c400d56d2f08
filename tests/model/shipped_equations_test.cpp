// The equations of the shipped models against those of their sources, evaluated directly, and against physical
// consequences: conservation of momentum, balance of energy, laws of friction and restitution.
#include "model/shipped_model.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <map>
#include <numbers>

namespace graze::shipped_equations_test {

using testing::evaluate;
using testing::event_function;
using testing::jumped;
using testing::mode_index;
using testing::next_mode;
using testing::quantity;
using testing::random_state;
using testing::rate_of;
using testing::rates;
using testing::shipped;

constexpr double epsilon = std::numeric_limits<double>::epsilon();
using std::numbers::pi;

TEST(BouncingBall, KeepsItsEnergyInFlightAndLosesRelativeVelocityInImpacts) {
    const Model model = shipped("bouncing-ball");
    const Expression energy = model.quantities[model.find_quantity("energy").value()].value;
    const Expression loss = rate_of(model, energy, mode_index(model, "flight"));
    std::mt19937_64 random(5);
    for (int trial = 0; trial < 50; ++trial) {
        const std::vector<double> state = random_state(model, 2, random);
        EXPECT_NEAR(evaluate(model, loss, state), 0, 50 * epsilon);
        const std::vector<double> after = jumped(model, model.find_jump("impact").value(), state);
        EXPECT_NEAR(quantity(model, "relative_velocity", after), -0.8 * quantity(model, "relative_velocity", state),
                    8 * epsilon);
    }
}

TEST(ImpactOscillator, SticksAtOnceAfterPlasticImpacts) {
    Model model = shipped("impact-oscillator");
    model.set_parameter("e", 0);
    const Transition* impact = model.find_transition(mode_index(model, "free"), model.find_event("stop").value());
    const double stop = 0.1;
    EXPECT_EQ(next_mode(model, *impact, jumped(model, impact->jump, std::vector<double>{stop, 1, 0})), "stuck");
    EXPECT_EQ(next_mode(model, *impact, jumped(model, impact->jump, std::vector<double>{stop, 1, pi})), "free");
    model.set_parameter("e", 0.5);
    EXPECT_EQ(next_mode(model, *impact, jumped(model, impact->jump, std::vector<double>{stop, 1, 0})), "free");
}

TEST(DryFriction, ForceOpposesTheMotion) {
    const Model model = shipped("dry-friction-oscillator");
    std::mt19937_64 random(6);
    for (int trial = 0; trial < 50; ++trial) {
        const std::vector<double> state = random_state(model, 2, random);
        const double force = quantity(model, "force", state);
        EXPECT_NEAR(rates(model, "mass-forward", state)[1], force - 0.3, 8 * epsilon);
        EXPECT_NEAR(rates(model, "mass-backward", state)[1], force + 0.3, 8 * epsilon);
    }
}

TEST(DryFriction, ModeAfterAStopIsConsistentWithTheForces) {
    const Model model = shipped("dry-friction-oscillator");
    std::mt19937_64 random(7);
    std::map<std::string, int> seen;
    for (const char* from : {"mass-forward", "mass-backward"}) {
        const double direction = std::string(from) == "mass-forward" ? 1 : -1;
        const std::size_t mode = mode_index(model, from);
        const Transition* stop = model.find_transition(mode, model.modes[mode].watched[0]);
        for (int trial = 0; trial < 300; ++trial) {
            std::vector<double> state = random_state(model, 1.5, random);
            state[1] = 0;
            if (direction * rates(model, from, state)[1] > 0)
                continue; // slip cannot end at this force
            const std::vector<double> after = jumped(model, stop->jump, state);
            const std::string next = next_mode(model, *stop, after);
            ++seen[next];
            const double force = quantity(model, "force", after);
            EXPECT_EQ(next == "mass-stick", std::abs(force) <= 0.4);
            // Slip continues in the other direction, and the acceleration agrees with it.
            if (next != "mass-stick") {
                EXPECT_LT(direction * rates(model, next.c_str(), after)[1], 0);
            }
        }
    }
    EXPECT_EQ(seen.size(), 3u);
}

TEST(BallAndShaker, ImpactsReverseTheRelativeVelocity) {
    const Model model = shipped("ball-and-shaker");
    std::mt19937_64 random(8);
    for (int trial = 0; trial < 50; ++trial) {
        const std::vector<double> state = random_state(model, 3, random);
        const double a = 0.6505, omega = 12 * pi, e = 0.55;
        const double expected = -e * state[1] + (1 + e) * a * omega * std::cos(state[2]); // Eq. (4.5)
        const std::vector<double> after = jumped(model, model.find_jump("impact").value(), state);
        EXPECT_NEAR(after[1], expected, 16 * epsilon * a * omega);
        EXPECT_NEAR(quantity(model, "velocity_jump", state), after[1] - state[1], 32 * epsilon * a * omega);
        EXPECT_NEAR(rates(model, "free", state)[1], -2 * 0.0881 * 25.2 * state[1] - 25.2 * 25.2 * state[0], 1e-11);
    }
}

TEST(Microactuator, HasTheConnectivityOfTheDissertation) {
    const Model model = shipped("impact-microactuator");
    struct Index {
        const char *label, *mode, *event, *jump;
    };
    const Index indices[] = {
        {"J1", "stick", "front", "impact"},
        {"J2", "stick", "back", "impact"},
        {"J3", "stick", "stick_plus", "identity"},
        {"J4", "stick", "stick_minus", "identity"},
        {"J5", "stick", "poincare", "identity"},
        {"J6", "slip_plus", "front", "impact"},
        {"J7", "slip_plus", "back", "impact"},
        {"J8", "slip_plus", "slip_plus", "stop"},
        {"J9", "slip_plus", "poincare", "identity"},
        {"J10", "slip_minus", "front", "impact"},
        {"J11", "slip_minus", "back", "impact"},
        {"J12", "slip_minus", "slip_minus", "stop"},
        {"J13", "slip_minus", "poincare", "identity"},
    };
    for (const Index& index : indices) {
        const Transition* transition =
            model.find_transition(mode_index(model, index.mode), model.find_event(index.event).value());
        ASSERT_NE(transition, nullptr) << index.label;
        EXPECT_EQ(transition->label, index.label);
        EXPECT_EQ(model.jumps[transition->jump].name, index.jump) << index.label;
    }
    EXPECT_EQ(model.transitions.size(), std::size(indices) + 3); // and those of a sticking impactor
}

TEST(Microactuator, ImpactsConserveMomentumAndLoseTheEnergyOfRelativeMotion) {
    const Model model = shipped("impact-microactuator");
    std::mt19937_64 random(9);
    const double m1 = 5, m2 = 1, e = 0.8;
    for (int trial = 0; trial < 200; ++trial) {
        const std::vector<double> before = random_state(model, 2, random);
        const std::vector<double> after = jumped(model, model.find_jump("impact").value(), before);
        EXPECT_NEAR(quantity(model, "momentum", after), quantity(model, "momentum", before), 64 * epsilon);
        const double loss = (1 - e * e) / 2 * m1 * m2 / (m1 + m2) * before[3] * before[3];
        EXPECT_NEAR(quantity(model, "energy", before) - quantity(model, "energy", after), loss, 128 * epsilon);
        EXPECT_EQ(after[3], -e * before[3]);
        for (const std::size_t same : {0u, 2u, 4u})
            EXPECT_EQ(after[same], before[same]);
    }
}

TEST(Microactuator, OnlyFrictionChangesMomentum) {
    const Model model = shipped("impact-microactuator");
    const Expression momentum = model.quantities[model.find_quantity("momentum").value()].value;
    std::mt19937_64 random(10);
    for (int trial = 0; trial < 50; ++trial) {
        std::vector<double> state = random_state(model, 0.5, random);
        const double friction = 0.27 * 58.86;
        const auto rate = [&](const char* mode) {
            return evaluate(model, rate_of(model, momentum, mode_index(model, mode)), state);
        };
        EXPECT_NEAR(rate("slip_plus"), -friction, 64 * epsilon * friction);
        EXPECT_NEAR(rate("slip_minus"), friction, 64 * epsilon * friction);
        // Static friction is minus the reaction force.
        EXPECT_NEAR(rate("stick"), quantity(model, "F", state), 64 * epsilon);
        EXPECT_EQ(rates(model, "stick", state)[1], 0);
    }
}

TEST(Microactuator, ForceIsThatOfTheDissertation) {
    const Model model = shipped("impact-microactuator");
    std::mt19937_64 random(11);
    for (int trial = 0; trial < 50; ++trial) {
        const std::vector<double> x = random_state(model, 0.5, random);
        const double voltage = 0.6 * std::sin(x[4]);
        const double force = voltage * voltage / ((1 - x[2]) * (1 - x[2])) - 0.04 * x[3] - x[2];
        EXPECT_NEAR(rates(model, "stick", x)[3], force, 16 * epsilon);
        EXPECT_NEAR(rates(model, "slip_plus", x)[1], -(force + 0.27 * 58.86) / 5, 32 * epsilon);
        EXPECT_NEAR(rates(model, "slip_minus", x)[3], force + (force - 0.27 * 58.86) / 5, 64 * epsilon);
    }
}

/// Returns the mode that can follow an impact with the frame at this velocity, by the laws of Amontons and Coulomb.
std::string lasting_mode(double frame_velocity, double force) {
    const double static_friction = 0.4 * 58.86;
    if (frame_velocity != 0)
        return frame_velocity > 0 ? "slip_plus" : "slip_minus";
    if (std::abs(force) <= static_friction)
        return "stick";
    return force < 0 ? "slip_plus" : "slip_minus";
}

TEST(Microactuator, ModeAfterAnImpactIsConsistentWithTheForces) {
    const Model model = shipped("impact-microactuator");
    std::mt19937_64 random(12);
    std::map<std::string, int> seen;
    for (const Transition& transition : model.transitions) {
        if (model.jumps[transition.jump].name != "impact")
            continue;
        for (int trial = 0; trial < 200; ++trial) {
            std::vector<double> after = random_state(model, 1, random);
            after[3] *= 1000; // so that damping forces exceed static friction
            if (trial % 2 == 0)
                after[1] = 0;
            const std::string next = next_mode(model, transition, after);
            EXPECT_EQ(next, lasting_mode(after[1], quantity(model, "F", after))) << transition.label;
            ++seen[next];
            if (after[1] == 0 && next != "stick") {
                const double rate = rates(model, next.c_str(), after)[1];
                EXPECT_EQ(rate > 0, next == "slip_plus");
            }
        }
    }
    EXPECT_EQ(seen.size(), 3u);
}

TEST(Microactuator, ModeAfterSlipIsConsistentWithTheForces) {
    const Model model = shipped("impact-microactuator");
    std::mt19937_64 random(13);
    std::map<std::string, int> seen;
    for (const char* from : {"slip_plus", "slip_minus"}) {
        const double direction = std::string(from) == "slip_plus" ? 1 : -1;
        const Transition* end = model.find_transition(mode_index(model, from), model.find_event(from).value());
        for (int trial = 0; trial < 400; ++trial) {
            std::vector<double> state = random_state(model, 1, random);
            state[1] = 0;
            state[3] *= 1000;
            if (direction * rates(model, from, state)[1] > 0)
                continue; // slip cannot end at this force
            const std::vector<double> after = jumped(model, end->jump, state);
            const std::string next = next_mode(model, *end, after);
            EXPECT_EQ(next, lasting_mode(0, quantity(model, "F", after))) << end->label;
            ++seen[next];
        }
    }
    EXPECT_EQ(seen.size(), 3u);
}

TEST(Microactuator, StickEndsInSlipInTheDirectionOfTheForce) {
    const Model model = shipped("impact-microactuator");
    for (const double sign : {1.0, -1.0}) {
        // The speed at which damping alone reaches static friction.
        const double speed = sign * 0.4 * 58.86 / 0.04;
        const std::vector<double> state = {0, 0, 0, speed, 0};
        const char* event = sign > 0 ? "stick_plus" : "stick_minus";
        const char* slip = sign > 0 ? "slip_plus" : "slip_minus";
        EXPECT_NEAR(evaluate(model, event_function(model, event), state), 0, 1e-13);
        const Transition* start = model.find_transition(mode_index(model, "stick"), model.find_event(event).value());
        EXPECT_EQ(next_mode(model, *start, state), slip);
        EXPECT_NEAR(rates(model, slip, state)[1], sign * (0.4 - 0.27) * 58.86 / 5, 1e-13);
    }
}

TEST(ElectromagneticTestbed, HasTheNondimensionalGroupsOfTheDissertation) {
    const Model model = shipped("electromagnetic-testbed");
    const std::vector<double> nothing(model.states.size(), 0.0);
    const auto parameter = [&](const char* name) { return evaluate(model, model.symbol(name), nothing); };
    const double beta1 = parameter("beta1"), beta2 = parameter("beta2");
    const auto expect_near = [](double value, double published) {
        EXPECT_NEAR(value, published, 1e-14 * std::abs(published));
    };
    expect_near(parameter("Ll") * beta2 / beta1, 0.904681913774974);
    expect_near(parameter("R") * beta2 / (beta1 * parameter("w0")), 1.242391680569722);
    expect_near(parameter("d") / beta2, 2.937475857167382);
    expect_near(parameter("delta") / beta2, 0.678258489270386);
    EXPECT_NEAR(parameter("voltage_unit"), 1.843020388944, 1e-12);
    EXPECT_NEAR(parameter("current_unit"), 1.647304459240, 1e-12);
    // The gaps are the sensor's readings times its sensitivity.
    EXPECT_NEAR(parameter("d"), 2.382 * 0.0791868 * 0.0254, epsilon * parameter("d"));
    EXPECT_NEAR(parameter("delta"), 0.55 * 0.0791868 * 0.0254, epsilon * parameter("delta"));
}

TEST(ElectromagneticTestbed, IsTheNondimensionalSystemInOtherUnits) {
    const Model model = shipped("electromagnetic-testbed");
    const double alpha1 = 0.904681913774974, alpha2 = 1.242391680569722, d = 2.937475857167382;
    const double beta2 = 1.631e-3, w0 = 95.94, zeta = 0.01626;
    const double volt = 1.843020388944, ampere = 1.647304459240;
    std::mt19937_64 random(14);
    for (int trial = 0; trial < 50; ++trial) {
        const std::vector<double> x = random_state(model, 0.7, random);
        const std::vector<double> state = {x[0] * beta2, x[1] * beta2 * w0, x[2] * ampere, x[3]};
        const double gap = 1 + d - x[0];
        const double acceleration = x[2] * x[2] / (gap * gap) - 2 * zeta * x[1] - x[0];
        const double current_rate =
            (4.833 / volt * std::sin(x[3]) - (alpha2 + x[1] / (gap * gap)) * x[2]) / (alpha1 + 1 / gap);
        const std::vector<double> rate = rates(model, "free", state);
        EXPECT_NEAR(rate[0] / (beta2 * w0), x[1], 1e-14);
        EXPECT_NEAR(rate[1] / (beta2 * w0 * w0), acceleration, 1e-12);
        EXPECT_NEAR(rate[2] / (ampere * w0), current_rate, 1e-11);
        EXPECT_NEAR(quantity(model, "q_nd", state), x[0], 1e-14);
        EXPECT_NEAR(quantity(model, "v_nd", state), x[1], 1e-14);
        EXPECT_NEAR(quantity(model, "I_nd", state), x[2], 1e-12);
    }
}

TEST(ElectromagneticTestbed, BalancesItsEnergy) {
    const Model model = shipped("electromagnetic-testbed");
    const Expression energy = model.quantities[model.find_quantity("energy").value()].value;
    std::mt19937_64 random(15);
    for (const char* mode : {"free", "held"}) {
        const Expression rate = rate_of(model, energy, mode_index(model, mode));
        for (int trial = 0; trial < 50; ++trial) {
            std::vector<double> state = random_state(model, 0.001, random);
            state[1] = mode == std::string("held") ? 0 : 30 * state[1];
            state[2] *= 1000;
            state[3] *= 3000;
            const double power = quantity(model, "voltage", state) * state[2];
            const double heat = 1.39 * state[2] * state[2] + 2 * 0.6462 * 95.94 * 0.01626 * state[1] * state[1];
            EXPECT_NEAR(evaluate(model, rate, state), power - heat, 64 * epsilon * (std::abs(power) + heat + 1))
                << mode;
        }
    }
}

TEST(ElectromagneticTestbed, CurrentIsThatOfACoilAtRest) {
    // With the mass clamped, Eqs. (5.17)-(5.19) give the steady current.
    Model model = shipped("electromagnetic-testbed");
    const double q = 0.0005, omega = 2 * pi * 6.25, resistance = 1.39;
    const double inductance = quantity(model, "inductance", std::vector<double>{q, 0, 0, 0});
    EXPECT_NEAR(inductance, 10.55e-3 + 1.902e-5 / (1.631e-3 + 0.00479102312304 - q), 1e-17);
    const double amplitude = 4.833 / std::hypot(resistance, omega * inductance);
    const double lag = std::atan2(omega * inductance, resistance);
    for (const double theta : {0.0, 1.0, 2.0, 4.0}) {
        const std::vector<double> state = {q, 0, amplitude * std::sin(theta - lag), theta};
        EXPECT_NEAR(rates(model, "held", state)[2], amplitude * omega * std::cos(theta - lag), 1e-12);
    }
}

TEST(MemsSwitch, InitialStateIsAtTheGrazingPoint) {
    const Model model = shipped("mems-switch");
    const std::vector<double> state = model.initial_state();
    EXPECT_EQ(evaluate(model, event_function(model, "stop"), state), 0);
    EXPECT_EQ(state[1], 0);
    const std::vector<double> rate = rates(model, "on", state);
    const double attraction = std::pow(0.2013662121541341 + 1e-4, 2) / (1.6 * 1.6);
    EXPECT_NEAR(rate[1], 0.6 + attraction, 4 * epsilon);
    EXPECT_NEAR(rates(model, "off", state)[1], 0.6, 4 * epsilon);
}

TEST(MemsSwitch, StopForceIsAlwaysRepulsive) {
    const Model model = shipped("mems-switch");
    const Expression gap = event_function(model, "stop");
    for (const char* mode : {"on", "off"}) {
        const std::size_t index = mode_index(model, mode);
        const Expression acceleration = rate_of(model, rate_of(model, gap, index), index);
        EXPECT_GE(evaluate(model, acceleration, std::vector<double>{-0.6, 0, 1}), 0.6) << mode;
    }
}

} // namespace graze::shipped_equations_test
