// Conditions on quantities of orbits: gradients against differences, and zeros at located special points.

#include "branch/orbit_quantity.hpp"

#include "branch/point_kind.hpp"
#include "orbit/certify.hpp"
#include "orbit/collocation.hpp"
#include "orbit/eigen_index.hpp"
#include "orbit/newton.hpp"
#include "orbit/shooting.hpp"

#include "conditions.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <random>

namespace graze::orbit_quantity_test {

using namespace graze::testing;

std::unique_ptr<OrbitCondition> held(OrbitQuantity quantity) {
    return std::make_unique<OrbitQuantity>(std::move(quantity));
}

TEST(OrbitQuantities, GradientsEqualDifferencesForEveryShippedModel) {
    std::mt19937 random(3);
    EXPECT_EQ(std::size(motions), catalogue().size());
    for (const Motion& motion : motions) {
        FollowedEquations followed(motion);
        const Model& model = followed.model;
        const Orbit& orbit = followed.orbit;
        Shooting& equations = followed.equations;
        const std::string name = motion.model;
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
                    continue; // these take long
                Monitor monitor;
                monitor.kind = kind;
                monitor.expression = expression;
                std::optional<std::size_t> segment = s;
                // An extremum over the whole orbit may lie at a jump, where the end of one arc and the start of the
                // next differ.
                if (s == 2 &&
                    (kind == Monitor::Kind::duration || kind == Monitor::Kind::mean || kind == Monitor::Kind::norm))
                    segment.reset();
                expect_gradient(
                    equations, unknowns,
                    [&](const OrbitEquations& e, const OrbitEvaluation&) {
                        return held(OrbitQuantity::of_monitor(e, monitor, segment, 0.1));
                    },
                    fmt::format("{} {} {}", name, int(kind), s), random);
            }
    }
}

TEST(OrbitQuantities, GradientsOfConditionsOfSpecialPointsEqualDifferences) {
    std::mt19937 random(4);
    std::size_t touches = 0, guards = 0;
    for (const Motion& motion : motions) {
        FollowedEquations followed(motion);
        const Orbit& orbit = followed.orbit;
        Shooting& equations = followed.equations;
        const std::string name = motion.model;
        const Eigen::VectorXd unknowns = equations.unknowns_of(orbit);
        OrbitEvaluation at = equations.evaluation();
        ASSERT_TRUE(equations.evaluate(unknowns, at)) << name;
        const Certificate certificate = certify(equations, at);
        const auto check = [&](const std::string& what, const Factory& make) {
            expect_gradient(equations, unknowns, make, name + ' ' + what, random);
        };
        for (std::size_t s = 0; s < std::min<std::size_t>(orbit.segments(), 3); ++s) {
            check("vanishing", [s](const auto& e, const auto&) { return held(OrbitQuantity::of_vanishing(e, s)); });
            if (orbit.signature[s].end != SegmentEnd::event) {
                EXPECT_THROW(OrbitQuantity::of_speed(equations, s, 0), InputError);
                continue;
            }
            check("speed", [s](const auto& e, const auto&) { return held(OrbitQuantity::of_speed(e, s, 0)); });
            auto speed = OrbitQuantity::of_speed(equations, s, 0);
            ASSERT_TRUE(speed.evaluate(equations, at));
            EXPECT_NEAR(speed.value(), -certificate.approach_speeds[s], 1e-12 * std::abs(speed.value()) + 1e-300);
            if (OrbitQuantity::of_guard(equations, at, s)) {
                ++guards;
                check("guard",
                      [s](const auto& e, const auto& here) { return held(*OrbitQuantity::of_guard(e, here, s)); });
            }
        }
        for (const EndValue& end : certificate.end_values) {
            auto condition = OrbitQuantity::of_two_events(equations, end.segment, end.event);
            ASSERT_TRUE(condition.evaluate(equations, at));
            EXPECT_NEAR(condition.value(), end.value, 1e-12 * std::abs(end.value) + 1e-300);
            if (end.segment < 2)
                check("two events", [&](const auto& e, const auto&) {
                    return held(OrbitQuantity::of_two_events(e, end.segment, end.event));
                });
        }
        for (const OrbitMinimum& minimum : certificate.minima) {
            const double share = minimum.time / orbit.durations[minimum.segment];
            if (minimum.segment > 2 || share < 0.05 || share > 0.95)
                continue;
            ++touches;
            auto touch = OrbitQuantity::of_touch(equations, minimum.segment, minimum.event, share);
            ASSERT_TRUE(touch.evaluate(equations, at));
            EXPECT_NEAR(std::abs(touch.value()), std::abs(minimum.value), 1e-10 * minimum.size) << name;
            check("touch", [&](const auto& e, const auto&) {
                return held(OrbitQuantity::of_touch(e, minimum.segment, minimum.event, share));
            });
        }
    }
    EXPECT_GT(touches, 3U);
    EXPECT_GT(guards, 0U);
}

TEST(OrbitQuantities, ConditionsVanishAtLocatedPoints) {
    const Model model = shipped_with("impact-microactuator", {{"V", 0.1}, {"omega", 0.9189}});
    const BranchSettings settings = in_parameter(model, "V", 0, 3);
    const Branch before = follow_branch(System(model), settled(model, "longest", 4000).orbit, settings);
    const Branch impacting = follow(model, branches_at(System(model), before.special.back(), settings).at(0), settings);
    BranchSettings back = settings;
    back.direction = -1;
    ASSERT_GT(impacting.points.size(), 50U);
    const Branch returned = follow_branch(System(model), impacting.points[50].solution.orbit, back);
    std::size_t grazings = 0;
    for (const Branch* branch : {&before, &returned})
        for (const SpecialPoint& special : branch->special) {
            const auto make = rule_of(special.type).condition;
            if (!make)
                continue;
            grazings += special.type == PointType::grazing ? 1 : 0;
            const Simulation simulation(System(model), {}, {}, integration(1e-13));
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
                EXPECT_LT(std::abs(condition->value()), 1e-9 * size) << short_name(special.type) << special.detail;
            }
        }
    EXPECT_EQ(grazings, 2U); // where the contact appears and where it disappears
}

} // namespace graze::orbit_quantity_test
