// Conditions on multipliers: gradients against differences, and zeros at located special points.

#include "branch/singular_condition.hpp"

#include "branch/point_kind.hpp"
#include "graze/symbolic/function.hpp"
#include "orbit/collocation.hpp"
#include "orbit/eigen_index.hpp"
#include "orbit/shooting.hpp"

#include "conditions.hpp"

#include <cmath>
#include <numbers>

namespace graze::singular_condition_test {

using namespace graze::testing;

using std::numbers::pi;

Factory of_multiplier(double multiplier) {
    return [multiplier](const OrbitEquations& equations, const OrbitEvaluation& at) {
        return SingularCondition::of_multiplier(equations, at, multiplier);
    };
}

/// Checks the gradients of all conditions on multipliers. @return true if the motion has a complex pair of multipliers
bool check_gradients(OrbitEquations& equations, const Orbit& orbit, const std::string& what, std::mt19937& random) {
    const Eigen::VectorXd unknowns = equations.unknowns_of(orbit);
    constexpr double step = 3e-6; // determinants change faster than their entries
    expect_gradient(equations, unknowns, of_multiplier(1), what + " fold", random, step);
    expect_gradient(equations, unknowns, of_multiplier(-1), what + " flip", random, step);
    OrbitEvaluation at = equations.evaluation();
    EXPECT_TRUE(equations.evaluate(unknowns, at)) << what;
    auto torus = TorusCondition::of_pair(equations, at);
    // Differences are too inaccurate for a pair of tiny modulus.
    if (!torus || !torus->evaluate(equations, at) || torus->value() < -0.999)
        return false;
    expect_gradient(equations, unknowns, TorusCondition::of_pair, what + " torus", random, step);
    return true;
}

TEST(SingularConditions, GradientsEqualDifferencesForEveryShippedModel) {
    std::mt19937 random(5);
    for (const Motion& motion : motions) {
        FollowedEquations followed(motion);
        check_gradients(followed.equations, followed.orbit, motion.model, random);
    }
}

TEST(SingularConditions, TorusHasItsClosedForm) {
    const Model model = torus_model();
    const Orbit orbit = given_orbit(model, "start", {{1, 0, 0}}, {2 * pi});
    const Simulation simulation(System(model), {}, {}, integration(1e-14));
    Shooting equations(simulation, orbit, {ParameterId(0), ParameterId(1)});
    OrbitEvaluation at = equations.evaluation();
    ASSERT_TRUE(equations.evaluate(equations.unknowns_of(orbit), at));
    auto condition = TorusCondition::of_pair(equations, at);
    ASSERT_TRUE(condition && condition->evaluate(equations, at));
    const double square = std::exp(-0.4 * pi);
    EXPECT_NEAR(condition->value(), square - 1, 1e-13);
    // Along the branch, on which the orbit is constant.
    const auto& gradient = condition->gradient();
    EXPECT_NEAR(gradient[gradient.size() - 2], 4 * pi * square, 1e-11);
    EXPECT_NEAR(gradient[gradient.size() - 1], 0, 1e-11);
    std::mt19937 random(6);
    EXPECT_TRUE(check_gradients(equations, orbit, "torus", random));
    Shooting with_p(simulation, orbit, {ParameterId(0)});
    const Meeting met = meet(with_p, orbit, TorusCondition::of_pair);
    EXPECT_GT(met.iterations, 0U);
    EXPECT_LT(met.iterations, 10U);
    EXPECT_NEAR(met.orbit.parameters[0], 0, 1e-13);
}

TEST(SingularConditions, FoldAndFlipOfTheBouncingBallHaveTheirClosedForms) {
    // A ball on a table a sin(w t), one contact per period: it has a fold where a w^2 = g pi (1 - e) / (1 + e) and
    // doubles its period where cos of the phase is -2 (1 + e^2) g / ((1 + e)^2 a w^2); by Newton's method, from orbits
    // between.
    const Model model = load_model("bouncing-ball");
    const auto value = [&](const char* name) {
        return model.parameter_values()[model.independent_parameter(name).place()];
    };
    const double g = value("g"), e = value("e"), w = 2 * pi * value("f");
    const double rise = pi * (1 - e) / (1 + e), turn = 2 * (1 + e * e) / ((1 + e) * (1 + e));
    const double fold = g / (w * w) * rise, flip = g / (w * w) * std::hypot(rise, turn);
    const Simulation simulation(System(model), {}, {}, integration(1e-14));
    for (const double share : {0.1, 0.3, 0.7, 0.95}) {
        const double a = fold + share * (flip - fold), phase = std::acos(rise * g / (a * w * w));
        Orbit orbit =
            given_orbit(model, "impact", {{a * std::sin(phase), g / (2 * value("f")), phase}}, {1 / value("f")});
        orbit.parameters[model.independent_parameter("a").place()] = a;
        const double multiplier = share < 0.5 ? 1 : -1;
        for (const bool by_collocation : {false, true}) {
            std::unique_ptr<OrbitEquations> equations =
                std::make_unique<Shooting>(simulation, orbit, std::vector{model.independent_parameter("a")});
            if (by_collocation)
                equations =
                    std::make_unique<Collocation>(simulation, orbit, std::vector{model.independent_parameter("a")}, 20);
            const Meeting met = meet(*equations, orbit, of_multiplier(multiplier));
            ASSERT_GT(met.iterations, 0U) << share << ' ' << multiplier;
            EXPECT_LT(met.iterations, 10U);
            EXPECT_NEAR(met.orbit.parameters[model.independent_parameter("a").place()], multiplier > 0 ? fold : flip,
                        1e-12 * fold)
                << share;
        }
    }
}

TEST(SingularConditions, ConditionsVanishAtLocatedPointsOfSymmetricOrbits) {
    const Model model = started(load_model("electromagnetic-testbed"), {{"I", 0.1}});
    const OrbitSolution solution = settled(model, "phase0", 600);
    ASSERT_TRUE(solution.orbit.symmetry);
    std::size_t folds = 0, losses = 0;
    for (const int direction : {1, -1}) {
        const BranchSettings settings = in_parameter(model, "V0", {}, {}, direction);
        for (const SpecialPoint& special : follow_branch(System(model), solution.orbit, settings).special) {
            if (special.type != PointType::fold && special.type != PointType::asymmetry)
                continue;
            (special.type == PointType::fold ? folds : losses) += 1;
            const Simulation simulation(System(model), {}, {}, integration(1e-13));
            Shooting equations(simulation, special.solution.orbit, {settings.parameter});
            OrbitEvaluation at = equations.evaluation();
            ASSERT_TRUE(equations.evaluate(equations.unknowns_of(special.solution.orbit), at));
            auto condition = rule_of(special.type).condition(equations, at, special);
            ASSERT_TRUE(condition && condition->evaluate(equations, at));
            const double size = condition->gradient().transpose().cwiseProduct(equations.scales()).norm();
            EXPECT_LT(std::abs(condition->value()), 1e-9 * size) << short_name(special.type);
            const Meeting met =
                meet(equations, special.solution.orbit, of_multiplier(special.type == PointType::fold ? 1 : -1));
            ASSERT_GT(met.iterations, 0U);
            EXPECT_NEAR(met.orbit.parameters[settings.parameter.place()], special.parameter, 1e-11);
        }
    }
    EXPECT_GE(folds, 1U);
    EXPECT_GE(losses, 1U);
}

} // namespace graze::singular_condition_test
