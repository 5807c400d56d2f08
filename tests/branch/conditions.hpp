// Helpers for tests of orbit conditions: their gradients are compared with differences.

#pragma once

#include "branch/orbit_condition.hpp"
#include "graze/trajectory/simulation.hpp"
#include "orbit/newton.hpp"
#include "orbit/orbit_equations.hpp"
#include "orbit/shooting.hpp"

#include "follow.hpp"

#include <gtest/gtest.h>

#include <functional>
#include <memory>
#include <random>
#include <string>

namespace graze::testing {

/// Returns the motion from the model's initial state for a time as a candidate; it need not close.
inline Orbit candidate(const Model& model, double time) {
    const Simulation simulation{System(model)};
    const std::vector<double> parameters = model.parameter_values(), start = model.initial_state();
    const FollowedMotion motion = follow_motion(simulation, parameters, start, model.initial_mode, time);
    EXPECT_EQ(motion.problem, "");
    Orbit orbit;
    orbit.parameters = parameters;
    orbit.signature = motion.segments;
    orbit.durations = motion.durations;
    orbit.starts.assign(motion.starts.begin(), motion.starts.end() - 1);
    if (orbit.signature.empty()) { // a motion without contacts, up to some time
        orbit.signature = {{model.initial_mode, SegmentEnd::section, 0}};
        orbit.durations = {time};
        orbit.starts = {start};
    }
    // The first segment must be able to follow the last.
    for (;; orbit.signature.pop_back(), orbit.durations.pop_back(), orbit.starts.pop_back())
        try {
            validate_orbit(model, orbit);
            return orbit;
        } catch (const InputError&) {
            if (orbit.segments() == 1)
                throw;
        }
}

using Factory = std::function<std::unique_ptr<OrbitCondition>(const OrbitEquations&, const OrbitEvaluation&)>;

/// Compares the product of the gradient with directions to fourth-order differences of the values.
inline void expect_gradient(OrbitEquations& equations, const Eigen::VectorXd& unknowns, const Factory& make,
                            const std::string& what, std::mt19937& random, double step = 3e-5) {
    OrbitEvaluation at = equations.evaluation();
    ASSERT_TRUE(equations.evaluate(unknowns, at)) << what << at.problem;
    auto condition = make(equations, at);
    ASSERT_TRUE(condition && condition->evaluate(equations, at)) << what;
    const Eigen::RowVectorXd gradient = condition->gradient();
    const double size = gradient.transpose().cwiseProduct(equations.scales()).norm();
    std::normal_distribution<double> normal;
    for (int trial = 0; trial < 2; ++trial) {
        Eigen::VectorXd direction(unknowns.size());
        for (Eigen::Index i = 0; i < direction.size(); ++i)
            direction[i] = equations.scales()[i] * normal(random);
        const auto change = [&](double length) {
            double difference = 0;
            for (const double sign : {1.0, -1.0}) {
                EXPECT_TRUE(equations.evaluate(unknowns + sign * length * direction, at)) << what;
                EXPECT_TRUE(condition->evaluate(equations, at)) << what;
                difference += sign * condition->value();
            }
            return difference / (2 * length);
        };
        EXPECT_NEAR(gradient * direction, (4 * change(step) - change(2 * step)) / 3, 1e-6 * size) << what;
    }
}

/// The orbit of a branch in one free parameter at which a condition holds, by Newton's method from a nearby orbit.
struct Meeting {
    Orbit orbit;
    std::size_t iterations = 0; ///< iterations until corrections are round-off; 0: no convergence
};

inline Meeting meet(OrbitEquations& equations, const Orbit& orbit, const Factory& make) {
    Eigen::VectorXd unknowns = equations.unknowns_of(orbit), step;
    OrbitEvaluation at = equations.evaluation();
    EXPECT_TRUE(equations.evaluate(unknowns, at)) << at.problem;
    auto condition = make(equations, at);
    for (std::size_t i = 1; condition && i < 20; ++i) {
        if (!equations.evaluate(unknowns, at) || !condition->evaluate(equations, at) ||
            !equations.solve(at, condition->gradient(), Eigen::VectorXd::Constant(1, -condition->value()), false, step))
            break;
        unknowns += step;
        if (step.cwiseQuotient(equations.scales()).cwiseAbs().maxCoeff() < 1e-10)
            return {equations.orbit_of(unknowns), i};
    }
    return {orbit, 0};
}

struct Motion {
    const char* model;
    double time;
};

/// Motions of the shipped models, long enough for several segments.
inline constexpr Motion motions[] = {{"ball-and-shaker", 1.5},
                                     {"bouncing-ball", 1.2},
                                     {"cam-follower", 1.55},
                                     {"belt-oscillator", 9},
                                     {"chua-circuit", 9},
                                     {"rocking-block", 9},
                                     {"spring-walker", 1},
                                     {"welander-convection", 6},
                                     {"dry-friction-oscillator", 9},
                                     {"electromagnetic-testbed", 0.2},
                                     {"impact-microactuator", 8},
                                     {"impact-oscillator-two-stops", 9},
                                     {"impact-oscillator", 9},
                                     {"mems-switch", 9},
                                     {"mems-switch-device", 1.4},
                                     {"microbeam", 9}};

/// The equations of such a motion, with the first two parameters free.
struct FollowedEquations {
    explicit FollowedEquations(const Motion& motion)
        : model(load_model(motion.model)), orbit(candidate(model, motion.time)),
          simulation(System(model), {}, {}, integration(1e-14)),
          equations(simulation, orbit, {ParameterId(0), ParameterId(1)}) {}

    Model model;
    Orbit orbit;
    Simulation simulation;
    Shooting equations;
};

} // namespace graze::testing
