// The same tests for both discretisations of an orbit's equations: shooting and collocation.

#include "orbit/certify.hpp"
#include "orbit/collocation.hpp"
#include "orbit/eigen_index.hpp"
#include "orbit/newton.hpp"
#include "orbit/shooting.hpp"

#include "graze/base/input_error.hpp"
#include "orbits.hpp"
#include "trajectory/simulate.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <random>
#include <string>

namespace graze::orbit_equations_test {

using namespace graze::testing;

enum class Method { shooting, collocation };

/// Two kinds of orbit: one with an impact, which tests jump and end condition, and one of a stiffer model.
struct Case {
    Method method;
    std::string model;
};

std::string name_of(const ::testing::TestParamInfo<Case>& info) {
    std::string name = info.param.model + (info.param.method == Method::shooting ? "_shooting" : "_collocation");
    std::replace(name.begin(), name.end(), '-', '_');
    return name;
}

Model model_of(const std::string& name) {
    return name == "impact-oscillator"
               ? shipped_with(name, {{"sigma", 0.5}, {"zeta", 0.1}, {"omega", 1.7}, {"amplitude", 1.3}})
               : shipped_with(name, {{"V0", 3.0}});
}

std::string parameter_of(const std::string& name) {
    return name == "impact-oscillator" ? "amplitude" : "V0";
}

Orbit orbit_of(const Model& model) {
    return settled(model, "phase0", 3000).orbit;
}

class Equations : public ::testing::TestWithParam<Case> {
protected:
    Equations() : model(model_of(GetParam().model)), orbit(orbit_of(model)) {}

    std::unique_ptr<OrbitEquations> make(std::vector<ParameterId> free, std::size_t intervals = 40) const {
        const Simulation simulation(System(model), {}, {}, integration(1e-14));
        if (GetParam().method == Method::shooting)
            return std::make_unique<Shooting>(simulation, orbit, free);
        return std::make_unique<Collocation>(simulation, orbit, free, intervals);
    }
    ParameterId parameter() const { return model.independent_parameter(parameter_of(GetParam().model)); }

