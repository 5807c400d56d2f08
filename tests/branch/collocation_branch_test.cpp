// Branches by collocation agree with those by shooting: continuation, test functions and conditions do not depend on
// the discretisation.

#include "branch/orbit_problem.hpp"
#include "orbit/collocation.hpp"
#include "orbit/newton.hpp"
#include "orbit/shooting.hpp"

#include "graze/model/microbeam.hpp"

#include "follow.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace graze::collocation_branch_test {

using namespace graze::testing;

struct Found {
    double fold = 0;        ///< parameter at the fold
    std::size_t points = 0; ///< number of points up to the fold
    double flip_determinant = 0;
};

Found follow_to_fold(std::unique_ptr<OrbitEquations> equations, const Orbit& orbit, int direction) {
    OrbitProblem problem(std::move(equations));
    const std::size_t place = problem.parameter_place();
    ContinuationOptions options;
    options.largest_step = 0.1;
    Continuation continuation(borrowed(problem), options);
    Found found;
    EXPECT_TRUE(continuation.start(problem.unknowns_of(orbit), place, direction)) << problem.evaluation().problem;
    while (found.points < 400 && continuation.step()) {
        ++found.points;
        if (continuation.point().tangent[place] * continuation.previous().tangent[place] > 0)
            continue;
        double low = 0, high = 1;
        const bool falls = continuation.previous().tangent[place] < 0;
        ContinuationPoint at;
        for (int i = 0; i < 50; ++i) {
            const double middle = 0.5 * (low + high);
            if (!continuation.between(middle, at))
                break;
            ((at.tangent[place] < 0) == falls ? low : high) = middle;
        }
        found.fold = at.u[place];
        found.flip_determinant = problem.evaluation().system.antiperiodic_determinant().value;
        break;
    }
    return found;
}

void expect_the_same_fold(const Model& model, const char* parameter, int direction, double published, double accuracy) {
    const Orbit orbit = settled(model, "phase0").orbit;
    const Simulation simulation(System(model), {}, {}, integration(1e-13));
    const std::vector<ParameterId> free{model.independent_parameter(parameter)};
    const Found one = follow_to_fold(std::make_unique<Shooting>(simulation, orbit, free), orbit, direction);
    const Found other = follow_to_fold(std::make_unique<Collocation>(simulation, orbit, free, 40), orbit, direction);
    EXPECT_NEAR(one.fold, published, 1e-12 * published);
    EXPECT_NEAR(other.fold, published, accuracy * published);
    EXPECT_GT(one.flip_determinant * other.flip_determinant, 0);
    // Step lengths do not depend on the number of unknowns.
    EXPECT_LT(other.points, 1.5 * static_cast<double>(one.points) + 3);
}

TEST(CollocationBranch, OrbitsWithAnImpactHaveTheFoldOfShooting) {
    const Model model =
        shipped_with("impact-oscillator", {{"sigma", 0.5}, {"zeta", 0.1}, {"omega", 1.7}, {"amplitude", 1.3}});
    expect_the_same_fold(model, "amplitude", -1, 0.570091381891438, 1e-12);
}

TEST(CollocationBranch, MicrobeamWithoutStopHasThePublishedFold) {
    expect_the_same_fold(microbeam({.stop_distance = -0.02, .stop_stiffness = 0, .voltage = 0.01}), "V", 1,
                         0.036662363851355, 1e-10);
}

} // namespace graze::collocation_branch_test
