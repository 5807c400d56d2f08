// Conditions of orbits: gradients against differences, and zeros where special points have been found.

#include "branch/orbit_condition.hpp"

#include "branch/point_kind.hpp"
#include "orbit/certify.hpp"
#include "orbit/collocation.hpp"
#include "orbit/eigen_index.hpp"
#include "orbit/newton.hpp"
#include "orbit/shooting.hpp"

#include "follow.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <memory>
#include <random>

namespace graze {
namespace {

using namespace testing;

/// The motion from the model's initial state for a time, as a candidate: conditions do not ask whether it closes.
Orbit candidate(const Model& model, double time) {
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
    // Its last segment must be one that the first may follow.
    for (;; orbit.signature.pop_back(), orbit.durations.pop_back(), orbit.starts.pop_back())
        try {
            validate_orbit(model, orbit);
            return orbit;
        } catch (const InputError&) {
            if (orbit.segments() == 1)
                throw;
        }
}

using Factory = std::function<std::optional<OrbitCondition>(const OrbitEquations&, const OrbitEvaluation&)>;

/// The gradient's product with directions, against differences of the values with errors of fourth order.
void expect_gradient(OrbitEquations& equations, const Eigen::VectorXd& unknowns, const Factory& make,
                     const std::string& what, std::mt19937& random) {
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
        const auto change = [&](double step) {
            double difference = 0;
            for (const double sign : {1.0, -1.0}) {
                EXPECT_TRUE(equations.evaluate(unknowns + sign * step * direction, at)) << what;
                EXPECT_TRUE(condition->evaluate(equations, at)) << what;
                difference += sign * condition->value();
            }
            return difference / (2 * step);
        };
        constexpr double step = 3e-5;
        EXPECT_NEAR(gradient * direction, (4 * change(step) - change(2 * step)) / 3, 1e-6 * size) << what;
    }
}

struct Motion {
    const char* model;
    double time;
};

/// Long enough for some segments of each.
constexpr Motion motions[] = {
    {"ball-and-shaker", 1.5},         {"bouncing-ball", 1.2},      {"dry-friction-oscillator", 9},
    {"electromagnetic-testbed", 0.2}, {"impact-microactuator", 8}, {"impact-oscillator-two-stops", 9},
    {"impact-oscillator", 9},         {"mems-switch", 9},          {"microbeam", 9}};

TEST(OrbitConditions, gradients_are_those_of_the_values_for_every_shipped_model) {
    std::mt19937 random(3);
    EXPECT_EQ(std::size(motions), catalogue().size());
    for (const Motion& motion : motions) {
        const std::string name = motion.model;
        const Model model = load_model(name);
        const Orbit orbit = candidate(model, motion.time);
        const Simulation simulation(model, {}, {}, integration(1e-14));
        Shooting equations(simulation, orbit, {0, 1});
        const Eigen::VectorXd unknowns = equations.unknowns_of(orbit);
        OrbitEvaluation at = equations.evaluation();
        ASSERT_TRUE(equations.evaluate(unknowns, at)) << name << ' ' << at.problem;
        // A function of all states and a parameter.
        Expression expression = sin(model.symbol(model.independent_parameters()[0])) * 0.1;
        for (std::size_t i = 0; i < model.states.size(); ++i)
            expression = expression +
                         sin(model.symbol(model.states[i].name) / (3 * equations.scales()[index(i)]) + 0.3 * double(i));
        for (const auto kind :
             {Monitor::Kind::value, Monitor::Kind::start, Monitor::Kind::duration, Monitor::Kind::maximum,
              Monitor::Kind::minimum, Monitor::Kind::mean, Monitor::Kind::norm})
            for (std::size_t s = 0; s < std::min<std::size_t>(orbit.segments(), 3); ++s) {
                if (s == 1 && (kind == Monitor::Kind::mean || kind == Monitor::Kind::norm))
                    continue; // they take long
                Monitor monitor;
                monitor.kind = kind;
                monitor.expression = expression;
                std::optional<std::size_t> segment = s;
                // The whole; an extremum of it may be at the end of one arc and at the start of the next, which differ.
                if (s == 2 &&
                    (kind == Monitor::Kind::duration || kind == Monitor::Kind::mean || kind == Monitor::Kind::norm))
                    segment.reset();
                expect_gradient(
                    equations, unknowns,
                    [&](const OrbitEquations& e, const OrbitEvaluation&) {
                        return OrbitCondition::of_monitor(e, monitor, segment, 0.1);
                    },
                    fmt::format("{} {} {}", name, int(kind), s), random);
            }
    }
}

TEST(OrbitConditions, gradients_of_what_vanishes_at_special_points) {
    std::mt19937 random(4);
    std::size_t touches = 0, guards = 0;
    for (const Motion& motion : motions) {
        const std::string name = motion.model;
        const Model model = load_model(name);
        const Orbit orbit = candidate(model, motion.time);
        const Simulation simulation(model, {}, {}, integration(1e-14));
        Shooting equations(simulation, orbit, {0, 1});
        const Eigen::VectorXd unknowns = equations.unknowns_of(orbit);
        OrbitEvaluation at = equations.evaluation();
        ASSERT_TRUE(equations.evaluate(unknowns, at)) << name;
        const Certificate certificate = certify(equations, at);
        const auto check = [&](const std::string& what, const Factory& make) {
            expect_gradient(equations, unknowns, make, name + ' ' + what, random);
        };
        for (std::size_t s = 0; s < std::min<std::size_t>(orbit.segments(), 3); ++s) {
            check("vanishing", [s](const auto& e, const auto&) { return OrbitCondition::of_vanishing(e, s); });
            if (orbit.signature[s].end != SegmentEnd::event) {
                EXPECT_THROW(OrbitCondition::of_speed(equations, s, 0), InputError);
                continue;
            }
            check("speed", [s](const auto& e, const auto&) { return OrbitCondition::of_speed(e, s, 0); });
            auto speed = OrbitCondition::of_speed(equations, s, 0);
            ASSERT_TRUE(speed.evaluate(equations, at));
            EXPECT_NEAR(speed.value(), -certificate.approach_speeds[s], 1e-12 * std::abs(speed.value()) + 1e-300);
            if (OrbitCondition::of_guard(equations, at, s)) {
                ++guards;
                check("guard", [s](const auto& e, const auto& here) { return OrbitCondition::of_guard(e, here, s); });
            }
        }
        for (const EndValue& end : certificate.end_values) {
            auto condition = OrbitCondition::of_two_events(equations, end.segment, end.event);
            ASSERT_TRUE(condition.evaluate(equations, at));
            EXPECT_NEAR(condition.value(), end.value, 1e-12 * std::abs(end.value) + 1e-300);
            if (end.segment < 2)
                check("two events", [&](const auto& e, const auto&) {
                    return OrbitCondition::of_two_events(e, end.segment, end.event);
                });
        }
        for (const OrbitMinimum& minimum : certificate.minima) {
            const double share = minimum.time / orbit.durations[minimum.segment];
            if (minimum.segment > 2 || share < 0.05 || share > 0.95)
                continue;
            ++touches;
            auto touch = OrbitCondition::of_touch(equations, minimum.segment, minimum.event, share);
            ASSERT_TRUE(touch.evaluate(equations, at));
            EXPECT_NEAR(std::abs(touch.value()), std::abs(minimum.value), 1e-10 * minimum.size) << name;
            check("touch", [&](const auto& e, const auto&) {
                return OrbitCondition::of_touch(e, minimum.segment, minimum.event, share);
            });
        }
    }
    EXPECT_GT(touches, 3U);
    EXPECT_GT(guards, 0U);
}

TEST(OrbitConditions, vanish_at_the_points_that_their_tests_have_found) {
    Model model = load_model("impact-microactuator");
    model.set_parameter("V", 0.1);
    model.set_parameter("omega", 0.9189);
    BranchSettings settings;
    settings.parameter = model.independent_parameter("V");
    settings.least = 0;
    settings.greatest = 3;
    const Branch before = follow_branch(model, settled(model, "longest", 4000).orbit, settings);
    const Branch impacting = follow(model, branches_at(model, before.special.back(), settings).at(0), settings);
    BranchSettings back = settings;
    back.direction = -1;
    ASSERT_GT(impacting.points.size(), 50U);
    const Branch returned = follow_branch(model, impacting.points[50].solution.orbit, back);
    std::size_t grazings = 0;
    for (const Branch* branch : {&before, &returned})
        for (const SpecialPoint& special : branch->special) {
            const auto make = rule_of(special.type).condition;
            if (!make)
                continue;
            grazings += special.type == PointType::grazing ? 1 : 0;
            const Simulation simulation(model, {}, {}, integration(1e-13));
            const Orbit& orbit = special.solution.orbit;
            for (const bool by_collocation : {false, true}) {
                std::unique_ptr<OrbitEquations> equations =
                    std::make_unique<Shooting>(simulation, orbit, std::vector{settings.parameter});
                if (by_collocation)
                    equations = std::make_unique<Collocation>(simulation, orbit, std::vector{settings.parameter}, 60);
                OrbitEvaluation at = equations->evaluation();
                ASSERT_TRUE(equations->evaluate(equations->unknowns_of(orbit), at));
                auto condition = make(*equations, at, special);
                ASSERT_TRUE(condition && condition->evaluate(*equations, at));
                const double size = condition->gradient().transpose().cwiseProduct(equations->scales()).norm();
                EXPECT_LT(std::abs(condition->value()), 1e-9 * size) << special.detail;
            }
        }
    EXPECT_EQ(grazings, 2U); // where the contact comes, and where it goes
}

} // namespace
} // namespace graze