    Model model;
    Orbit orbit;
};

/// Returns the residuals of all equations, in the order of the blocks.
Eigen::VectorXd residuals(const OrbitEvaluation& at) {
    Eigen::VectorXd result(0);
    for (std::size_t k = 0; k < at.system.segments(); ++k) {
        const Eigen::VectorXd& right = at.system.block(k).right;
        result.conservativeResize(result.size() + right.size());
        result.tail(right.size()) = -right;
    }
    return result;
}

TEST_P(Equations, NewtonsMethodConvergesToTheOrbitOfShooting) {
    const auto equations = make({});
    Eigen::VectorXd unknowns = equations->unknowns_of(orbit);
    for (Eigen::Index i = 0; i < unknowns.size(); ++i)
        unknowns[i] += 1e-4 * equations->scales()[i] * std::sin(7.0 * static_cast<double>(i));
    OrbitEvaluation at = equations->evaluation();
    std::size_t iterations = 0;
    std::string detail;
    OrbitOptions options;
    options.tolerance = 1e-14;
    ASSERT_EQ(solve_equations(*equations, unknowns, options, at, iterations, detail), OrbitOutcome::converged)
        << detail;
    EXPECT_LE(iterations, 6U);
    EXPECT_LT(at.residual, 1e-11);
    const Orbit found = equations->orbit_of(unknowns);
    const OrbitSolution reference = solve_orbit(System(model), orbit);
    ASSERT_EQ(found.segments(), reference.orbit.segments());
    for (std::size_t s = 0; s < found.segments(); ++s) {
        EXPECT_NEAR(found.durations[s], reference.orbit.durations[s], 1e-9 * reference.orbit.period());
        for (std::size_t i = 0; i < model.states.size(); ++i)
            EXPECT_NEAR(found.starts[s][i], reference.orbit.starts[s][i], 1e-9 * equations->scales()[index(i)]);
    }
    OrbitSolution solution;
    describe_orbit(*equations, at, solution);
    EXPECT_TRUE(solution.certificate.admissible) << solution.certificate.reason;
    ASSERT_EQ(solution.multipliers.size(), reference.multipliers.size());
    for (std::size_t i = 0; i < solution.multipliers.size(); ++i)
        EXPECT_NEAR(std::abs(solution.multipliers[i]), std::abs(reference.multipliers[i]), 1e-8);
}

TEST_P(Equations, DerivativesEqualDifferencesOfTheResiduals) {
    const auto equations = make({parameter()});
    const Eigen::VectorXd unknowns = equations->unknowns_of(orbit);
    OrbitEvaluation at = equations->evaluation(), ahead = equations->evaluation(), behind = equations->evaluation();
    ASSERT_TRUE(equations->evaluate(unknowns, at));
    const OrbitLayout& layout = equations->layout();
    const Eigen::Index n = index(layout.states());
    std::mt19937 random(1);
    std::uniform_real_distribution<double> uniform(-1, 1);
    for (int trial = 0; trial < 5; ++trial) {
        // Inner unknowns have been eliminated: the residuals do not change with them.
        Eigen::VectorXd direction = Eigen::VectorXd::Zero(unknowns.size());
        for (Eigen::Index i = 0; i < direction.size(); ++i)
            direction[i] = equations->scales()[i] * uniform(random);
        constexpr double step = 1e-5;
        ASSERT_TRUE(equations->evaluate(unknowns + step * direction, ahead));
        ASSERT_TRUE(equations->evaluate(unknowns - step * direction, behind));
        const Eigen::VectorXd differences = (residuals(ahead) - residuals(behind)) / (2 * step);
        const Eigen::VectorXd scaled = direction.cwiseQuotient(equations->scales());
        Eigen::VectorXd derivatives(0);
        for (std::size_t k = 0; k < layout.pieces(); ++k) {
            const CyclicSystem::Block& block = at.system.block(k);
            const std::size_t next = k + 1 < layout.pieces() ? k + 1 : 0;
            const Eigen::VectorXd change = block.own * scaled.segment(index(layout.start_of(k)), n + 1) +
                                           block.next * scaled.segment(index(layout.start_of(next)), n) +
                                           block.parameters * scaled.tail(1);
            derivatives.conservativeResize(derivatives.size() + change.size());
            derivatives.tail(change.size()) = change;
        }
        const double size = derivatives.cwiseAbs().maxCoeff();
        EXPECT_LT((derivatives - differences).cwiseAbs().maxCoeff(), 1e-6 * size);
    }
}

TEST_P(Equations, TangentEqualsDifferencesOfOrbits) {
    const auto equations = make({parameter()});
    OrbitEvaluation at = equations->evaluation();
    Eigen::VectorXd unknowns = equations->unknowns_of(orbit), tangent;
    ASSERT_TRUE(equations->evaluate(unknowns, at));
    Eigen::RowVectorXd row = Eigen::RowVectorXd::Zero(unknowns.size());
    row[index(equations->layout().parameter(0))] = 1;
    ASSERT_TRUE(equations->solve(at, row, Eigen::VectorXd::Constant(1, 1), true, tangent));
    const OrbitDirection direction = equations->direction_of(tangent);
    ASSERT_EQ(direction.starts.size(), orbit.segments());
    EXPECT_NEAR(direction.parameters.at(0), 1, 1e-12);
    const Eigen::VectorXd again = equations->unknowns_of(direction, at);
    EXPECT_LT((again - tangent).cwiseQuotient(equations->scales()).cwiseAbs().maxCoeff(),
              1e-9 * tangent.cwiseQuotient(equations->scales()).cwiseAbs().maxCoeff());
    // Central differences of orbits at nearby parameters.
    const double step = 1e-4 * equations->scales()[index(equations->layout().parameter(0))];
    std::vector<Orbit> beside;
    for (const double sign : {1.0, -1.0}) {
        Orbit guess = orbit;
        guess.parameters[parameter().place()] += sign * step;
        const OrbitSolution solution = solve_orbit(System(model), guess);
        ASSERT_EQ(solution.outcome, OrbitOutcome::converged);
        beside.push_back(solution.orbit);
    }
    for (std::size_t s = 0; s < orbit.segments(); ++s)
        for (std::size_t i = 0; i < model.states.size(); ++i) {
            const double rise = (beside[0].starts[s][i] - beside[1].starts[s][i]) / (2 * step);
            const double unit =
                equations->scales()[index(i)] / equations->scales()[index(equations->layout().parameter(0))];
            EXPECT_NEAR(direction.starts[s][i], rise, 1e-5 * unit) << s << ' ' << model.states[i].name;
        }
}

TEST_P(Equations, ADirectionOfAnotherSizeIsRefused) {
    const auto equations = make({parameter()});
    OrbitEvaluation at = equations->evaluation();
    ASSERT_TRUE(equations->evaluate(equations->unknowns_of(orbit), at));
    EXPECT_THROW(equations->unknowns_of(OrbitDirection(), at), InputError);
    EXPECT_THROW(equations->unknowns_of(OrbitDirection{{{1, 2}}, {0}, {1}}, at), InputError);
}

INSTANTIATE_TEST_SUITE_P(Methods, Equations,
                         ::testing::Values(Case{Method::shooting, "impact-oscillator"},
                                           Case{Method::collocation, "impact-oscillator"},
                                           Case{Method::shooting, "electromagnetic-testbed"},
                                           Case{Method::collocation, "electromagnetic-testbed"}),
                         name_of);

TEST(Collocation, ErrorFallsWithTheEighthPower) {
    const Model model = model_of("impact-oscillator");
    const Orbit orbit = orbit_of(model);
    std::vector<double> errors;
    for (const std::size_t intervals : {2, 4, 8}) {
        Collocation equations(Simulation(System(model), {}, {}, integration(1e-14)), orbit, {}, intervals);
        Eigen::VectorXd unknowns = equations.unknowns_of(orbit);
        OrbitEvaluation at = equations.evaluation();
        std::size_t iterations = 0;
        std::string detail;
        ASSERT_EQ(solve_equations(equations, unknowns, {}, at, iterations, detail), OrbitOutcome::converged) << detail;
        errors.push_back(std::abs(equations.orbit_of(unknowns).starts[0][1] - orbit.starts[0][1]));
    }
    EXPECT_GT(errors[0] / errors[1], 150) << errors[0] << ' ' << errors[1];
    EXPECT_GT(errors[1] / errors[2], 150) << errors[1] << ' ' << errors[2];
    EXPECT_THROW(Collocation(Simulation(System(model)), orbit, {}, 0), InputError);
}

} // namespace graze::orbit_equations_test
